#pragma once
// The polish: all parameters jointly by Ceres, from one start. Alone it ends in the minimum nearest to its start, which
// for narrow lobes is seldom the right one; fit() starts it from what search() found.

#include <cstddef>
#include <map>
#include <string>

#include "../brdf/material.h"
#include "../scan/scan.h"
#include "model.h"
#include "problem.h"
#include "search.h"
#include "settings.h"

namespace goniofit {

struct Polished {
  FitPoint point;
  std::size_t iterations = 0;
  bool converged = false;  ///< Ceres converged and the result satisfies the conditions of a bounded minimum
  double optimality =
      0.0;  ///< square root of the part of the loss that one parameter's step could still gain; 0 at a minimum
};

/// Ceres stops where a step gains less than `tolerance` of the loss: a result takes the default, what is to predict
/// readings to much less than their noise takes prediction_accuracy.
inline constexpr double result_accuracy = 1e-14, prediction_accuracy = 1e-6;
[[nodiscard]] Polished polish(const Problem& problem, const FitPoint& start, double tolerance = result_accuracy);
/// By a model of that problem.
[[nodiscard]] Polished polish(const Problem& problem, Model& model, const FitPoint& start,
                              double tolerance = result_accuracy);

/// polish() from a material's parameters, for recovery studies: its loss is what the right minimum has to reach.
struct PolishOutcome {
  double loss = 0.0;
  bool converged = false;
  std::map<std::string, double> shape;  ///< shape parameters by name
};
[[nodiscard]] PolishOutcome polish_from(const Scan& scan, const FitSettings& settings, const Material& start,
                                        double tolerance = result_accuracy);

}  // namespace goniofit
