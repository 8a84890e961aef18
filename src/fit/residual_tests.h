#pragma once
// What residuals say by themselves: whether they are noise, and of which size.

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

/// Standard deviation of the residuals as sqrt((relative f)² + additive²), from medians: a part below one half of gross
/// errors does not move it far.
struct ResidualNoise {
  double relative = 0.0;  ///< of the fitted value
  double additive = 0.0;  ///< 1/sr

  [[nodiscard]] double sd(double fitted) const noexcept;
};

/// From groups of readings of like fitted value, in each of which 1.4826 times the median of |residual| is the robust
/// standard deviation. Both vectors have one length; zeros where they are empty. O(n log n).
[[nodiscard]] ResidualNoise residual_noise(const std::vector<double>& fitted, const std::vector<double>& residuals);

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
