#pragma once
// The terms of one material as polynomials of a cosine: what a program with a tolerance evaluates in their place.

#include <optional>

#include "../basis/optics.h"
#include "../terms/polynomial_fit.h"
#include "surface_shape.h"

namespace goniofit::batch {

/// See block::CurveArguments, which takes these.
struct VisibilityCurves {
  FittedPolynomial lit, seen, growth;
  double lit_reach = 1.0, seen_reach = 1.0;

  [[nodiscard]] std::size_t coefficients() const noexcept;
};

/// Isotropic surfaces; S1 relative, ln sigma_e absolute within the tolerance. nullopt where the tiers are cheaper as
/// they stand, or where polynomials of a reasonable length do not hold it (slopes of 0.5 and more at 1e-10).
[[nodiscard]] std::optional<VisibilityCurves> visibility_curves(const ShapeSettings& settings, bool shadowed,
                                                                double slope, double tail, double tolerance,
                                                                PolynomialArithmetic arithmetic);
/// Tier he's curve holds up to a hidden depth of 1000: nearer to the horizon than this it may be exceeded.
inline constexpr double he_curve_horizon = 2e-3;

/// F(u) and T(c)/c of tier exact, relative; nullopt where they do not hold the tolerance (total reflection has a kink).
[[nodiscard]] std::optional<FittedPolynomial> reflection_curve(double n, double kappa, double tolerance,
                                                               PolynomialArithmetic arithmetic);
[[nodiscard]] std::optional<FittedPolynomial> transmission_curve(double n, double kappa, double tolerance,
                                                                 PolynomialArithmetic arithmetic);

}  // namespace goniofit::batch
