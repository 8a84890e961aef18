#include "brdf/shape_kernels.h"

#include <algorithm>

#include "brdf/batch_source.h"
#include "brdf/block_loops.h"

namespace goniofit {

void shape_columns(const PairBatch& pairs, const ShapeSettings& settings, double log_slope, double* dd, double* fs) {
  const InstructionSet set = best_instruction_set();
  const bool grows = settings.effective_roughness != EffectiveRoughnessTier::none;
  const bool sees = dd != nullptr || (fs != nullptr && grows);
  const double slope = std::exp(log_slope);
  const auto visibility =
      block::visibility<double>(dd != nullptr, settings.shadowing, settings.effective_roughness, set);
  const auto directional_diffuse = block::directional_diffuse<double>(settings.distribution, grows, set);
  const auto forward_scattering = block::forward_scattering<double>(settings.forms.fs, grows, set);
  block::Fields fields = block::fields_of(dd != nullptr, settings.shadowing, settings.effective_roughness);
  using enum block::Field;
  fields |= {tan2_b};
  if (fs != nullptr) fields |= {one_minus_cos_i, one_minus_cos_r, tan2_f, tan2_f_swapped, forward};
  const batch::PairSource<double, double> source(pairs, fields, set);
  batch::FieldArrays<double> room;
  block::Terms<double> terms;
  block::Geometry<double> geometry;
  for (std::size_t first = 0; first < pairs.size(); first += block::size) {
    const std::size_t n = std::min(block::size, pairs.size() - first);
    const std::size_t whole = batch::whole_vectors(n);
    source.prepare(first, n, room, geometry);
    if (sees) visibility({geometry, &terms, whole, slope, 1.0 / slope, log_slope, 2.0});
    const block::LobeArguments<double> lobe{geometry, &terms, whole, log_slope, 1.0 / (slope * slope), 0.0};
    if (dd != nullptr) {
      directional_diffuse(lobe);
      std::copy_n(terms.dd.begin(), n, dd + first);
    }
    if (fs != nullptr) {
      forward_scattering(lobe);
      std::copy_n(terms.fs.begin(), n, fs + first);
    }
  }
}

}  // namespace goniofit
