#include "brdf/shape_loop.h"

namespace goniofit {

namespace {

using shape_loop::DoubleSink;
using shape_loop::Want;

template <ShadowingTier shadowing, EffectiveRoughnessTier roughness, FsForm form, Want want>
GONIOFIT_VECTOR_CLONES void columns(const PairBatch& pairs, double log_slope, double floor, double* dd, double* fs) {
  shape_loop::run<shadowing, roughness, form, want>(pairs, log_slope, floor, DoubleSink{dd}, DoubleSink{fs});
}

template <ShadowingTier shadowing, EffectiveRoughnessTier roughness>
void choose(const PairBatch& pairs, FsForm form, double log_slope, double floor, double* dd, double* fs) {
  using enum FsForm;
  if (fs == nullptr) return columns<shadowing, roughness, printed, Want::dd>(pairs, log_slope, floor, dd, fs);
  if (dd == nullptr) {
    if (form == printed) return columns<shadowing, roughness, printed, Want::fs>(pairs, log_slope, floor, dd, fs);
    return columns<shadowing, roughness, reciprocal, Want::fs>(pairs, log_slope, floor, dd, fs);
  }
  if (form == printed) return columns<shadowing, roughness, printed, Want::both>(pairs, log_slope, floor, dd, fs);
  return columns<shadowing, roughness, reciprocal, Want::both>(pairs, log_slope, floor, dd, fs);
}

}  // namespace

void shape_columns(const PairBatch& pairs, const ShapeSettings& settings, double log_slope, double* dd, double* fs) {
  if (dd == nullptr && fs == nullptr) return;
  with_tiers(settings, [&]<ShadowingTier shadowing, EffectiveRoughnessTier roughness>() {
    choose<shadowing, roughness>(pairs, settings.forms.fs, log_slope, exponent_floor, dd, fs);
  });
}

}  // namespace goniofit
