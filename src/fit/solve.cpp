#include "fit/solve.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "fit/model.h"
#include "fit/search.h"
#include "support/error.h"

namespace goniofit {

namespace {

double suitable_scale(const Problem& problem, Model& model, const FitPoint& point, RobustKernel kernel) {
  const Linearisation l = linearise(problem, model, point);
  std::vector<double> sizes;
  for (std::size_t c = 0; c < l.residuals.size(); ++c) {
    const Eigen::VectorXd& used = problem.channels[c].used;
    for (Eigen::Index i = 0; i < l.residuals[c].size(); ++i) {
      if (used.size() == 0 || used[i] > 0.0) sizes.push_back(std::fabs(l.residuals[c][i]));
    }
  }
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  // What a fit of noise-free readings leaves is round-off, which no kernel shall sort.
  const double round_off = 1e-9 * std::sqrt(problem.total / static_cast<double>(sizes.size()));
  return RobustLoss::tuning(kernel) * std::max({1.4826022185056018 * *middle, round_off, 1e-300});
}

Solved polish_all(const Problem& problem, Model& model, const SearchOutcome& found, double tolerance) {
  Solved solved;
  solved.evaluations = found.evaluations;
  solved.starts = found.minima.size();
  for (const FitPoint& minimum : found.minima) {
    Polished polished = polish(problem, model, minimum, tolerance);
    solved.iterations += polished.iterations;
    if (&minimum == &found.minima.front() || polished.point.loss < solved.best.point.loss) {
      solved.best = std::move(polished);
    }
  }
  return solved;
}

// Whether all readings agree with those that were searched: the minimum lies where some dip was, to much less than dips
// are apart, and its loss is what was estimated there.
bool confirms(const Solved& solved, const SearchOutcome& found) {
  constexpr double apart = 0.1;
  constexpr double estimated = 0.3;
  const FitPoint& best = solved.best.point;
  if (!solved.best.converged) return false;
  return std::any_of(found.minima.begin(), found.minima.end(), [&](const FitPoint& dip) {
    double distance = 0.0;
    for (std::size_t i = 0; i < dip.z.size(); ++i) distance = std::max(distance, std::fabs(dip.z[i] - best.z[i]));
    return distance < apart && std::fabs(dip.loss - best.loss) <= estimated * best.loss;
  });
}

}  // namespace

Solved solve(const Problem& problem, double tolerance) {
  Model model(problem);
  return solve(problem, model, tolerance);
}

Solved solve(const Problem& problem, Model& model, double tolerance) {
  const SearchOutcome some = search(problem);
  Solved solved = polish_all(problem, model, some, tolerance);
  if (!some.thinned || confirms(solved, some)) return solved;
  const SearchOutcome all = search(problem, some.minima.size(), true);
  const std::size_t evaluations = solved.evaluations;
  const std::size_t iterations = solved.iterations;
  solved = polish_all(problem, model, all, tolerance);
  solved.evaluations += evaluations;
  solved.iterations += iterations;
  return solved;
}

Solved solve(Problem& problem, Model& model, const FitSettings& settings) {
  if (settings.robust_scale && !(*settings.robust_scale > 0.0))
    throw usage_error("robust scale: expected a number above 0");
  if (settings.robust == RobustKernel::none) return solve(problem, model);
  const Solved plain = solve(problem, model);
  const double scale = settings.robust_scale ? *settings.robust_scale
                                             : suitable_scale(problem, model, plain.best.point, settings.robust);
  problem.make_robust(RobustLoss(settings.robust, scale));
  Solved robust = solve(problem, model);
  // A scale far below the residuals of a coarse grid flattens all of it: there the plain minimum is the better start.
  Polished from_plain = polish(problem, model, plain.best.point);
  robust.iterations += from_plain.iterations;
  ++robust.starts;
  if (from_plain.point.loss < robust.best.point.loss) robust.best = std::move(from_plain);
  robust.evaluations += plain.evaluations;
  robust.starts += plain.starts;
  robust.iterations += plain.iterations;
  return robust;
}

}  // namespace goniofit
