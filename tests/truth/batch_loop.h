#pragma once
// The shape templates as SIMD batches: one loop over a PairBatch for every combination of tiers, its settings known at
// compile time. Private to the files batch_*.cpp, which are compiled for vectorisation.

#include "batch_loops.h"
#include "brdf/shape_loop.h"

namespace goniofit::stability::batch_loop {

template <ShadowingTier shadowing, EffectiveRoughnessTier roughness, DistributionTier distribution, bool anisotropic>
GONIOFIT_VECTOR_CLONES void dd(const PairBatch& pairs, const SurfaceParameters<double>& surface, double floor_bound,
                               double* values) {
  constexpr ShapeSettings settings{shadowing, roughness, distribution, {}, anisotropic};
  const math::FloorAt floor{floor_bound};
  const SurfaceParameters<double> s = surface;
  const std::size_t n = pairs.size();
#pragma GCC ivdep
  for (std::size_t i = 0; i < n; ++i) {
    const Pair p = pairs[i];
    const SurfaceTerms<double> t = surface_terms(settings, s, p, floor);
    values[i] = dd_shape(settings, s, t, 1.0, p, floor);
  }
}

template <EffectiveRoughnessTier roughness, FsForm form, bool anisotropic>
GONIOFIT_VECTOR_CLONES void fs(const PairBatch& pairs, const SurfaceParameters<double>& surface, double floor_bound,
                               double* values) {
  constexpr ShapeSettings settings{
      ShadowingTier::none, roughness, DistributionTier::rough_limit, {.fs = form}, anisotropic};
  const math::FloorAt floor{floor_bound};
  const SurfaceParameters<double> s = surface;
  const std::size_t n = pairs.size();
#pragma GCC ivdep
  for (std::size_t i = 0; i < n; ++i) {
    const Pair p = pairs[i];
    const SurfaceTerms<double> t = surface_terms(settings, s, p, floor);
    values[i] = fs_shape(settings, s, t, p, floor);
  }
}

/// Calls f.template operator()<shadowing, roughness, anisotropic>() for all of them.
template <class F>
void for_all_tiers(const F& f) {
  const auto with_shadowing = [&]<ShadowingTier shadowing>() {
    const auto with_roughness = [&]<EffectiveRoughnessTier roughness>() {
      f.template operator()<shadowing, roughness, false>();
      f.template operator()<shadowing, roughness, true>();
    };
    with_roughness.template operator()<EffectiveRoughnessTier::li_torrance>();
    with_roughness.template operator()<EffectiveRoughnessTier::he>();
    with_roughness.template operator()<EffectiveRoughnessTier::none>();
  };
  with_shadowing.template operator()<ShadowingTier::li_torrance>();
  with_shadowing.template operator()<ShadowingTier::smith>();
  with_shadowing.template operator()<ShadowingTier::schlick>();
  with_shadowing.template operator()<ShadowingTier::none>();
}

template <DistributionTier distribution>
[[nodiscard]] std::vector<BatchLoop> dd_loops() {
  std::vector<BatchLoop> loops;
  for_all_tiers([&]<ShadowingTier shadowing, EffectiveRoughnessTier roughness, bool anisotropic>() {
    loops.push_back(
        {{shadowing, roughness, distribution, {}, anisotropic}, &dd<shadowing, roughness, distribution, anisotropic>});
  });
  return loops;
}

}  // namespace goniofit::stability::batch_loop
