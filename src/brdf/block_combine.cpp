#include "brdf/block_loops.h"
#include "support/lane_math.h"
#include "support/vectorised.h"

namespace goniofit::block {

namespace {

// 1 - (1-c)⁵.
template <class Real>
[[gnu::always_inline]] inline Real transmitted(Real c) {
  return transmission_schlick(Lane<Real>(1.0), Lane<Real>(c)).v;
}

template <class Real, class Out, Use mirror, Use below, bool with_fs>
struct Combine {
  using Arguments = CombineArguments<Real, Out>;

  [[gnu::always_inline]] static void run(const Arguments& a) {
    const Real* const cos_i = a.g[Field::cos_i];
    const Real* const cos_r = a.g[Field::cos_r];
    const Real* const rest_h = a.g[Field::one_minus_cos_h];
    const Real* const dd = a.t->dd.data();
    const Real* const fs = a.t->fs.data();
    const Real* const fresnel = a.t->fresnel.data();
    const Real* const transmission = a.t->transmission.data();
    const Real mirror_0 = a.mirror_0, mirror_1 = a.mirror_1, below_0 = a.below_0, below_1 = a.below_1;
    const Real diffuse = a.diffuse, most = a.most;
    Out* const out = a.out;
    const std::size_t n = a.n;
#pragma GCC ivdep
    for (std::size_t k = 0; k < n; ++k) {
      Real value = diffuse;
      if constexpr (below != Use::absent) {
        Real k_below = below_0;
        if constexpr (with_fs) k_below += below_1 * fs[k];
        if constexpr (below == Use::schlick) k_below *= transmitted(cos_i[k]) * transmitted(cos_r[k]);
        if constexpr (below == Use::array) k_below *= transmission[k];
        value += k_below;
      }
      if constexpr (mirror != Use::absent) {
        Real k_mirror = mirror_0;
        if constexpr (mirror == Use::schlick) k_mirror += mirror_1 * math::pow5(rest_h[k]);
        if constexpr (mirror == Use::array) k_mirror += mirror_1 * fresnel[k];
        value += k_mirror * dd[k];
      }
      value = value < most ? value : most;
      const bool lit = (cos_i[k] > Real(0)) & (cos_r[k] > Real(0));
      out[k] = static_cast<Out>(lit ? value : Real(0));
    }
  }
};

template <class Real, class Out, Use mirror, Use below>
Loop<CombineArguments<Real, Out>> with_below(bool fs, InstructionSet set) {
  if constexpr (below == Use::absent) {
    return Vectorised<Combine<Real, Out, mirror, below, false>>::of(set);
  } else {
    return fs ? Vectorised<Combine<Real, Out, mirror, below, true>>::of(set)
              : Vectorised<Combine<Real, Out, mirror, below, false>>::of(set);
  }
}

template <class Real, class Out, Use mirror>
Loop<CombineArguments<Real, Out>> with_mirror(Use below, bool fs, InstructionSet set) {
  switch (below) {
    case Use::constant:
      return with_below<Real, Out, mirror, Use::constant>(fs, set);
    case Use::schlick:
      return with_below<Real, Out, mirror, Use::schlick>(fs, set);
    case Use::array:
      return with_below<Real, Out, mirror, Use::array>(fs, set);
    case Use::absent:
      break;
  }
  return with_below<Real, Out, mirror, Use::absent>(fs, set);
}

}  // namespace

template <class Real, class Out>
Loop<CombineArguments<Real, Out>> combine(Use mirror, Use below, bool fs, InstructionSet set) {
  switch (mirror) {
    case Use::constant:
      return with_mirror<Real, Out, Use::constant>(below, fs, set);
    case Use::schlick:
      return with_mirror<Real, Out, Use::schlick>(below, fs, set);
    case Use::array:
      return with_mirror<Real, Out, Use::array>(below, fs, set);
    case Use::absent:
      break;
  }
  return with_mirror<Real, Out, Use::absent>(below, fs, set);
}

template Loop<CombineArguments<double, double>> combine(Use, Use, bool, InstructionSet);
template Loop<CombineArguments<float, float>> combine(Use, Use, bool, InstructionSet);
template Loop<CombineArguments<float, double>> combine(Use, Use, bool, InstructionSet);

}  // namespace goniofit::block
