#pragma once
// A smooth function of one variable as the shortest polynomial that is good enough: terms of one material that are
// functions of one cosine are evaluated so, without a transcendental function.

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace goniofit {

/// Sum of c[k] t^k, t = scale x + offset in [-1, 1] over the interval it was fitted on.
struct FittedPolynomial {
  double scale = 0.0, offset = 0.0;
  std::vector<double> c;
  double error = 0.0;  ///< largest found on the interval, as asked for: relative or absolute

  [[nodiscard]] double operator()(double x) const noexcept;
};

enum class ErrorMeasure { relative, absolute };
/// What the polynomial will be evaluated in: many coefficients leave few digits of single precision.
enum class PolynomialArithmetic { binary64, binary32 };

/// Interpolates at Chebyshev points, with as many coefficients as keep the error within the tolerance on a grid of ten
/// points a coefficient, powers' own rounding included; nullopt where `most` coefficients do not. Relative: f is to
/// have no zero on [lower, upper].
[[nodiscard]] std::optional<FittedPolynomial> fit_polynomial(const std::function<double(double)>& f, double lower,
                                                             double upper, double tolerance, ErrorMeasure measure,
                                                             std::size_t most, PolynomialArithmetic arithmetic);

}  // namespace goniofit
