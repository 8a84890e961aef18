#pragma once
// Schlick 1994, section 4.1: cheap stand-ins for costly functions. What characterises a function - values, derivatives,
// integrals at chosen points, its kernel conditions - is asked of a rational fraction with as many coefficients, and a
// linear system gives them. His four results are below; the tests find his coefficients again and measure the errors.

#include <span>
#include <vector>

namespace goniofit {

/// P(x)/Q(x), lowest power first.
struct RationalFraction {
  std::vector<double> numerator, denominator;

  [[nodiscard]] double operator()(double x) const noexcept;
  [[nodiscard]] double derivative(double x) const noexcept;
};

/// The `order`-th derivative of f at x: 0 its value, -1 its integral from a fixed origin to x.
struct KernelCondition {
  double x;
  int order;
  double value;
};

/// f ~ fraction, or f ~ fraction' where a condition on the integral was given: linear in the coefficients is only the
/// integral itself.
struct RationalApproximation {
  RationalFraction fraction;
  bool is_integral;

  [[nodiscard]] double operator()(double x) const noexcept {
    return is_integral ? fraction.derivative(x) : fraction(x);
  }
};

/// The fraction of the given degrees, Q(0) = 1, that meets the conditions: P^(k) = (f Q)^(k) is linear in the
/// coefficients of P and Q provided that with each derivative all lower ones (down to the integral, if one is given)
/// are conditions at the same x. Errors: usage_error where they are not, where their number is not numerator_degree +
/// denominator_degree + 1, and where they contradict each other or repeat.
[[nodiscard]] RationalApproximation rational_approximation(std::span<const KernelCondition> conditions,
                                                           int numerator_degree, int denominator_degree);

/// (12) sin x on [0, pi/2] from sin 0 = 0, sin' 0 = 1, sin pi/2 = 1, sin' pi/2 = 0:
/// (pi² x - 4 x²)/(pi² + (pi² - 4 pi) x). Mean absolute error (his epsilon) 1.4 %, mean relative error 2.3 %.
[[nodiscard]] RationalApproximation schlick_sine();

/// (15) (1 - u)⁵ for (F - f0)/(1 - f0) from 1 at u = 0 and from 0 with four vanishing derivatives at u = 1.
[[nodiscard]] RationalApproximation schlick_fresnel_shape();

/// (19) G(v) = v/(v - k v + k), k = sqrt(2 m²/pi), from G(0) = 0, G'(0) = 1/k, G(1) = 1. m is the RMS slope.
[[nodiscard]] RationalApproximation schlick_attenuation(double rms_slope);

/// (21) D(t) = m³ x/(t (m x² - x² + m²)²), x = t + m - 1, for Beckmann's D(t) = exp((t² - 1)/(m² t²))/(m² t⁴) (20),
/// from D(1) = 1/m² and from the integral of 2 t D being 1 over [1 - m, 1], beyond which it is 0. (m x² ...)² is what
/// an integral in y = x² leaves: the integral of t D from t = 1 - m to t is y/(2 m (1 + b y)). Needs 0 < m <= 1.
class SchlickSlopes {
 public:
  explicit SchlickSlopes(double m);
  [[nodiscard]] double operator()(double t) const noexcept;
  /// In y = x²; its fraction is the integral of t D.
  [[nodiscard]] const RationalApproximation& by_square() const noexcept { return by_square_; }

 private:
  double m_;
  RationalApproximation by_square_;
};

}  // namespace goniofit
