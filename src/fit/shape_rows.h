#pragma once
// The report's rows of slope, sigma and tau, from the logarithms that a fit moves.

#include "fit.h"
#include "problem.h"
#include "uncertainty.h"

namespace goniofit {

struct ShapeRows {
  FittedParameter slope, sigma, tau;  ///< value null where the scan does not determine it
};

[[nodiscard]] ShapeRows shape_rows(const Problem& problem, const FitPoint& point, const Uncertainties& u);

/// A row of the report from a value, its bounds and what is known of its uncertainty.
[[nodiscard]] FittedParameter parameter_row(const std::string& name, const std::string& channel, double value,
                                            double lower, double upper, const ParameterUncertainty& u);

}  // namespace goniofit
