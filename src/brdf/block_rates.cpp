#include "brdf/block_loops.h"
#include "brdf/published_visibility.h"
#include "support/vectorised.h"

namespace goniofit::block {

namespace {

// Where exp() of a lane no longer follows its argument.
constexpr double least_exponent = lane::Format<double>::least_exponent;

// With x = -ln w = -q/5 ln(1-c) and w = (1-c)^(q/5), d w/d ln slope = x w, so that
//   d ln S1   = -5 x w⁵/(1 - w⁵)
//   d growth  = -growth + 1.6 q Σ x w⁸/(1 - w⁸).
template <bool shadowed, ShadowingTier shadowing, EffectiveRoughnessTier roughness>
struct VisibilityRates {
  using Arguments = VisibilityRateArguments;

  [[gnu::always_inline]] static void run(const Arguments& arguments) {
    using T = Lane<double>;
    constexpr bool published_shadowing = shadowed && shadowing == ShadowingTier::li_torrance;
    constexpr bool grows = roughness == EffectiveRoughnessTier::li_torrance;
    const VisibilityArguments<double>& a = arguments.values;
    const double* const cos_i = a.g[Field::cos_i];
    const double* const cos_r = a.g[Field::cos_r];
    const double* const log_i = a.g[Field::log_one_minus_cos_i];
    const double* const log_r = a.g[Field::log_one_minus_cos_r];
    double* const shadow = a.t->shadowing.data();
    double* const growth = a.t->growth.data();
    double* const inverse = a.t->inverse_m_e2.data();
    double* const shadow_rate = arguments.rates->shadowing.data();
    double* const growth_rate = arguments.rates->growth.data();
    const T q = a.inverse_slope;
    const T two_log_slope = 2 * a.log_slope;
    const std::size_t n = a.n;
#pragma GCC ivdep
    for (std::size_t k = 0; k < n; ++k) {
      Published<T> i{};
      Published<T> r{};
      T depth_i = 0.0;
      T depth_r = 0.0;
      if constexpr (published_shadowing || grows) {
        constexpr double most = 8.5171931914162381;  // -ln(1 - all_lit)
        i = published(q, T(log_i[k]));
        r = published(q, T(log_r[k]));
        depth_i = lane::at_most(most, (-0.2 * q * T(log_i[k])).v);
        depth_r = lane::at_most(most, (-0.2 * q * T(log_r[k])).v);
      }
      if constexpr (published_shadowing) {
        const T both = i.lit * r.lit;
        const T falls = depth_i * (1.0 - i.lit) * r.lit + depth_r * (1.0 - r.lit) * i.lit;
        shadow[k] = (both / (T(cos_i[k]) * T(cos_r[k]))).v;
        shadow_rate[k] = (-5.0 * falls / both).v;
      } else if constexpr (shadowed) {
        shadow[k] = 1.0 / (cos_i[k] * cos_r[k]);
        shadow_rate[k] = 0.0;
      }
      if constexpr (!grows) continue;
      const T falls = depth_i * i.hidden * r.seen + depth_r * r.hidden * i.seen;
      growth[k] = (i.seen * r.seen).v;
      growth_rate[k] = (1.6 * q * falls / (i.seen * r.seen)).v;
      inverse[k] = hidden_of_both(i, r).v;
    }
    if constexpr (!grows) return;
      // Loops of their own, as in the loop of the values.
#pragma GCC ivdep
    for (std::size_t k = 0; k < n; ++k) {
      growth[k] = published_growth(q, T(growth[k]), T(inverse[k])).v;
      growth_rate[k] -= growth[k];
    }
#pragma GCC ivdep
    for (std::size_t k = 0; k < n; ++k) inverse[k] = exp(T(growth[k]) - two_log_slope).v;
  }
};

// ln dd = ln S + growth - 2 ln slope - y + const, y = ¼ tan²θ_b e^growth / slope²: d = d ln S + (d growth - 2)(1 - y).
template <bool grows>
struct DirectionalDiffuseRate {
  using Arguments = LobeRateArguments;

  [[gnu::always_inline]] static void run(const Arguments& arguments) {
    using T = Lane<double>;
    const LobeArguments<double>& a = arguments.values;
    const double* const tan2_b = a.g[Field::tan2_b];
    const double* const dd = a.t->dd.data();
    const double* const growth = a.t->growth.data();
    const double* const inverse = a.t->inverse_m_e2.data();
    const double* const shadow_rate = arguments.rates->shadowing.data();
    const double* const growth_rate = arguments.rates->growth.data();
    double* const rate = arguments.rate;
    const T scale = -2 * a.log_slope;
    const T inverse_m2 = a.inverse_m2;
    const std::size_t n = a.n;
#pragma GCC ivdep
    for (std::size_t k = 0; k < n; ++k) {
      const T y = 0.25 * T(tan2_b[k]) * (grows ? T(inverse[k]) : inverse_m2);
      const T up = grows ? T(growth[k]) : T(0.0);
      const T widens = grows ? T(growth_rate[k]) - 2.0 : T(-2.0);
      const T by_lobe = dd[k] * (T(shadow_rate[k]) + widens * (1.0 - y));
      rate[k] = scale + up - y > least_exponent ? by_lobe.v : (dd[k] * T(shadow_rate[k])).v;
    }
  }
};

// ln fs = -y + const, y = tan²θ_f e^growth / (16 slope²).
template <FsForm form, bool grows>
struct ForwardScatteringRate {
  using Arguments = LobeRateArguments;

  [[gnu::always_inline]] static void run(const Arguments& arguments) {
    using T = Lane<double>;
    const LobeArguments<double>& a = arguments.values;
    const double* const tan2 = a.g[Field::tan2_f];
    const double* const swapped = a.g[Field::tan2_f_swapped];
    const double* const fs = a.t->fs.data();
    const double* const inverse = a.t->inverse_m_e2.data();
    const double* const growth_rate = arguments.rates->growth.data();
    double* const rate = arguments.rate;
    const T inverse_m2 = a.inverse_m2;
    const std::size_t n = a.n;
#pragma GCC ivdep
    for (std::size_t k = 0; k < n; ++k) {
      T angle = T(tan2[k]);
      if constexpr (form == FsForm::reciprocal) angle = 0.5 * (angle + T(swapped[k]));
      const T y = 0.0625 * angle * (grows ? T(inverse[k]) : inverse_m2);
      const T narrows = grows ? 2.0 - T(growth_rate[k]) : T(2.0);
      const T by_lobe = fs[k] * y * narrows;
      rate[k] = y.v < -least_exponent ? by_lobe.v : 0.0;
    }
  }
};

template <bool shadowed, ShadowingTier shadowing>
Loop<VisibilityRateArguments> by_roughness(EffectiveRoughnessTier roughness, InstructionSet set) {
  using enum EffectiveRoughnessTier;
  return roughness == li_torrance ? Vectorised<VisibilityRates<shadowed, shadowing, li_torrance>>::of(set)
                                  : Vectorised<VisibilityRates<shadowed, shadowing, none>>::of(set);
}

template <FsForm form>
Loop<LobeRateArguments> by_growth(bool grows, InstructionSet set) {
  return grows ? Vectorised<ForwardScatteringRate<form, true>>::of(set)
               : Vectorised<ForwardScatteringRate<form, false>>::of(set);
}

}  // namespace

Loop<VisibilityRateArguments> visibility_rates(bool shadowed, ShadowingTier shadowing, EffectiveRoughnessTier roughness,
                                               InstructionSet set) {
  using enum ShadowingTier;
  if (!shadowed) return by_roughness<false, none>(roughness, set);
  return shadowing == li_torrance ? by_roughness<true, li_torrance>(roughness, set)
                                  : by_roughness<true, none>(roughness, set);
}

Loop<LobeRateArguments> directional_diffuse_rate(bool grows, InstructionSet set) {
  return grows ? Vectorised<DirectionalDiffuseRate<true>>::of(set) : Vectorised<DirectionalDiffuseRate<false>>::of(set);
}

Loop<LobeRateArguments> forward_scattering_rate(FsForm form, bool grows, InstructionSet set) {
  return form == FsForm::printed ? by_growth<FsForm::printed>(grows, set) : by_growth<FsForm::reciprocal>(grows, set);
}

}  // namespace goniofit::block
