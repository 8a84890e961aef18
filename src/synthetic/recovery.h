#pragma once
// The statistics of recovery trials of one parameter: from what many fits found to bias, spread and coverage.

#include <cstddef>
#include <optional>
#include <string>

#include "../fit/fit.h"
#include "../scan/scan.h"
#include "exact_tests.h"

namespace goniofit {

/// What one trial found of one parameter.
struct Estimate {
  double value = 0.0;
  std::optional<double> u{};                             ///< stated standard uncertainty
  std::optional<Interval> interval_68{}, interval_95{};  ///< stated; else value ± u and ± 1.96 u stand for them
};
/// Requires that the scan determined it.
[[nodiscard]] Estimate estimate_of(const FittedParameter& parameter);

/// Recovery of one parameter over the trials.
struct Recovery {
  std::string parameter;  ///< "slope", "R.k_dd"
  double truth = 0.0;
  /// The truth lies on a bound of the fit: half of the estimates are cut off there, so that their mean is off it.
  bool truth_on_bound = false;
  std::size_t determined = 0;  ///< trials whose scan determined it; all below is of these
  double mean = 0.0;
  double bias = 0.0;                    ///< mean - truth
  double bias_error = 0.0;              ///< standard error of the bias; 0 of a single trial
  double spread = 0.0;                  ///< standard deviation over the trials
  std::size_t stated_u = 0;             ///< trials that state a standard uncertainty
  double mean_u = 0.0;                  ///< its mean over these
  Proportion coverage_68, coverage_95;  ///< truth inside, of the intervals stated
};

/// Takes estimates one after the other and keeps none (Welford's recurrence). The order counts in the last digit.
class RecoveryTally {
 public:
  RecoveryTally(std::string parameter, double truth, bool truth_on_bound = false);
  void add(const Estimate& estimate);
  [[nodiscard]] Recovery result() const;
  [[nodiscard]] const std::string& parameter() const noexcept { return recovery_.parameter; }

 private:
  Recovery recovery_;
  double squares_ = 0.0;  ///< about the mean
};

/// A fit whose loss is above this many times the loss that polishing from the truth reaches is in a wrong minimum.
inline constexpr double wrong_minimum_ratio = 1.0005;

/// `loss` over `reachable`, losses that are round-off beside the readings themselves counting as equal (without noise
/// both are, and their ratio would say nothing).
[[nodiscard]] double loss_ratio(const Scan& scan, double loss, double reachable);

}  // namespace goniofit
