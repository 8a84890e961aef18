#pragma once
// Every combination of the surface's tiers and forms, and the rows at which each is tried in four arithmetics.

#include <string>
#include <vector>

#include "brdf/surface_shape.h"
#include "support/truth_table.h"
#include "table_inputs.h"

namespace goniofit::stability {

[[nodiscard]] inline std::vector<ShapeSettings> combinations() {
  std::vector<ShapeSettings> all;
  for (const auto shadowing :
       {ShadowingTier::li_torrance, ShadowingTier::smith, ShadowingTier::schlick, ShadowingTier::none}) {
    for (const auto roughness :
         {EffectiveRoughnessTier::li_torrance, EffectiveRoughnessTier::he, EffectiveRoughnessTier::none}) {
      for (const auto distribution : {DistributionTier::rough_limit, DistributionTier::he_torrance,
                                      DistributionTier::he_torrance_series, DistributionTier::student_t}) {
        for (const auto fs : {FsForm::printed, FsForm::reciprocal}) {
          all.push_back({shadowing, roughness, distribution, {.fs = fs}, false});
          all.push_back({shadowing, roughness, distribution, {.fs = fs}, true});
          all.push_back({shadowing, roughness, distribution, {.fs = fs, .anisotropy = AnisotropyForm::printed}, true});
        }
      }
    }
  }
  return all;
}

[[nodiscard]] inline std::string name_of(const ShapeSettings& s) {
  const auto text = [](auto tier) { return std::string(goniofit::name_of(tier)); };
  return text(s.shadowing) + ", " + text(s.effective_roughness) + ", " + text(s.distribution) + ", fs " +
         text(s.forms.fs) + (s.anisotropic ? ", anisotropic " + text(s.forms.anisotropy) : "");
}

/// Every stride-th row of both tables, without those whose sum for W takes seconds at 50 digits.
[[nodiscard]] inline std::vector<truth::Inputs> spread_rows(std::size_t ordinary_stride, std::size_t hard_stride) {
  std::vector<truth::Inputs> rows;
  const auto add = [&](const test::TruthTable& table, std::size_t stride) {
    for (std::size_t row = stride / 2; row < table.size(); row += stride) {
      const truth::Inputs in = truth::inputs_of(table, row);
      if (in.sigma_um < 5.0 * in.wavelength_um) rows.push_back(in);
    }
  };
  add(test::TruthTable("ordinary"), ordinary_stride);
  add(test::TruthTable("hard"), hard_stride);
  return rows;
}

/// For messages.
[[nodiscard]] inline std::string describe(const truth::Inputs& in) {
  std::string text = in.corner;
  for (const truth::InputColumn& column : truth::input_columns()) {
    text += " " + std::string(column.name) + "=" + truth::shortest(in.*column.value);
  }
  return text;
}

}  // namespace goniofit::stability
