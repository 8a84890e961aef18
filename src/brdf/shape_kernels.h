#pragma once
// The shape factors of dd and fs for a whole batch of directions: what a fit computes at each point of its search. The
// loop is a template on the scalar, instantiated for double here and for a dual number in fit/, and vectorised by the
// compiler with the C library's vector functions (relative error a few 1e-16; the scalar Evaluator is the reference).

#include "effects.h"

namespace goniofit {

/// Which tiers and forms a batch is evaluated with.
struct ShapeSettings {
  ShadowingTier shadowing = ShadowingTier::li_torrance;
  EffectiveRoughnessTier effective_roughness = EffectiveRoughnessTier::li_torrance;
  FsForm fs_form = FsForm::printed;

  [[nodiscard]] static ShapeSettings of(const Terms& terms, FsForm form) noexcept {
    return {terms.shadowing, terms.effective_roughness, form};
  }
};

/// Calls f.template operator()<shadowing, roughness>() with the tiers as compile-time constants.
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
/// to leave out.
void shape_columns(const PairBatch& pairs, const ShapeSettings& settings, double log_slope, double* dd, double* fs);

}  // namespace goniofit
