#pragma once
// verify: simulate, fit, compare.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "../fit/fit.h"
#include "../fit/settings.h"
#include "judgement.h"

namespace goniofit {

/// Told after each trial how many of how many are done; one call at a time, from any of the threads. Must not throw.
using Progress = std::function<void(std::size_t done, std::size_t total)>;

/// How trials are run. The defaults are what a user wants; a test verifies a fitter of its own.
struct VerifyRun {
  std::size_t threads = 0;  ///< 0: as many as the machine has
  Progress progress{};
  std::function<FitResult(const Scan&, const FitSettings&)> fitter = fit;
};

/// Runs a recipe's [verify] table and judges it alone, at default_level; judge() several reports of one run together.
/// `trials` 0 takes the recipe's number. Same result for any number of threads; memory does not grow with the trials.
/// The noise is a function of seed, recipe name and trial, so that recipes of one run do not share it. Throws Error
/// (bad_input) where the recipe has no [verify] table or its truth cannot be read.
[[nodiscard]] VerifyReport verify_recipe(const Recipe& recipe, std::size_t trials, std::uint64_t seed,
                                         const VerifyRun& run = {});

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
