#include <numbers>
#include <utility>

#include "brdf/block_loops.h"
#include "support/lane_math.h"
#include "support/vectorised.h"

namespace goniofit::block {

namespace {

template <std::size_t n, class Real>
struct Short {
  Real scale, offset;
  std::array<Real, n> c;

  explicit Short(const Polynomial<Real>& p) : scale(p.scale), offset(p.offset), c{} {
    for (std::size_t k = 0; k < n; ++k) c[k] = p.c[k];
  }
  [[nodiscard]] [[gnu::always_inline]] Real operator()(Real x) const { return lane::polynomial(c, scale * x + offset); }
};

template <class Real, std::size_t coefficients, bool shadowed, EffectiveRoughnessTier roughness>
struct Curves {
  using Arguments = CurveArguments<Real>;

  [[gnu::always_inline]] static void run(const Arguments& a) {
    using T = Lane<Real>;
    const Real* const cos_i = a.g[Field::cos_i];
    const Real* const cos_r = a.g[Field::cos_r];
    Real* const shadow = a.t->shadowing.data();
    Real* const growth = a.t->growth.data();
    Real* const inverse = a.t->inverse_m_e2.data();
    const Short<coefficients, Real> lit(*a.lit);
    const Short<coefficients, Real> seen(*a.seen);
    const Short<coefficients, Real> by_depth(*a.growth);
    const Real lit_reach = a.lit_reach;
    const Real seen_reach = a.seen_reach;
    const Real tenth = Real(-0.2) * a.inverse_slope;
    const Real two_log_slope = 2 * a.log_slope;
    const std::size_t n = a.n;
    // Each curve in a loop of its own: in one body, a processor waits for the end of a long chain before it has room
    // for the next.
    if constexpr (shadowed) {
#pragma GCC ivdep
      for (std::size_t k = 0; k < n; ++k) {
        const Real i = lane::at_most(lit_reach, cos_i[k]);
        shadow[k] = i * lit(i);
      }
#pragma GCC ivdep
      for (std::size_t k = 0; k < n; ++k) {
        const Real r = lane::at_most(lit_reach, cos_r[k]);
        shadow[k] = shadow[k] * (r * lit(r)) / (cos_i[k] * cos_r[k]);
      }
    }
    if constexpr (roughness == EffectiveRoughnessTier::none) return;
      // What is seen of both, or hidden of either.
#pragma GCC ivdep
    for (std::size_t k = 0; k < n; ++k) {
      const Real i = lane::at_most(seen_reach, cos_i[k]);
      growth[k] = roughness == EffectiveRoughnessTier::he ? seen(i) * cos_r[k] : i * seen(i);
    }
#pragma GCC ivdep
    for (std::size_t k = 0; k < n; ++k) {
      const Real r = lane::at_most(seen_reach, cos_r[k]);
      growth[k] = roughness == EffectiveRoughnessTier::he ? (growth[k] + seen(r) * cos_i[k]) / (cos_i[k] * cos_r[k])
                                                          : growth[k] * (r * seen(r));
    }
#pragma GCC ivdep
    for (std::size_t k = 0; k < n; ++k) {
      if constexpr (roughness == EffectiveRoughnessTier::he) {
        constexpr Real scale = Real(std::numbers::e / (8.0 * std::numbers::pi));
        growth[k] = log1p(T(scale * growth[k] * growth[k])).v;
      } else {
        growth[k] = tenth * log(T(growth[k])).v;
      }
    }
    if constexpr (roughness == EffectiveRoughnessTier::he) {
#pragma GCC ivdep
      for (std::size_t k = 0; k < n; ++k) growth[k] = by_depth(growth[k]);
    }
#pragma GCC ivdep
    for (std::size_t k = 0; k < n; ++k) inverse[k] = exp(T(growth[k] - two_log_slope)).v;
  }
};

template <class Real, std::size_t coefficients>
struct FresnelCurve {
  using Arguments = FresnelCurveArguments<Real>;

  [[gnu::always_inline]] static void run(const Arguments& a) {
    const Real* const cos_h = a.g[Field::cos_h];
    Real* const out = a.t->fresnel.data();
    const Short<coefficients, Real> curve(*a.curve);
    const std::size_t n = a.n;
#pragma GCC ivdep
    for (std::size_t k = 0; k < n; ++k) out[k] = curve(cos_h[k]);
  }
};

template <class Real, std::size_t coefficients>
struct TransmissionCurve {
  using Arguments = FresnelCurveArguments<Real>;

  [[gnu::always_inline]] static void run(const Arguments& a) {
    const Real* const cos_i = a.g[Field::cos_i];
    const Real* const cos_r = a.g[Field::cos_r];
    Real* const out = a.t->transmission.data();
    const Short<coefficients, Real> curve(*a.curve);
    const std::size_t n = a.n;
#pragma GCC ivdep
    for (std::size_t k = 0; k < n; ++k) out[k] = (cos_i[k] * curve(cos_i[k])) * (cos_r[k] * curve(cos_r[k]));
  }
};

// Calls f.template operator()<n>() with the least of these that is no less than asked for.
template <class F>
auto with_coefficients(std::size_t asked, const F& f) {
  if (asked <= 12) return f.template operator()<12>();
  if (asked <= 16) return f.template operator()<16>();
  if (asked <= 20) return f.template operator()<20>();
  if (asked <= 24) return f.template operator()<24>();
  if (asked <= 28) return f.template operator()<28>();
  if (asked <= 36) return f.template operator()<36>();
  return f.template operator()<most_coefficients>();
}

}  // namespace

template <class Real>
Loop<CurveArguments<Real>> curves(bool shadowed, EffectiveRoughnessTier roughness, std::size_t coefficients,
                                  InstructionSet set) {
  using enum EffectiveRoughnessTier;
  return with_coefficients(coefficients, [&]<std::size_t n>() -> Loop<CurveArguments<Real>> {
    if (!shadowed) {
      if (roughness == li_torrance) return Vectorised<Curves<Real, n, false, li_torrance>>::of(set);
      return Vectorised<Curves<Real, n, false, he>>::of(set);
    }
    if (roughness == li_torrance) return Vectorised<Curves<Real, n, true, li_torrance>>::of(set);
    if (roughness == he) return Vectorised<Curves<Real, n, true, he>>::of(set);
    return Vectorised<Curves<Real, n, true, none>>::of(set);
  });
}

template <class Real>
Loop<FresnelCurveArguments<Real>> fresnel_curve(std::size_t coefficients, InstructionSet set) {
  return with_coefficients(coefficients, [&]<std::size_t n>() { return Vectorised<FresnelCurve<Real, n>>::of(set); });
}
template <class Real>
Loop<FresnelCurveArguments<Real>> transmission_curve(std::size_t coefficients, InstructionSet set) {
  return with_coefficients(coefficients,
                           [&]<std::size_t n>() { return Vectorised<TransmissionCurve<Real, n>>::of(set); });
}

template Loop<CurveArguments<double>> curves(bool, EffectiveRoughnessTier, std::size_t, InstructionSet);
template Loop<CurveArguments<float>> curves(bool, EffectiveRoughnessTier, std::size_t, InstructionSet);
template Loop<FresnelCurveArguments<double>> fresnel_curve(std::size_t, InstructionSet);
template Loop<FresnelCurveArguments<float>> fresnel_curve(std::size_t, InstructionSet);
template Loop<FresnelCurveArguments<double>> transmission_curve(std::size_t, InstructionSet);
template Loop<FresnelCurveArguments<float>> transmission_curve(std::size_t, InstructionSet);

}  // namespace goniofit::block
