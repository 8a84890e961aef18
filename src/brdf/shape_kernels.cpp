#include "brdf/shape_kernels.h"

#include <algorithm>

#include "brdf/batch_source.h"
#include "brdf/block_loops.h"

namespace goniofit {

namespace {

struct Block {
  block::Geometry<double> geometry;
  block::Terms<double> terms;
  std::size_t first, n, whole;
};

/// Calls f(block) for one block after the other, its geometry prepared.
template <class F>
void for_each_block(const PairBatch& pairs, block::Fields fields, InstructionSet set, const F& f) {
  const batch::PairSource<double, double> source(pairs, fields, set);
  batch::FieldArrays<double> room;
  Block b;
  for (b.first = 0; b.first < pairs.size(); b.first += block::size) {
    b.n = std::min(block::size, pairs.size() - b.first);
    b.whole = batch::whole_vectors(b.n);
    source.prepare(b.first, b.n, room, b.geometry);
    f(b);
  }
}

block::Fields fields_of(const ShapeSettings& settings, bool dd, bool fs) {
  using enum block::Field;
  block::Fields fields = block::fields_of(dd, settings.shadowing, settings.effective_roughness);
  fields |= {tan2_b};
  if (fs) fields |= {one_minus_cos_i, one_minus_cos_r, tan2_f, tan2_f_swapped, forward};
  return fields;
}

void store(const block::Array<double>& from, const Block& b, double* column) {
  std::copy_n(from.begin(), b.n, column + b.first);
}

}  // namespace

void shape_columns(const PairBatch& pairs, const ShapeSettings& settings, double log_slope, double* dd, double* fs) {
  const InstructionSet set = best_instruction_set();
  const bool grows = settings.effective_roughness != EffectiveRoughnessTier::none;
  const bool sees = dd != nullptr || (fs != nullptr && grows);
  const double slope = std::exp(log_slope);
  const auto visibility =
      block::visibility<double>(dd != nullptr, settings.shadowing, settings.effective_roughness, set);
  const auto directional_diffuse = block::directional_diffuse<double>(settings.distribution, grows, set);
  const auto forward_scattering = block::forward_scattering<double>(settings.forms.fs, grows, set);
  for_each_block(pairs, fields_of(settings, dd != nullptr, fs != nullptr), set, [&](Block& b) {
    if (sees) visibility({b.geometry, &b.terms, b.whole, slope, 1.0 / slope, log_slope, 2.0});
    const block::LobeArguments<double> lobe{b.geometry, &b.terms, b.whole, log_slope, 1.0 / (slope * slope), 0.0};
    if (dd != nullptr) {
      directional_diffuse(lobe);
      store(b.terms.dd, b, dd);
    }
    if (fs != nullptr) {
      forward_scattering(lobe);
      store(b.terms.fs, b, fs);
    }
  });
}

void shape_columns(const PairBatch& pairs, const ShapeSettings& settings, double log_slope,
                   const ColumnWithDerivative& dd, const ColumnWithDerivative& fs) {
  const InstructionSet set = best_instruction_set();
  const bool has_dd = dd.values != nullptr;
  const bool has_fs = fs.values != nullptr;
  const bool grows = settings.effective_roughness != EffectiveRoughnessTier::none;
  const double slope = std::exp(log_slope);
  const auto visibility = block::visibility_rates(has_dd, settings.shadowing, settings.effective_roughness, set);
  const auto directional_diffuse = block::directional_diffuse<double>(settings.distribution, grows, set);
  const auto directional_diffuse_rate = block::directional_diffuse_rate(grows, set);
  const auto forward_scattering = block::forward_scattering<double>(settings.forms.fs, grows, set);
  const auto forward_scattering_rate = block::forward_scattering_rate(settings.forms.fs, grows, set);
  block::Rates rates;
  alignas(64) block::Array<double> rate;
  for_each_block(pairs, fields_of(settings, has_dd, has_fs), set, [&](Block& b) {
    visibility({{b.geometry, &b.terms, b.whole, slope, 1.0 / slope, log_slope, 2.0}, &rates});
    const block::LobeArguments<double> lobe{b.geometry, &b.terms, b.whole, log_slope, 1.0 / (slope * slope), 0.0};
    if (has_dd) {
      directional_diffuse(lobe);
      store(b.terms.dd, b, dd.values);
      directional_diffuse_rate({lobe, &rates, rate.data()});
      store(rate, b, dd.derivatives);
    }
    if (has_fs) {
      forward_scattering(lobe);
      store(b.terms.fs, b, fs.values);
      forward_scattering_rate({lobe, &rates, rate.data()});
      store(rate, b, fs.derivatives);
    }
  });
}

}  // namespace goniofit
