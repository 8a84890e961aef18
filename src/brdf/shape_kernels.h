#pragma once
// The shape factors of dd and fs for a whole batch of directions, isotropic and in the rough limit: what most fits
// compute at each point of their search, by the loops of block_loops.h.

#include "surface_shape.h"

namespace goniofit {

/// Whether shape_columns has the tiers.
[[nodiscard]] constexpr bool has_kernel(const ShapeSettings& s) noexcept {
  return s.distribution == DistributionTier::rough_limit && !s.anisotropic;
}

/// Whether shape_columns has their derivatives.
[[nodiscard]] constexpr bool has_derivative_kernel(const ShapeSettings& s) noexcept {
  const bool shadowing = s.shadowing == ShadowingTier::li_torrance || s.shadowing == ShadowingTier::none;
  const bool roughness = s.effective_roughness == EffectiveRoughnessTier::li_torrance ||
                         s.effective_roughness == EffectiveRoughnessTier::none;
  return has_kernel(s) && shadowing && roughness;
}

/// dd[i], fs[i] = shape factors at pairs[i]; either pointer may be null. Directions with a cosine <= 0 are the caller's
/// to leave out. Precondition: has_kernel(settings).
void shape_columns(const PairBatch& pairs, const ShapeSettings& settings, double log_slope, double* dd, double* fs);

/// One column with its derivative by ln slope. Both pointers may be null, not one alone.
struct ColumnWithDerivative {
  double* values = nullptr;
  double* derivatives = nullptr;
};
/// The same with derivatives. Precondition: has_derivative_kernel(settings).
void shape_columns(const PairBatch& pairs, const ShapeSettings& settings, double log_slope,
                   const ColumnWithDerivative& dd, const ColumnWithDerivative& fs);

}  // namespace goniofit
