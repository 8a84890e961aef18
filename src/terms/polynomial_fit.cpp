#include "terms/polynomial_fit.h"

#include <cmath>
#include <limits>

#include "terms/chebyshev_fit.h"

namespace goniofit {

namespace {

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
  const std::vector<double> series =
      chebyshev::series(most + most / 2, [&](double t) { return f(lower + 0.5 * (1.0 + t) * (upper - lower)); });
  for (std::size_t n = 4; n <= most; n += 4) {
    FittedPolynomial p{2.0 / (upper - lower), -(upper + lower) / (upper - lower), chebyshev::by_powers(series, n), 0.0};
    p.error = error_of(p, f, lower, upper, measure, arithmetic);
    if (p.error <= tolerance) return p;
  }
  return std::nullopt;
}

}  // namespace goniofit
