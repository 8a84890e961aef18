#pragma once
// What residuals say by themselves: whether they are noise.

#include <cstddef>
#include <vector>

namespace goniofit {

/// Wald and Wolfowitz's runs test (1940) along lines of readings, about the known median zero of noise: residuals of
/// neighbours are of like sign as often as not, so the changes of sign of all lines together are binomial, whatever the
/// lengths of the lines, and lines of one sign only, which the test about a line's own median cannot use, count most.
/// Residuals of exactly zero have no sign and are left out.
struct RunsTest {
  std::size_t lines = 0, readings = 0, runs = 0;

  void add_line(const std::vector<double>& residuals);
  [[nodiscard]] std::size_t comparisons() const noexcept { return readings - lines; }
  [[nodiscard]] double expected_runs() const noexcept {
    return static_cast<double>(lines) + 0.5 * static_cast<double>(comparisons());
  }
  /// Probability that noise has as few runs as this, or fewer; 1 without a comparison. Exact.
  [[nodiscard]] double p() const;
  /// Enough neighbours for a verdict: twenty, with which p can reach 1e-6, and half of the readings, so that the lines
  /// speak for the scan.
  [[nodiscard]] bool testable() const noexcept { return comparisons() >= 20 && 2 * comparisons() >= readings; }
};

/// Chi-square of residuals over their stated uncertainties, by degrees of freedom.
struct ReducedChiSquare {
  double value = 0.0;
  std::size_t degrees_of_freedom = 0;
  double low = 0.0, high = 0.0;  ///< holds the value 95 times in 100 where model and uncertainties are right
};
[[nodiscard]] ReducedChiSquare reduced_chi_square(double chi_square, std::size_t degrees_of_freedom);

/// The middle of the values, of an even number the lower one; needs one. Reorders them.
[[nodiscard]] double median_of(std::vector<double>& values);

}  // namespace goniofit
