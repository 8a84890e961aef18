#include <numbers>

#include "brdf/block_loops.h"
#include "support/lane_math.h"
#include "support/vectorised.h"
#include "terms/oren_nayar.h"

namespace goniofit::block {

namespace {

template <class Real, RoughForm form>
struct Rough {
  using Arguments = RoughArguments<Real>;

  [[gnu::always_inline]] static void run(const Arguments& a) {
    using T = Lane<Real>;
    // The qualitative form reads three of the fields only; the loads of a stand-in for the others are dropped as
    // unused.
    const auto array = [&](Field f) -> const Real* { return a.g[f] != nullptr ? a.g[f] : a.t->shadowing.data(); };
    const Real* const cos_i = array(Field::cos_i);
    const Real* const cos_r = array(Field::cos_r);
    const Real* const rest_i = array(Field::one_minus_cos_i);
    const Real* const rest_r = array(Field::one_minus_cos_r);
    const Real* const s_z = array(Field::s_z);
    const Real* const s_h2 = array(Field::s_h2);
    const Real* const cos_h = array(Field::cos_h);
    const Real* const rest_h = array(Field::one_minus_cos_h);
    const Real* const dot_h = array(Field::dot_h);
    Real* const direct = a.t->direct.data();
    Real* const interreflection = a.t->interreflection.data();
    const T facet_slope = a.facet_slope;
    const std::size_t n = a.n;
#pragma GCC ivdep
    for (std::size_t k = 0; k < n; ++k) {
      BasicPair<T> p{};
      p.cos_i = cos_i[k];
      p.cos_r = cos_r[k];
      p.dot_h = dot_h[k];
      if constexpr (form == RoughForm::qualitative) {
        direct[k] = oren_nayar::qualitative(facet_slope, p).v;
        interreflection[k] = Real(0);
      } else {
        p.one_minus_cos_i = rest_i[k];
        p.one_minus_cos_r = rest_r[k];
        p.s_z = s_z[k];
        p.s_h2 = s_h2[k];
        p.cos_h = cos_h[k];
        p.one_minus_cos_h = rest_h[k];
        const oren_nayar::Functional<T> f = oren_nayar::functional(facet_slope, p);
        direct[k] = lane::at_least(Real(0), f.direct.v);
        interreflection[k] = f.interreflection.v;
      }
    }
  }
};

template <class Real, class Out>
struct AddRough {
  using Arguments = AddRoughArguments<Real, Out>;

  [[gnu::always_inline]] static void run(const Arguments& a) {
    const Real* const cos_i = a.g[Field::cos_i];
    const Real* const cos_r = a.g[Field::cos_r];
    const Real* const direct = a.t->direct.data();
    const Real* const interreflection = a.t->interreflection.data();
    const Real scale = a.rho * Real(1.0 / std::numbers::pi);
    const Real rho = a.rho;
    const Out most = static_cast<Out>(a.most);
    Out* const out = a.out;
    const std::size_t n = a.n;
#pragma GCC ivdep
    for (std::size_t k = 0; k < n; ++k) {
      const Out sum = out[k] + static_cast<Out>(scale * (direct[k] + rho * interreflection[k]));
      const bool lit = (cos_i[k] > Real(0)) & (cos_r[k] > Real(0));
      out[k] = lit ? (sum < most ? sum : most) : Out(0);
    }
  }
};

}  // namespace

Fields rough_fields(RoughForm form) {
  using enum Field;
  if (form == RoughForm::qualitative) return {cos_i, cos_r, dot_h};
  return {cos_i, cos_r, one_minus_cos_i, one_minus_cos_r, s_z, s_h2, cos_h, one_minus_cos_h, dot_h};
}

template <class Real>
Loop<RoughArguments<Real>> rough(RoughForm form, InstructionSet set) {
  switch (form) {
    case RoughForm::functional:
      return Vectorised<Rough<Real, RoughForm::functional>>::of(set);
    case RoughForm::qualitative:
      return Vectorised<Rough<Real, RoughForm::qualitative>>::of(set);
    case RoughForm::integral:
      break;
  }
  return nullptr;
}

template <class Real, class Out>
Loop<AddRoughArguments<Real, Out>> add_rough(InstructionSet set) {
  return Vectorised<AddRough<Real, Out>>::of(set);
}

template Loop<AddRoughArguments<double, double>> add_rough(InstructionSet);
template Loop<AddRoughArguments<float, float>> add_rough(InstructionSet);
template Loop<AddRoughArguments<float, double>> add_rough(InstructionSet);
template Loop<RoughArguments<double>> rough(RoughForm, InstructionSet);
template Loop<RoughArguments<float>> rough(RoughForm, InstructionSet);

}  // namespace goniofit::block
