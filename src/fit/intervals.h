#pragma once
// What a parameter's truth lies in, from its estimate and what is known of its uncertainty.

#include <optional>

#include "uncertainty.h"

namespace goniofit {

struct ParameterIntervals {
  std::optional<Interval> at_68{}, at_95{};  ///< none where there is no uncertainty to state
  std::optional<double> coverage_factor{};   ///< of 95 %; none on a bound
};

/// On the scale of `value`, which is where the estimate is normally distributed: a coefficient itself, a shape
/// parameter's logarithm. Value ± k u, near a bound the unified interval of that reach; for a parameter on a bound
/// from where it would be if released, so that it is one-sided unless the scan contradicts the bound. Bounds may be
/// infinite.
[[nodiscard]] ParameterIntervals intervals_of(double value, double lower, double upper, const ParameterUncertainty& u);

}  // namespace goniofit
