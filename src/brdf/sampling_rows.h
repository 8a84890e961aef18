#pragma once
// What a Sampler reads at each incidence, measured from the material. Private to it.

#include <array>
#include <vector>

#include "evaluator.h"
#include "sampling_lobes.h"

namespace goniofit {

/// The lobes of a surface before their widths are measured: those of the published formulas without effective
/// roughness.
struct NominalLobes {
  ConeLobe cone{};
  FacetSlopes slopes = FacetSlopes::gaussian;
  double slope_x = 1.0, slope_y = 1.0;  ///< sigma/tau along x and y

  /// The kind of slopes is measured: that whose best widths leave the smaller variance.
  [[nodiscard]] static NominalLobes of(const Evaluator& evaluator);
  [[nodiscard]] FacetLobe facets(double width) const noexcept;
  [[nodiscard]] ForwardLobe forward(const Direction& l, double width) const noexcept;
};

using EffectShares = std::array<double, all_effects.size()>;  ///< by Effect; their sum is 1

/// At one incidence: the shares of the effects' albedos, and by which factor the two lobes that have a width want it.
struct SamplingRow {
  EffectShares share{};
  double log_facet_width = 0.0;
  double log_forward_width = 0.0;
};

/// Rows at equal steps of sqrt(cos theta_i), closer towards grazing, where lobes and albedos change.
class SamplingRows {
 public:
  SamplingRows(const Evaluator& evaluator, const NominalLobes& nominal);
  /// Interpolated linearly; the nearest row's beyond the ends.
  [[nodiscard]] SamplingRow at(double cos_i) const noexcept;

 private:
  std::vector<SamplingRow> rows_;
};

}  // namespace goniofit
