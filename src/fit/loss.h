#pragma once
// What a fit makes least. With f the model and y the reading, the loss is
//
//   sum over readings and channels of rho(w (g(f) - g(y))²),
//
//   loss               g(f)                     w, times cos(theta_i) unless the weight says otherwise
//   cosine-l2          f                        1 (Li & Torrance 2005)
//   inverse-variance   f                        1/u², u the scan's standard uncertainty
//   relative           f                        1/max(|y|, 10⁻³ sr⁻¹)²
//   log1p              sign(f) ln(1 + |f|)      1
//   cube-root          f/(f² + e²)^(1/3)        1, e = 10⁻⁴ sr⁻¹: the cube root, but for its infinite slope at 0
//
// f in sr⁻¹; g is odd and has a continuous derivative, so negative readings (noise about zero) and k's of zero are no
// special cases. rho is the identity or one of Ceres' robust kernels, which take a residual of less than the scale as
// it is and count larger ones for less.

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "../brdf/material.h"
#include "settings.h"

namespace ceres {
class LossFunction;
}

namespace goniofit {

[[nodiscard]] std::string_view name_of(Loss) noexcept;
[[nodiscard]] std::string_view name_of(RobustKernel) noexcept;
[[nodiscard]] std::string_view name_of(Weight) noexcept;
template <>
[[nodiscard]] std::optional<Loss> parse_name<Loss>(std::string_view name) noexcept;
template <>
[[nodiscard]] std::optional<RobustKernel> parse_name<RobustKernel>(std::string_view name) noexcept;
template <>
[[nodiscard]] std::optional<Weight> parse_name<Weight>(std::string_view name) noexcept;
template <>
[[nodiscard]] std::string names_of<Loss>();
template <>
[[nodiscard]] std::string names_of<RobustKernel>();
template <>
[[nodiscard]] std::string names_of<Weight>();

inline constexpr double relative_floor = 1e-3;  ///< sr⁻¹

/// Whether g is not the identity: the coefficients then do not enter the residuals linearly.
[[nodiscard]] constexpr bool is_transformed(Loss loss) noexcept {
  return loss == Loss::log1p || loss == Loss::cube_root;
}

struct Transformed {
  double value, slope;  ///< g and g'
};
[[nodiscard]] Transformed transformed(Loss loss, double f) noexcept;

[[nodiscard]] constexpr bool has_cosine(Weight w) noexcept {
  return w == Weight::cosine || w == Weight::cosine_solid_angle;
}
[[nodiscard]] constexpr bool has_solid_angle(Weight w) noexcept {
  return w == Weight::solid_angle || w == Weight::cosine_solid_angle;
}

/// rho with its scale.
class RobustLoss {
 public:
  /// kernel other than none; scale > 0, of sqrt(w) |g(f) - g(y)|.
  RobustLoss(RobustKernel kernel, double scale);

  struct Value {
    double rho = 0.0;
    double slope = 1.0;      ///< rho'(s), s the squared residual
    double curvature = 1.0;  ///< half of d² rho(r²) / dr²: rho' + 2 s rho''
  };
  [[nodiscard]] Value at(double squared_residual) const;
  [[nodiscard]] RobustKernel kernel() const noexcept { return kernel_; }
  [[nodiscard]] double scale() const noexcept { return scale_; }

  /// Scale at which the kernel has 95 % of least squares' efficiency on normal residuals of standard deviation 1 (for
  /// soft_l1, which has no such tradition, Huber's).
  [[nodiscard]] static double tuning(RobustKernel kernel) noexcept;

 private:
  RobustKernel kernel_;
  double scale_;
  std::shared_ptr<const ceres::LossFunction> function_;
};

}  // namespace goniofit
