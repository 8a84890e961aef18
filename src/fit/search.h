#pragma once
// The global search: at each point of a grid of the one or two shape parameters the coefficients are solved within
// their bounds, which leaves a profile of the loss over the shape alone. Its local minima are refined and handed to the
// polish.

#include <cstddef>
#include <vector>

#include "bounded_least_squares.h"
#include "problem.h"

namespace goniofit {

/// A point of the whole parameter space.
struct FitPoint {
  std::vector<double> z;                  ///< free shape parameters (logarithms)
  std::vector<SmallVector> coefficients;  ///< one a channel
  std::vector<double> optics;             ///< the free optical parameter, one a channel; empty where fixed
  double loss = 0.0;
};

struct SearchOutcome {
  std::vector<FitPoint> minima;  ///< best first
  std::size_t evaluations = 0;   ///< points of the profile
  bool thinned = false;          ///< of a large scan: the losses are estimates
};

/// Deterministic. Of a scan of more than most_searched readings (thinning.h) it looks at some of them unless told to
/// look at all. `most` limits the minima returned (thrice as many of models with more than four shape
/// parameters); only such as come within 5 % of the best loss (plus round-off)
/// are, or within twice of it where the grid of three and more shape parameters is coarse.
[[nodiscard]] SearchOutcome search(const Problem& problem, std::size_t most = 3, bool all_readings = false);

}  // namespace goniofit
