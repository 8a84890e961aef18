#include "fit/fit.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>

#include "brdf/evaluator.h"
#include "fit/assemble.h"
#include "fit/polish.h"
#include "fit/problem.h"
#include "fit/search.h"

namespace goniofit {

EffectSet automatic_components(bool metal) noexcept {
  return metal ? EffectSet{Effect::dd, Effect::udf} : EffectSet{Effect::dd, Effect::uds, Effect::fs};
}

FitResult fit(const Scan& scan, const FitSettings& settings) {
  const auto start = std::chrono::steady_clock::now();
  const Problem problem(scan, settings);
  const SearchOutcome found = search(problem);
  Polished best;
  std::size_t iterations = 0;
  for (const FitPoint& minimum : found.minima) {
    Polished polished = polish(problem, minimum);
    iterations += polished.iterations;
    if (&minimum == &found.minima.front() || polished.point.loss < best.point.loss) best = std::move(polished);
  }
  FitResult result = assemble(problem, scan, best);
  result.search_evaluations = found.evaluations;
  result.polish_starts = found.minima.size();
  result.polish_iterations = iterations;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

void add_reflectance(FitResult& result, const Scan& scan, std::size_t most) {
  std::set<double> angles;
  for (const double theta : scan.theta_i_deg) {
    if (theta < 90.0) angles.insert(std::round(theta * 10.0) / 10.0);
  }
  const std::vector<double> all(angles.begin(), angles.end());
  const std::size_t count = std::min(most, all.size());
  const Evaluator evaluator(result.material);
  bool above_one = false;
  for (std::size_t i = 0; i < count; ++i) {
    const double theta = count > 1 ? all[i * (all.size() - 1) / (count - 1)] : all.front();
    HemisphericalReflectance row{theta, hemispherical_reflectance(evaluator, theta)};
    above_one = above_one || *std::max_element(row.by_channel.begin(), row.by_channel.end()) > 1.0;
    result.reflectance.push_back(std::move(row));
  }
  if (above_one) {
    result.warnings.emplace_back(
        "the fitted material reflects more than it receives at some incidence angles; check the scan's absolute scale, "
        "or bound the k's");
  }
}

}  // namespace goniofit
