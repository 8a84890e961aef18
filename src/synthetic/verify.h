#pragma once
// verify: simulate, fit, compare.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "../fit/fit.h"
#include "../fit/settings.h"

namespace goniofit {

/// Told after each trial how many of how many are done; one call at a time, from any of the threads. Must not throw.
using Progress = std::function<void(std::size_t done, std::size_t total)>;

/// Recovery of one parameter over the trials.
struct Recovery {
  std::string parameter;  ///< "slope", "R.k_dd"
  double truth = 0.0;
  double mean = 0.0;
  double bias = 0.0;                            ///< mean - truth
  double spread = 0.0;                          ///< standard deviation over the trials
  double mean_u = 0.0;                          ///< mean stated standard uncertainty, over the trials that state one
  double coverage_68 = 0.0, coverage_95 = 0.0;  ///< of the trials that state one
  std::size_t stated = 0;                       ///< trials that state an uncertainty (not on a bound)
};

struct VerifyReport {
  std::string name;
  std::size_t trials = 0, failures = 0;  ///< failures: not converged, or a wrong minimum
  std::vector<Recovery> parameters;
  std::vector<std::string> missed;  ///< the bounds that were missed, in words; empty means it passed
};

/// Runs a recipe's [verify] table. `trials` 0 takes the recipe's number. Threads across trials; same result for any
/// number of them. Bounds: the slope's bias and the pooled coverage are held to theirs as they are; a single
/// parameter's coverage may be three of its standard errors outside; failures are always a miss. Throws Error
/// (bad_input) where the recipe has no [verify] table or its truth cannot be read.
[[nodiscard]] VerifyReport verify_recipe(const Recipe& recipe, std::size_t trials, std::uint64_t seed,
                                         const Progress& progress = {});

struct RandomRecoveryReport {
  std::size_t materials = 0;
  std::size_t wrong_minima = 0;       ///< loss above 1.0005 times the loss reached from the truth
  double worst_ratio = 1.0;           ///< largest loss / loss from the truth
  std::size_t polish_starts = 0;      ///< random starts of the polish alone, over all materials
  std::size_t polish_failures = 0;    ///< how many of those ended above 1.0005 times the best
  std::vector<std::string> failures;  ///< what the failing materials were
};

/// Random materials over the whole range (slope 0.01-0.6 log-uniform, k's over theirs, dielectric and metal), 2 %
/// noise, both samplings in turn. `starts_per_material` random starts of the polish alone are tried on the first 50
/// materials.
[[nodiscard]] RandomRecoveryReport verify_random(std::size_t materials, std::uint64_t seed,
                                                 std::size_t starts_per_material, const Progress& progress = {});

}  // namespace goniofit
