#pragma once
// What counts from a simulation prove: exact limits and p-values of proportions, and what is left of them when many are
// judged at once.

#include <cstddef>
#include <vector>

#include "../brdf/material.h"

namespace goniofit {

/// So many of so many.
struct Proportion {
  std::size_t count = 0, of = 0;
  /// 0 of none.
  [[nodiscard]] double fraction() const noexcept {
    return of == 0 ? 0.0 : static_cast<double>(count) / static_cast<double>(of);
  }
};

/// Clopper & Pearson 1934: limits that hold the true probability with at least this confidence, whatever it is; [0, 1]
/// of none.
[[nodiscard]] Interval exact_limits(Proportion observed, double confidence = 0.95);

/// p-value of "the true probability lies within `allowed`": twice the smaller binomial tail from the nearest end, 1
/// where the observed fraction lies inside. It is at most a exactly where the 1 - a limits above lie all outside.
[[nodiscard]] double p_within(Proportion observed, Interval allowed);

/// p-value of "the true probability is at most `rate`": the upper binomial tail. 0 where a rate of 0 saw a single case.
[[nodiscard]] double p_at_most(Proportion observed, double rate);

/// p-value of "the true mean is within ±limit of 0" from the mean of `n` normal values and its standard error: twice
/// Student's tail beyond the nearest end. Needs two values.
[[nodiscard]] double p_mean_within(double mean, double standard_error, std::size_t n, double limit);

/// Holm 1979: p-values adjusted for their number, in the order given. Rejecting those of at most a rejects a true
/// hypothesis among them with probability of at most a, however they depend on each other.
[[nodiscard]] std::vector<double> holm_adjusted(const std::vector<double>& p);

}  // namespace goniofit
