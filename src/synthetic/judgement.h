#pragma once
// What a recipe's trials showed, held to its bounds.
//
// A bound is a statement about the fitter: "its 95 % intervals hold the truth in 93 to 97 % of all scans". A run of
// trials sees a sample, so it is missed only where the sample refutes the statement: by its p-value (exact_tests.h),
// adjusted by Holm's method for all statements that the run tests. The exception is slope_bias, a limit on what the
// run itself measured.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "../fit/settings.h"
#include "exact_tests.h"
#include "recovery.h"

namespace goniofit {

enum class Bound : std::uint8_t { slope_bias, bias, coverage_68, coverage_95, failure_rate };
/// As in a recipe.
[[nodiscard]] std::string_view name_of(Bound bound) noexcept;

/// One bound on one parameter.
struct BoundCheck {
  Bound bound;
  std::string parameter;  ///< empty: of the recipe as a whole
  /// Part of the truth (slope_bias), mean standard uncertainties (bias), parts of 1.
  double measured = 0.0;
  Interval allowed;
  Proportion observed{};                    ///< of coverages and failures
  std::optional<double> p{}, adjusted_p{};  ///< none for slope_bias
  bool missed = false;
};

struct VerifyReport {
  std::string name;
  VerifySettings settings;
  std::uint64_t seed = 0;
  std::size_t trials = 0, failures = 0;   ///< failures: not converged, or a wrong minimum
  std::vector<Recovery> parameters;       ///< that at least one trial determined
  std::vector<std::string> undetermined;  ///< parameters with a truth that no trial determined
  std::vector<BoundCheck> checks;         ///< filled by judge(), with what follows
  std::vector<std::string> missed;        ///< the bounds that were missed, in words; empty means it passed

  [[nodiscard]] Proportion failure_rate() const noexcept { return {failures, trials}; }
  [[nodiscard]] bool is_missed(const std::string& parameter, Bound bound) const;
};

/// Probability with which a run of trials may blame a fitter that meets all its bounds.
inline constexpr double default_level = 0.05;

/// Fills checks and missed of all reports, which are one run: their checks share the level. A bias is not judged where
/// the truth lies on a bound, where there is one even of the best fitter.
void judge(std::span<VerifyReport> reports, double level = default_level);

}  // namespace goniofit
