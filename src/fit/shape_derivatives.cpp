// The vector declarations must come before <cmath> is used, hence this first.
#include "brdf/shape_loop.h"
//
#include <ceres/jet.h>

#include "fit/shape_derivatives.h"

namespace ceres {

// By component: a choice between two objects is a choice between their addresses, which GCC does not vectorise. Found
// by its argument, before math::select.
[[gnu::always_inline]] inline Jet<double, 1> select(bool condition, const Jet<double, 1>& yes,
                                                    const Jet<double, 1>& no) {
  const double a = condition ? yes.a : no.a;
  const double v = condition ? yes.v[0] : no.v[0];
  Jet<double, 1> chosen(a);
  chosen.v[0] = v;
  return chosen;
}

}  // namespace ceres

namespace goniofit {

namespace {

using Dual = ceres::Jet<double, 1>;  // of one component: GCC still vectorises the loop, at 1.15 times the value's cost
using shape_loop::Want;

struct DualSink {
  double* values;
  double* derivatives;
  [[gnu::always_inline]] void put(std::size_t i, const Dual& x) const {
    values[i] = x.a;
    derivatives[i] = x.v[0];
  }
};

template <ShadowingTier shadowing, EffectiveRoughnessTier roughness, FsForm form, Want want>
GONIOFIT_VECTOR_CLONES void columns(const PairBatch& pairs, double log_slope, double floor, const DualSink& dd,
                                    const DualSink& fs) {
  shape_loop::run<shadowing, roughness, form, want>(pairs, Dual(log_slope, 0), floor, dd, fs);
}

template <ShadowingTier shadowing, EffectiveRoughnessTier roughness>
void choose(const PairBatch& pairs, FsForm form, double log_slope, double floor, const DualSink& dd,
            const DualSink& fs) {
  using enum FsForm;
  if (fs.values == nullptr) return columns<shadowing, roughness, printed, Want::dd>(pairs, log_slope, floor, dd, fs);
  if (dd.values == nullptr) {
    if (form == printed) return columns<shadowing, roughness, printed, Want::fs>(pairs, log_slope, floor, dd, fs);
    return columns<shadowing, roughness, reciprocal, Want::fs>(pairs, log_slope, floor, dd, fs);
  }
  if (form == printed) return columns<shadowing, roughness, printed, Want::both>(pairs, log_slope, floor, dd, fs);
  return columns<shadowing, roughness, reciprocal, Want::both>(pairs, log_slope, floor, dd, fs);
}

}  // namespace

void shape_columns_with_derivatives(const PairBatch& pairs, const ShapeSettings& settings, double log_slope, double* dd,
                                    double* d_dd, double* fs, double* d_fs) {
  if (dd == nullptr && fs == nullptr) return;
  with_tiers(settings, [&]<ShadowingTier shadowing, EffectiveRoughnessTier roughness>() {
    choose<shadowing, roughness>(pairs, settings.forms.fs, log_slope, exponent_floor, {dd, d_dd}, {fs, d_fs});
  });
}

}  // namespace goniofit
