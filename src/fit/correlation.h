#pragma once
// How the estimates of a fit's free parameters hang together.

#include "fit.h"
#include "problem.h"
#include "uncertainty.h"

namespace goniofit {

/// From the covariance that is stated; parameters without an uncertainty are left out.
[[nodiscard]] Correlation correlation_of(const Problem& problem, const Uncertainties& u);

/// "R.k_dd and R.k_uds", with their correlation.
struct CorrelatedPair {
  std::size_t first = 0, second = 0;  ///< of Correlation::names
  double correlation = 0.0;
};
/// Pairs beyond `least` in size, the strongest first.
[[nodiscard]] std::vector<CorrelatedPair> strong_pairs(const Correlation& correlation, double least);

}  // namespace goniofit
