#include <numbers>

#include "brdf/block_loops.h"
#include "support/lane_math.h"
#include "support/vectorised.h"

namespace goniofit::block {

namespace {

template <class T>
[[gnu::always_inline]] inline T normalisation(T tan2_b) {
  const T sec2 = 1.0 + tan2_b;
  return sec2 * sec2 * (0.0625 / std::numbers::pi);
}

template <class Real, DistributionTier distribution, bool grows>
struct DirectionalDiffuse {
  using Arguments = LobeArguments<Real>;

  [[gnu::always_inline]] static void run(const Arguments& a) {
    using T = Lane<Real>;
    const Real* const tan2_b = a.g[Field::tan2_b];
    const Real* const shadow = a.t->shadowing.data();
    const Real* const growth = a.t->growth.data();
    const Real* const inverse = a.t->inverse_m_e2.data();
    Real* const dd = a.t->dd.data();
    const T scale = -2 * a.log_slope;
    const T inverse_m2 = a.inverse_m2;
    const T tail = a.tail;
    const std::size_t n = a.n;
#pragma GCC ivdep
    for (std::size_t k = 0; k < n; ++k) {
      const T up = grows ? T(growth[k]) : T(0.0);
      T exponent = 0.0;
      if constexpr (distribution == DistributionTier::student_t) {
        exponent = scale + up + student_t_exponent(T(0.25 * T(tan2_b[k]) * inverse_m2), up, tail);
      } else {
        exponent = scale + up - 0.25 * T(tan2_b[k]) * (grows ? T(inverse[k]) : inverse_m2);
      }
      const T value = T(shadow[k]) * normalisation(T(tan2_b[k])) * exp(exponent);
      dd[k] = lane::at_most(most_shape<Real>, value.v);
    }
  }
};

template <class Real, FsForm form, bool grows>
struct ForwardScattering {
  using Arguments = LobeArguments<Real>;

  [[gnu::always_inline]] static void run(const Arguments& a) {
    using T = Lane<Real>;
    const Real* const rest_i = a.g[Field::one_minus_cos_i];
    const Real* const rest_r = a.g[Field::one_minus_cos_r];
    const Real* const tan2 = a.g[Field::tan2_f];
    const Real* const swapped = a.g[Field::tan2_f_swapped];
    const Real* const forward = a.g[Field::forward];
    const Real* const inverse = a.t->inverse_m_e2.data();
    Real* const fs = a.t->fs.data();
    const T inverse_m2 = a.inverse_m2;
    const std::size_t n = a.n;
#pragma GCC ivdep
    for (std::size_t k = 0; k < n; ++k) {
      T angle = T(tan2[k]);
      if constexpr (form == FsForm::reciprocal) angle = 0.5 * (angle + T(swapped[k]));
      const T lobe = exp_of_negative(T(-0.0625 * angle * (grows ? T(inverse[k]) : inverse_m2)));
      // `forward` is 1 or 0.
      fs[k] = (T(rest_i[k]) * T(rest_r[k]) * T(forward[k]) * (1.0 / std::numbers::pi) * lobe).v;
    }
  }
};

template <class Real, bool grows>
struct WaveArgumentsLoop {
  using Arguments = WaveLoopArguments<Real>;

  [[gnu::always_inline]] static void run(const Arguments& a) {
    using T = Lane<Real>;
    const Real* const s_z = a.g[Field::s_z];
    const Real* const s_h2 = a.g[Field::s_h2];
    const Real* const growth = a.t->growth.data();
    Real* const log_g = a.t->log_g.data();
    Real* const x = a.t->x.data();
    const T log_phase = a.log_phase;
    const T x_scale = a.x_scale;
    const std::size_t n = a.n;
#pragma GCC ivdep
    for (std::size_t k = 0; k < n; ++k) {
      log_g[k] = (2.0 * (log(T(s_z[k])) + log_phase) - (grows ? T(growth[k]) : T(0.0))).v;
      x[k] = (x_scale * T(s_h2[k])).v;
    }
  }
};

// 1/m_e² g W.
template <class Real, bool grows>
struct WaveLobe {
  using Arguments = WaveLoopArguments<Real>;

  [[gnu::always_inline]] static void run(const Arguments& a) {
    using T = Lane<Real>;
    const Real* const tan2_b = a.g[Field::tan2_b];
    const Real* const shadow = a.t->shadowing.data();
    const Real* const growth = a.t->growth.data();
    const Real* const log_g = a.t->log_g.data();
    const Real* const log_w = a.t->log_w.data();
    Real* const dd = a.t->dd.data();
    const T scale = -2 * a.log_slope;
    const std::size_t n = a.n;
#pragma GCC ivdep
    for (std::size_t k = 0; k < n; ++k) {
      const T up = grows ? T(growth[k]) : T(0.0);
      const T value = T(shadow[k]) * normalisation(T(tan2_b[k])) * exp(scale + up + T(log_g[k]) + T(log_w[k]));
      dd[k] = lane::at_most(most_shape<Real>, value.v);
    }
  }
};

}  // namespace

template <class Real>
Loop<LobeArguments<Real>> directional_diffuse(DistributionTier distribution, bool grows, InstructionSet set) {
  using enum DistributionTier;
  if (distribution == student_t) {
    return grows ? Vectorised<DirectionalDiffuse<Real, student_t, true>>::of(set)
                 : Vectorised<DirectionalDiffuse<Real, student_t, false>>::of(set);
  }
  return grows ? Vectorised<DirectionalDiffuse<Real, rough_limit, true>>::of(set)
               : Vectorised<DirectionalDiffuse<Real, rough_limit, false>>::of(set);
}

template <class Real>
Loop<LobeArguments<Real>> forward_scattering(FsForm form, bool grows, InstructionSet set) {
  using enum FsForm;
  if (form == printed) {
    return grows ? Vectorised<ForwardScattering<Real, printed, true>>::of(set)
                 : Vectorised<ForwardScattering<Real, printed, false>>::of(set);
  }
  return grows ? Vectorised<ForwardScattering<Real, reciprocal, true>>::of(set)
               : Vectorised<ForwardScattering<Real, reciprocal, false>>::of(set);
}

template <class Real>
Loop<WaveLoopArguments<Real>> wave_arguments_loop(bool grows, InstructionSet set) {
  return grows ? Vectorised<WaveArgumentsLoop<Real, true>>::of(set)
               : Vectorised<WaveArgumentsLoop<Real, false>>::of(set);
}
template <class Real>
Loop<WaveLoopArguments<Real>> wave_lobe(bool grows, InstructionSet set) {
  return grows ? Vectorised<WaveLobe<Real, true>>::of(set) : Vectorised<WaveLobe<Real, false>>::of(set);
}

#define GONIOFIT_INSTANTIATE(Real)                                                                \
  template Loop<LobeArguments<Real>> directional_diffuse(DistributionTier, bool, InstructionSet); \
  template Loop<LobeArguments<Real>> forward_scattering(FsForm, bool, InstructionSet);            \
  template Loop<WaveLoopArguments<Real>> wave_arguments_loop(bool, InstructionSet);               \
  template Loop<WaveLoopArguments<Real>> wave_lobe(bool, InstructionSet);
GONIOFIT_INSTANTIATE(double)
GONIOFIT_INSTANTIATE(float)
#undef GONIOFIT_INSTANTIATE

}  // namespace goniofit::block
