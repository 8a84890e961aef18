#include "fit/intervals.h"

#include <cmath>

#include "fit/unified_interval.h"

namespace goniofit {

ParameterIntervals intervals_of(double value, double lower, double upper, const ParameterUncertainty& p) {
  const bool on_bound = p.state == ParameterState::at_lower || p.state == ParameterState::at_upper;
  const bool stated = on_bound ? p.released.has_value() : p.state == ParameterState::free;
  const double u = on_bound && p.released ? p.released->u : p.u;
  if (!stated || !(u > 0.0) || !std::isfinite(u) || !std::isfinite(value)) return {};
  const CoverageFactors& k = on_bound ? p.released->k : p.k;
  if (!std::isfinite(k.at_68) || !std::isfinite(k.at_95)) return {};
  const double estimate = on_bound ? value + p.released->step : value;
  // Student's t is taken as a normal distribution of the same reach.
  const CoverageFactors normal;
  ParameterIntervals out;
  out.at_68 = unified_interval(estimate, u * k.at_68 / normal.at_68, lower, upper, probability_68);
  out.at_95 = unified_interval(estimate, u * k.at_95 / normal.at_95, lower, upper, probability_95);
  if (!on_bound) out.coverage_factor = k.at_95;
  return out;
}

}  // namespace goniofit
