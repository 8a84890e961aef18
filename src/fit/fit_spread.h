#pragma once
// How far a fitted model's values are open themselves.

#include <optional>
#include <vector>

#include "../brdf/material.h"
#include "diagnostics.h"
#include "model.h"
#include "problem.h"

namespace goniofit {

/// Standard uncertainty of the material's values, as Evaluator::values lays them out, from those of its parameters,
/// each moved by its own; zeros for a material without. Correlations are left out, which overstates the uncertainty
/// where parameters trade for each other. One evaluation of all values for each name of a parameter.
[[nodiscard]] std::vector<double> value_uncertainties(const Material& material, const PairBatch& pairs,
                                                      const std::vector<double>& values);

/// Values and their uncertainties at the problem's readings, of a material assembled from `point`: the same as by
/// evaluating it, from the columns that `model` has. None where the material says less than the point (a shape
/// parameter that the scan leaves open), or is cut where the model is not (rough's functional form).
[[nodiscard]] std::optional<FittedValues> fitted_values(const Problem& problem, Model& model, const FitPoint& point,
                                                        const Material& material);

}  // namespace goniofit
