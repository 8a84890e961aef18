#pragma once
// The report's rows of the shape, from the logarithms that a fit moves.

#include <vector>

#include "fit.h"
#include "problem.h"
#include "uncertainty.h"

namespace goniofit {

/// A row each shape parameter of the model; of the surface family slope, sigma_um and tau_um are always among them, and
/// tau_y_um where it is anisotropic. The value is null where the scan does not determine it.
[[nodiscard]] std::vector<FittedParameter> shape_rows(const Problem& problem, const FitPoint& point,
                                                      const Uncertainties& u);

/// A row of the report from a value, its bounds and what is known of its uncertainty; the intervals are those of an
/// estimate that is normally distributed itself.
[[nodiscard]] FittedParameter parameter_row(const std::string& name, const std::string& channel, double value,
                                            double lower, double upper, const ParameterUncertainty& u);

/// Of one that is fixed, or that has no value.
void leave_without_uncertainty(FittedParameter& p);

}  // namespace goniofit
