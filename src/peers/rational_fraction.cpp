#include "peers/rational_fraction.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "geometry/angles.h"
#include "support/error.h"

namespace goniofit {

namespace {

double polynomial(const std::vector<double>& c, double x) noexcept {
  double sum = 0.0;
  for (std::size_t i = c.size(); i-- > 0;) sum = sum * x + c[i];
  return sum;
}

double polynomial_derivative(const std::vector<double>& c, double x) noexcept {
  double sum = 0.0;
  for (std::size_t i = c.size() - 1; i > 0; --i) sum = sum * x + static_cast<double>(i) * c[i];
  return sum;
}

// d^order/dx^order of x^power.
double monomial_derivative(int power, int order, double x) {
  if (order > power) return 0.0;
  double factor = 1.0;
  for (int i = 0; i < order; ++i) factor *= power - i;
  return factor * std::pow(x, power - order);
}

double binomial(int n, int k) {
  double value = 1.0;
  for (int i = 1; i <= k; ++i) value = value * (n - k + i) / i;
  return value;
}

std::optional<double> given(std::span<const KernelCondition> conditions, double x, int order) {
  for (const KernelCondition& c : conditions) {
    if (c.x == x && c.order == order) return c.value;
  }
  return std::nullopt;
}

// (f Q)^(order) at x, of one power of Q: the sum over j of binom(order, j) f^(j) Q^(order - j).
double product_derivative(std::span<const KernelCondition> conditions, double x, int order, int power) {
  double sum = 0.0;
  for (int j = 0; j <= order; ++j) {
    const std::optional<double> f = given(conditions, x, j);
    if (!f) throw usage_error("a kernel condition on a derivative needs all lower ones at the same point");
    sum += binomial(order, j) * *f * monomial_derivative(power, order - j, x);
  }
  return sum;
}

// Conditions on the fraction itself (the integral counts as order 0 where one is given), in x/scale.
std::vector<KernelCondition> rescaled(std::span<const KernelCondition> conditions, int shift, double scale) {
  std::vector<KernelCondition> out;
  for (const KernelCondition& c : conditions) {
    const int order = c.order + shift;
    out.push_back({c.x / scale, order, c.value * std::pow(scale, order)});
  }
  return out;
}

double scale_of(std::span<const KernelCondition> conditions) {
  double scale = 0.0;
  for (const KernelCondition& c : conditions) scale = std::max(scale, std::fabs(c.x));
  return scale > 0.0 ? scale : 1.0;
}

// The unknowns: numerator_degree + 1 coefficients of P, then those of Q from the first power on.
Eigen::VectorXd solve(std::span<const KernelCondition> conditions, int numerator_degree, int denominator_degree) {
  const auto n = static_cast<Eigen::Index>(conditions.size());
  Eigen::MatrixXd matrix(n, n);
  Eigen::VectorXd right(n);
  for (Eigen::Index row = 0; row < n; ++row) {
    const KernelCondition& c = conditions[static_cast<std::size_t>(row)];
    for (int power = 0; power <= numerator_degree; ++power)
      matrix(row, power) = monomial_derivative(power, c.order, c.x);
    for (int power = 1; power <= denominator_degree; ++power)
      matrix(row, numerator_degree + power) = -product_derivative(conditions, c.x, c.order, power);
    right(row) = product_derivative(conditions, c.x, c.order, 0);
  }
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(matrix);
  if (!lu.isInvertible()) throw usage_error("the kernel conditions do not determine a rational fraction");
  return lu.solve(right);
}

}  // namespace

double RationalFraction::operator()(double x) const noexcept {
  return polynomial(numerator, x) / polynomial(denominator, x);
}

double RationalFraction::derivative(double x) const noexcept {
  const double q = polynomial(denominator, x);
  return (polynomial_derivative(numerator, x) * q - polynomial(numerator, x) * polynomial_derivative(denominator, x)) /
         (q * q);
}

RationalApproximation rational_approximation(std::span<const KernelCondition> conditions, int numerator_degree,
                                             int denominator_degree) {
  if (numerator_degree < 0 || denominator_degree < 0 ||
      conditions.size() !=
          static_cast<std::size_t>(numerator_degree) + static_cast<std::size_t>(denominator_degree) + 1)
    throw usage_error("a rational fraction needs as many kernel conditions as it has coefficients");
  const bool is_integral =
      std::any_of(conditions.begin(), conditions.end(), [](const KernelCondition& c) { return c.order < 0; });
  const double scale = scale_of(conditions);
  const Eigen::VectorXd unknowns =
      solve(rescaled(conditions, is_integral ? 1 : 0, scale), numerator_degree, denominator_degree);
  RationalApproximation out{{{}, {1.0}}, is_integral};
  for (int power = 0; power <= numerator_degree; ++power)
    out.fraction.numerator.push_back(unknowns(power) / std::pow(scale, power));
  for (int power = 1; power <= denominator_degree; ++power)
    out.fraction.denominator.push_back(unknowns(numerator_degree + power) / std::pow(scale, power));
  return out;
}

RationalApproximation schlick_sine() {
  const std::array<KernelCondition, 4> conditions{{{0.0, 0, 0.0}, {0.0, 1, 1.0}, {pi / 2, 0, 1.0}, {pi / 2, 1, 0.0}}};
  return rational_approximation(conditions, 2, 1);
}

RationalApproximation schlick_fresnel_shape() {
  const std::array<KernelCondition, 6> conditions{
      {{0.0, 0, 1.0}, {1.0, 0, 0.0}, {1.0, 1, 0.0}, {1.0, 2, 0.0}, {1.0, 3, 0.0}, {1.0, 4, 0.0}}};
  return rational_approximation(conditions, 5, 0);
}

RationalApproximation schlick_attenuation(double rms_slope) {
  const double k = std::sqrt(2.0 / pi) * rms_slope;
  const std::array<KernelCondition, 3> conditions{{{0.0, 0, 0.0}, {0.0, 1, 1.0 / k}, {1.0, 0, 1.0}}};
  return rational_approximation(conditions, 1, 1);
}

namespace {

// The integral of t D dt from x = 0 is ½ at x = m; its derivative by y = x² is t D/(2 x) = 1/(2 m³) there.
RationalApproximation slopes_by_square(double m) {
  if (!(m > 0.0 && m <= 1.0)) throw usage_error("Schlick's slope distribution needs 0 < m <= 1");
  const std::array<KernelCondition, 3> conditions{{{0.0, -1, 0.0}, {m * m, -1, 0.5}, {m * m, 0, 0.5 / (m * m * m)}}};
  return rational_approximation(conditions, 1, 1);
}

}  // namespace

SchlickSlopes::SchlickSlopes(double m) : m_(m), by_square_(slopes_by_square(m)) {}

double SchlickSlopes::operator()(double t) const noexcept {
  const double x = t + m_ - 1.0;
  return x > 0.0 ? 2.0 * x * by_square_(x * x) / t : 0.0;
}

}  // namespace goniofit
