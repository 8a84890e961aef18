#pragma once
// The statistics of recovery trials: from what many fits found to bias, spread, coverage and the bounds they miss.

#include <optional>
#include <string>
#include <vector>

#include "../fit/settings.h"
#include "../scan/scan.h"
#include "verify.h"

namespace goniofit {

/// What one trial found of one parameter.
struct Estimate {
  double value = 0.0;
  std::optional<double> u;  ///< stated standard uncertainty
};

/// All estimates of one parameter.
struct ParameterTrials {
  std::string parameter;  ///< "slope", "R.k_dd"
  double truth = 0.0;
  /// The truth lies on a bound of the fit: half of the estimates are cut off there, so neither their mean nor the
  /// coverage of their intervals has the value that theory gives an unbounded parameter.
  bool truth_on_bound = false;
  std::vector<Estimate> estimates;
};

/// Requires at least one estimate.
[[nodiscard]] Recovery recovery_of(const ParameterTrials& trials);

/// The bounds that were missed, in words. The slope's bias is held to its bound as it is, and so is the coverage pooled
/// over all parameters; a single parameter's coverage is let off three standard errors of a proportion from that many
/// intervals (without that, 20 parameters of a perfect fitter would miss their bounds every few runs by chance).
/// Parameters whose truth lies on a bound are left out of both coverages.
[[nodiscard]] std::vector<std::string> missed_bounds(const std::vector<ParameterTrials>& parameters,
                                                     const VerifySettings& bounds);

/// A fit whose loss is above this many times the loss that polishing from the truth reaches is in a wrong minimum.
inline constexpr double wrong_minimum_ratio = 1.0005;

/// `loss` over `reachable`, losses that are round-off beside the readings themselves counting as equal (without noise
/// both are, and their ratio would say nothing).
[[nodiscard]] double loss_ratio(const Scan& scan, double loss, double reachable);

}  // namespace goniofit
