#pragma once
// Search and polish: the global minimum of a problem.

#include <cstddef>

#include "polish.h"
#include "problem.h"

namespace goniofit {

struct Solved {
  Polished best;
  std::size_t evaluations = 0;  ///< points of the search
  std::size_t starts = 0, iterations = 0;
};

[[nodiscard]] Solved solve(const Problem& problem, double tolerance = result_accuracy);
/// By a model of that problem.
[[nodiscard]] Solved solve(const Problem& problem, Model& model, double tolerance = result_accuracy);

/// The same under the kernel that the settings ask for, at their scale, or at the one that suits the residuals of the
/// fit without it (1.4826 times their median size for a standard deviation).
[[nodiscard]] Solved solve(Problem& problem, Model& model, const FitSettings& settings);

}  // namespace goniofit
