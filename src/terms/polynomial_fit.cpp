#include "terms/polynomial_fit.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace goniofit {

namespace {

// Coefficients of Chebyshev polynomials of f(x(t)) from n points.
std::vector<double> chebyshev_coefficients(const std::function<double(double)>& f, double lower, double upper,
                                           std::size_t n) {
  std::vector<double> values;
  const double count = static_cast<double>(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double t = std::cos(std::numbers::pi * (static_cast<double>(i) + 0.5) / count);
    values.push_back(f(lower + 0.5 * (1.0 + t) * (upper - lower)));
  }
  std::vector<double> c(n);
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = 0; i < n; ++i) {
      c[k] += values[i] * std::cos(std::numbers::pi * static_cast<double>(k * (2 * i + 1)) / (2.0 * count));
    }
    c[k] *= (k > 0 ? 2.0 : 1.0) / count;
  }
  return c;
}

// The first n of them as powers of t.
std::vector<double> powers(const std::vector<double>& chebyshev, std::size_t n) {
  std::vector<double> sum(n);
  std::vector<double> before(n);
  std::vector<double> now(n);
  now[0] = 1.0;
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t j = 0; j <= k; ++j) sum[j] += chebyshev[k] * now[j];
    std::vector<double> next(n);
    for (std::size_t j = 0; j + 1 < n; ++j) next[j + 1] = (k > 0 ? 2.0 : 1.0) * now[j];
    for (std::size_t j = 0; j < n && k > 0; ++j) next[j] -= before[j];
    before = std::move(now);
    now = std::move(next);
  }
  return sum;
}

template <class Real>
double evaluate(const FittedPolynomial& p, double x) noexcept {
  const Real t = static_cast<Real>(p.scale) * static_cast<Real>(x) + static_cast<Real>(p.offset);
  Real sum = 0;
  for (std::size_t k = p.c.size(); k-- > 0;) sum = sum * t + static_cast<Real>(p.c[k]);
  return static_cast<double>(sum);
}

double error_of(const FittedPolynomial& p, const std::function<double(double)>& f, double lower, double upper,
                ErrorMeasure measure, PolynomialArithmetic arithmetic) {
  double worst = 0.0;
  const std::size_t points = 10 * p.c.size();
  for (std::size_t i = 0; i <= points; ++i) {
    const double x = lower + (upper - lower) * static_cast<double>(i) / static_cast<double>(points);
    const double truth = f(x);
    const double value = arithmetic == PolynomialArithmetic::binary32 ? evaluate<float>(p, x) : evaluate<double>(p, x);
    const double error = std::fabs(value - truth) / (measure == ErrorMeasure::relative ? std::fabs(truth) : 1.0);
    worst = std::isfinite(error) ? std::fmax(worst, error) : std::numeric_limits<double>::infinity();
  }
  return worst;
}

}  // namespace

double FittedPolynomial::operator()(double x) const noexcept { return evaluate<double>(*this, x); }

std::optional<FittedPolynomial> fit_polynomial(const std::function<double(double)>& f, double lower, double upper,
                                               double tolerance, ErrorMeasure measure, std::size_t most,
                                               PolynomialArithmetic arithmetic) {
  const std::vector<double> chebyshev = chebyshev_coefficients(f, lower, upper, most + most / 2);
  for (std::size_t n = 4; n <= most; n += 4) {
    FittedPolynomial p{2.0 / (upper - lower), -(upper + lower) / (upper - lower), powers(chebyshev, n), 0.0};
    p.error = error_of(p, f, lower, upper, measure, arithmetic);
    if (p.error <= tolerance) return p;
  }
  return std::nullopt;
}

}  // namespace goniofit
