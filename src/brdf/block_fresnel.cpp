#include "brdf/block_loops.h"
#include "support/lane_math.h"
#include "support/vectorised.h"

namespace goniofit::block {

namespace {

template <class Real>
struct ExactFresnel {
  using Arguments = FresnelArguments<Real>;

  [[gnu::always_inline]] static void run(const Arguments& a) {
    using T = Lane<Real>;
    const Real* const cos_h = a.g[Field::cos_h];
    const Real* const rest_h = a.g[Field::one_minus_cos_h];
    Real* const out = a.t->fresnel.data();
    const T index = a.index;
    const T kappa = a.kappa;
    const std::size_t n = a.n;
#pragma GCC ivdep
    for (std::size_t k = 0; k < n; ++k) out[k] = fresnel_exact(index, kappa, T(cos_h[k]), T(rest_h[k])).v;
  }
};

template <class Real>
struct ExactTransmission {
  using Arguments = FresnelArguments<Real>;

  [[gnu::always_inline]] static void run(const Arguments& a) {
    using T = Lane<Real>;
    const Real* const cos_i = a.g[Field::cos_i];
    const Real* const cos_r = a.g[Field::cos_r];
    const Real* const rest_i = a.g[Field::one_minus_cos_i];
    const Real* const rest_r = a.g[Field::one_minus_cos_r];
    Real* const out = a.t->transmission.data();
    const T index = a.index;
    const T kappa = a.kappa;
    const std::size_t n = a.n;
#pragma GCC ivdep
    for (std::size_t k = 0; k < n; ++k) {
      out[k] = (transmission_exact(index, kappa, T(cos_i[k]), T(rest_i[k])) *
                transmission_exact(index, kappa, T(cos_r[k]), T(rest_r[k])))
                   .v;
    }
  }
};

}  // namespace

template <class Real>
Loop<FresnelArguments<Real>> exact_fresnel(InstructionSet set) {
  return Vectorised<ExactFresnel<Real>>::of(set);
}
template <class Real>
Loop<FresnelArguments<Real>> exact_transmission(InstructionSet set) {
  return Vectorised<ExactTransmission<Real>>::of(set);
}

template Loop<FresnelArguments<double>> exact_fresnel(InstructionSet);
template Loop<FresnelArguments<float>> exact_fresnel(InstructionSet);
template Loop<FresnelArguments<double>> exact_transmission(InstructionSet);
template Loop<FresnelArguments<float>> exact_transmission(InstructionSet);

}  // namespace goniofit::block
