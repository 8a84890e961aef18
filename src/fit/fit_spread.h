#pragma once
// How far a fitted model's values are open themselves. Private to diagnose().

#include <vector>

#include "../brdf/material.h"
#include "../geometry/pair.h"

namespace goniofit {

/// Standard uncertainty of the material's values, as Evaluator::values lays them out, from those of its parameters,
/// each moved by its own; zeros for a material without. Correlations are left out, which overstates the uncertainty
/// where parameters trade for each other. One evaluation of all values for each name of a parameter.
[[nodiscard]] std::vector<double> value_uncertainties(const Material& material, const PairBatch& pairs,
                                                      const std::vector<double>& values);

}  // namespace goniofit
