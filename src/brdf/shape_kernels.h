#pragma once
// The shape factors of dd and fs for a whole batch of directions, isotropic and in the rough limit: what most fits
// compute at each point of their search, by the loops of block_loops.h.

#include "surface_shape.h"

namespace goniofit {

/// Whether shape_columns has the tiers.
[[nodiscard]] constexpr bool has_kernel(const ShapeSettings& s) noexcept {
  return s.distribution == DistributionTier::rough_limit && !s.anisotropic;
}

/// Whether with_tiers has them, for the loops on dual numbers: each further one doubles what there is to compile.
[[nodiscard]] constexpr bool has_derivative_kernel(const ShapeSettings& s) noexcept {
  const bool shadowing = s.shadowing == ShadowingTier::li_torrance || s.shadowing == ShadowingTier::none;
  const bool roughness = s.effective_roughness == EffectiveRoughnessTier::li_torrance ||
                         s.effective_roughness == EffectiveRoughnessTier::none;
  return has_kernel(s) && shadowing && roughness;
}

/// Calls f.template operator()<shadowing, roughness>() with the tiers as compile-time constants; of such as
/// has_derivative_kernel.
template <class F>
void with_tiers(const ShapeSettings& s, const F& f) {
  using enum EffectiveRoughnessTier;
  if (s.shadowing == ShadowingTier::li_torrance) {
    if (s.effective_roughness == li_torrance) return f.template operator()<ShadowingTier::li_torrance, li_torrance>();
    return f.template operator()<ShadowingTier::li_torrance, none>();
  }
  if (s.effective_roughness == li_torrance) return f.template operator()<ShadowingTier::none, li_torrance>();
  return f.template operator()<ShadowingTier::none, none>();
}

/// The bound of math::FloorAt, in a file of its own so that the compiler does not know its value.
extern const double exponent_floor;

/// dd[i], fs[i] = shape factors at pairs[i]; either pointer may be null. Directions with a cosine <= 0 are the caller's
/// to leave out. Precondition: has_kernel(settings).
void shape_columns(const PairBatch& pairs, const ShapeSettings& settings, double log_slope, double* dd, double* fs);

}  // namespace goniofit
