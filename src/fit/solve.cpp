#include "fit/solve.h"

#include <utility>

#include "fit/search.h"

namespace goniofit {

Solved solve(const Problem& problem, double tolerance) {
  const SearchOutcome found = search(problem);
  Solved solved;
  solved.evaluations = found.evaluations;
  solved.starts = found.minima.size();
  for (const FitPoint& minimum : found.minima) {
    Polished polished = polish(problem, minimum, tolerance);
    solved.iterations += polished.iterations;
    if (&minimum == &found.minima.front() || polished.point.loss < solved.best.point.loss) {
      solved.best = std::move(polished);
    }
  }
  return solved;
}

}  // namespace goniofit
