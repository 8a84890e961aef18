#include "fit/loss.h"

#include <ceres/loss_function.h>
#include <array>
#include <cmath>
#include <span>

#include "support/named.h"

namespace goniofit {

namespace {

constexpr std::array loss_names{Named<Loss>{Loss::cosine_l2, "cosine-l2"},
                                Named<Loss>{Loss::inverse_variance, "inverse-variance"},
                                Named<Loss>{Loss::relative, "relative"}, Named<Loss>{Loss::log1p, "log1p"},
                                Named<Loss>{Loss::cube_root, "cube-root"}};
constexpr std::array kernel_names{
    Named<RobustKernel>{RobustKernel::none, "none"}, Named<RobustKernel>{RobustKernel::huber, "huber"},
    Named<RobustKernel>{RobustKernel::soft_l1, "soft-l1"}, Named<RobustKernel>{RobustKernel::cauchy, "cauchy"},
    Named<RobustKernel>{RobustKernel::tukey, "tukey"}};
constexpr std::array weight_names{Named<Weight>{Weight::cosine, "cosine"}, Named<Weight>{Weight::none, "none"},
                                  Named<Weight>{Weight::cosine_solid_angle, "cosine-solid-angle"},
                                  Named<Weight>{Weight::solid_angle, "solid-angle"}};

constexpr std::span<const Named<Loss>> names(Loss) { return loss_names; }
constexpr std::span<const Named<RobustKernel>> names(RobustKernel) { return kernel_names; }
constexpr std::span<const Named<Weight>> names(Weight) { return weight_names; }

std::shared_ptr<const ceres::LossFunction> function_of(RobustKernel kernel, double scale) {
  switch (kernel) {
    case RobustKernel::huber:
      return std::make_shared<ceres::HuberLoss>(scale);
    case RobustKernel::soft_l1:
      return std::make_shared<ceres::SoftLOneLoss>(scale);
    case RobustKernel::cauchy:
      return std::make_shared<ceres::CauchyLoss>(scale);
    case RobustKernel::tukey:
      return std::make_shared<ceres::TukeyLoss>(scale);
    case RobustKernel::none:
      break;
  }
  return std::make_shared<ceres::TrivialLoss>();
}

}  // namespace

std::string_view name_of(Loss l) noexcept { return name_in(names(l), l); }
std::string_view name_of(RobustKernel k) noexcept { return name_in(names(k), k); }
std::string_view name_of(Weight w) noexcept { return name_in(names(w), w); }

template <>
std::optional<Loss> parse_name<Loss>(std::string_view name) noexcept {
  return value_in(names(Loss{}), name);
}
template <>
std::string names_of<Loss>() {
  return names_in(names(Loss{}));
}
template <>
std::optional<RobustKernel> parse_name<RobustKernel>(std::string_view name) noexcept {
  return value_in(names(RobustKernel{}), name);
}
template <>
std::string names_of<RobustKernel>() {
  return names_in(names(RobustKernel{}));
}
template <>
std::optional<Weight> parse_name<Weight>(std::string_view name) noexcept {
  return value_in(names(Weight{}), name);
}
template <>
std::string names_of<Weight>() {
  return names_in(names(Weight{}));
}

Transformed transformed(Loss loss, double f) noexcept {
  if (loss == Loss::log1p) {
    const double size = std::fabs(f);
    return {std::copysign(std::log1p(size), f), 1.0 / (1.0 + size)};
  }
  if (loss == Loss::cube_root) {
    constexpr double softened = 1e-4;
    const double f2 = f * f;
    const double sum = f2 + softened * softened;
    const double root = std::cbrt(sum);
    return {f / root, (f2 / 3.0 + softened * softened) / (sum * root)};
  }
  return {f, 1.0};
}

RobustLoss::RobustLoss(RobustKernel kernel, double scale)
    : kernel_(kernel), scale_(scale), function_(function_of(kernel, scale)) {}

RobustLoss::Value RobustLoss::at(double squared_residual) const {
  std::array<double, 3> rho{};
  function_->Evaluate(squared_residual, rho.data());
  return {rho[0], rho[1], rho[1] + 2.0 * squared_residual * rho[2]};
}

double RobustLoss::tuning(RobustKernel kernel) noexcept {
  if (kernel == RobustKernel::cauchy) return 2.3849;
  if (kernel == RobustKernel::tukey) return 4.6851;
  return 1.345;
}

}  // namespace goniofit
