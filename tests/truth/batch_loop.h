#pragma once
// The shape templates as loops over lanes: one over a PairBatch for every combination of tiers, its settings known at
// compile time. Private to the files batch_*.cpp, which are compiled for vectorisation.

#include <limits>

#include "batch_loops.h"
#include "support/lane_math.h"
#include "support/vectorised.h"

namespace goniofit {

/// He's distribution has no lanes (see batch_loops.h), but the templates name it.
template <class Real>
[[gnu::always_inline]] inline Lane<Real> log_wave_lobe(DistributionTier, const Lane<Real>&, const Lane<Real>&) {
  return std::numeric_limits<Real>::quiet_NaN();
}

}  // namespace goniofit

namespace goniofit::stability::batch_loop {

using T = Lane<double>;

struct ShapeArguments {
  const PairBatch& pairs;
  const SurfaceParameters<double>& surface;
  double* values;
};

template <ShadowingTier shadowing, EffectiveRoughnessTier roughness, DistributionTier distribution, bool anisotropic>
struct DdLoop {
  using Arguments = ShapeArguments;

  [[gnu::always_inline]] static void run(const Arguments& a) {
    constexpr ShapeSettings settings{shadowing, roughness, distribution, {}, anisotropic};
    const SurfaceParameters<T> s{a.surface.log_slope, a.surface.log_slope_y, a.surface.tail, a.surface.log_sigma};
    const std::size_t n = a.pairs.size();
#pragma GCC ivdep
    for (std::size_t i = 0; i < n; ++i) {
      const BasicPair<T> p = a.pairs.as<T>(i);
      const SurfaceTerms<T> t = surface_terms(settings, s, p);
      a.values[i] = dd_shape(settings, s, t, 1.0, p).v;
    }
  }
};

template <EffectiveRoughnessTier roughness, FsForm form, bool anisotropic>
struct FsLoop {
  using Arguments = ShapeArguments;

  [[gnu::always_inline]] static void run(const Arguments& a) {
    constexpr ShapeSettings settings{
        ShadowingTier::none, roughness, DistributionTier::rough_limit, {.fs = form}, anisotropic};
    const SurfaceParameters<T> s{a.surface.log_slope, a.surface.log_slope_y, a.surface.tail, a.surface.log_sigma};
    const std::size_t n = a.pairs.size();
#pragma GCC ivdep
    for (std::size_t i = 0; i < n; ++i) {
      const BasicPair<T> p = a.pairs.as<T>(i);
      const SurfaceTerms<T> t = surface_terms(settings, s, p);
      a.values[i] = fs_shape(settings, s, t, p).v;
    }
  }
};

template <class Loop>
void run(const PairBatch& pairs, const SurfaceParameters<double>& surface, double* values) {
  Vectorised<Loop>::of(best_instruction_set())({pairs, surface, values});
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
    // Shadowing of Student's t is a quadrature: no kernel has it, and its 48 exponentials take the compiler minutes.
    if constexpr (distribution != DistributionTier::student_t || shadowing != ShadowingTier::smith) {
      loops.push_back({{shadowing, roughness, distribution, {}, anisotropic},
                       &run<DdLoop<shadowing, roughness, distribution, anisotropic>>});
    }
  });
  return loops;
}

}  // namespace goniofit::stability::batch_loop
