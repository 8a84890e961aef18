#include <utility>

#include "brdf/block_loops.h"
#include "brdf/published_visibility.h"
#include "support/vectorised.h"

namespace goniofit::block {

namespace {

/// Its square is nothing beside 1, and no product of it is a denormal number.
template <class Real>
constexpr double negligible_depth = std::is_same_v<Real, float> ? 1e-6 : 1e-10;

template <class T>
[[gnu::always_inline]] inline T stepped(T lit, T cos, T unit_from) {
  return cos > unit_from ? T(1.0) : lit;
}

template <class Real, bool shadowed, ShadowingTier shadowing, EffectiveRoughnessTier roughness>
struct Visibility {
  using Arguments = VisibilityArguments<Real>;

  [[gnu::always_inline]] static void run(const Arguments& a) {
    using T = Lane<Real>;
    constexpr bool published_shadowing = shadowed && shadowing == ShadowingTier::li_torrance;
    constexpr bool published_roughness = roughness == EffectiveRoughnessTier::li_torrance;
    const Real* const cos_i = a.g[Field::cos_i];
    const Real* const cos_r = a.g[Field::cos_r];
    const Real* const rest_i = a.g[Field::one_minus_cos_i];
    const Real* const rest_r = a.g[Field::one_minus_cos_r];
    const Real* const log_i = a.g[Field::log_one_minus_cos_i];
    const Real* const log_r = a.g[Field::log_one_minus_cos_r];
    Real* const shadow = a.t->shadowing.data();
    Real* const growth = a.t->growth.data();
    Real* const inverse = a.t->inverse_m_e2.data();
    const T slope = a.slope;
    const T q = a.inverse_slope;
    const T two_log_slope = 2 * a.log_slope;
    const T unit_from = a.unit_shadowing_from;
    const std::size_t n = a.n;
    // Steps in loops of their own: in one body, a processor waits for the end of a long chain before it has room for
    // the next.
    if constexpr (published_shadowing || published_roughness) {
#pragma GCC ivdep
      for (std::size_t k = 0; k < n; ++k) {
        const Published<T> i = published(q, T(log_i[k]));
        if constexpr (published_shadowing) shadow[k] = stepped(i.lit, T(cos_i[k]), unit_from).v;
        if constexpr (published_roughness) {
          growth[k] = i.seen.v;
          inverse[k] = i.hidden.v;
        }
      }
    }
#pragma GCC ivdep
    for (std::size_t k = 0; k < n; ++k) {
      Published<T> r{};
      if constexpr (published_shadowing || published_roughness) r = published(q, T(log_r[k]));
      if constexpr (published_shadowing) {
        const T both = T(shadow[k]) * stepped(r.lit, T(cos_r[k]), unit_from);
        shadow[k] = (both / (T(cos_i[k]) * T(cos_r[k]))).v;
      } else if constexpr (shadowed && shadowing == ShadowingTier::smith) {
        shadow[k] = (shadowing_smith_over_cosine(slope, T(cos_i[k]), sine(T(cos_i[k]), T(rest_i[k]))) *
                     shadowing_smith_over_cosine(slope, T(cos_r[k]), sine(T(cos_r[k]), T(rest_r[k]))))
                        .v;
      } else if constexpr (shadowed && shadowing == ShadowingTier::schlick) {
        shadow[k] =
            (shadowing_schlick_over_cosine(slope, T(cos_i[k])) * shadowing_schlick_over_cosine(slope, T(cos_r[k]))).v;
      } else if constexpr (shadowed) {
        shadow[k] = Real(1) / (cos_i[k] * cos_r[k]);
      }
      if constexpr (published_roughness) {
        const Published<T> i{{}, growth[k], inverse[k]};
        growth[k] = (i.seen * r.seen).v;
        inverse[k] = hidden_of_both(i, r).v;
      } else if constexpr (roughness == EffectiveRoughnessTier::he) {
        growth[k] = (he_hidden_depth(slope, T(cos_i[k]), sine(T(cos_i[k]), T(rest_i[k]))) +
                     he_hidden_depth(slope, T(cos_r[k]), sine(T(cos_r[k]), T(rest_r[k]))))
                        .v;
      }
    }
    if constexpr (roughness == EffectiveRoughnessTier::none) return;
#pragma GCC ivdep
    for (std::size_t k = 0; k < n; ++k) {
      if constexpr (published_roughness) {
        growth[k] = published_growth(q, T(growth[k]), T(inverse[k])).v;
      } else {
        growth[k] = (-2.0 * log_effective_roughness_he(T(growth[k]), negligible_depth<Real>)).v;
      }
    }
#pragma GCC ivdep
    for (std::size_t k = 0; k < n; ++k) inverse[k] = exp(T(growth[k]) - two_log_slope).v;
  }
};

template <class Real, bool shadowed, ShadowingTier shadowing>
Loop<VisibilityArguments<Real>> by_roughness(EffectiveRoughnessTier roughness, InstructionSet set) {
  using enum EffectiveRoughnessTier;
  switch (roughness) {
    case li_torrance:
      return Vectorised<Visibility<Real, shadowed, shadowing, li_torrance>>::of(set);
    case he:
      return Vectorised<Visibility<Real, shadowed, shadowing, he>>::of(set);
    case none:
      break;
  }
  return Vectorised<Visibility<Real, shadowed, shadowing, none>>::of(set);
}

}  // namespace

Fields fields_of(bool shadowed, ShadowingTier shadowing, EffectiveRoughnessTier roughness) {
  Fields f{Field::cos_i, Field::cos_r};
  if ((shadowed && shadowing == ShadowingTier::li_torrance) || roughness == EffectiveRoughnessTier::li_torrance) {
    f |= {Field::log_one_minus_cos_i, Field::log_one_minus_cos_r};
  }
  if ((shadowed && shadowing == ShadowingTier::smith) || roughness == EffectiveRoughnessTier::he) {
    f |= {Field::one_minus_cos_i, Field::one_minus_cos_r};
  }
  return f;
}

template <class Real>
Loop<VisibilityArguments<Real>> visibility(bool shadowed, ShadowingTier shadowing, EffectiveRoughnessTier roughness,
                                           InstructionSet set) {
  using enum ShadowingTier;
  if (!shadowed) return by_roughness<Real, false, none>(roughness, set);
  switch (shadowing) {
    case li_torrance:
      return by_roughness<Real, true, li_torrance>(roughness, set);
    case smith:
      return by_roughness<Real, true, smith>(roughness, set);
    case schlick:
      return by_roughness<Real, true, schlick>(roughness, set);
    case none:
      break;
  }
  return by_roughness<Real, true, none>(roughness, set);
}

template Loop<VisibilityArguments<double>> visibility(bool, ShadowingTier, EffectiveRoughnessTier, InstructionSet);
template Loop<VisibilityArguments<float>> visibility(bool, ShadowingTier, EffectiveRoughnessTier, InstructionSet);

}  // namespace goniofit::block
