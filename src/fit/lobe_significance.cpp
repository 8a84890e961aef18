#include "fit/lobe_significance.h"

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <limits>

#include "brdf/evaluator.h"
#include "brdf/surface_shape.h"

namespace goniofit {

namespace {

std::vector<std::size_t> lobes_of(const Problem& problem) {
  std::vector<std::size_t> out;
  for (std::size_t j = 0; j < problem.basis->coefficients().size(); ++j) {
    if (!problem.basis->coefficients()[j].constant() && is_lobe(*problem.basis, j)) out.push_back(j);
  }
  return out;
}

// A lobe that the settings fix, or bound away from 0, is theirs.
bool may_vanish(const Problem& problem, const std::vector<std::size_t>& lobes) {
  return std::all_of(problem.channels.begin(), problem.channels.end(), [&](const ProblemChannel& c) {
    return std::all_of(lobes.begin(), lobes.end(), [&](std::size_t j) {
      const auto at = static_cast<Eigen::Index>(j);
      return c.lower[at] <= 0.0 && c.upper[at] >= 0.0;
    });
  });
}

// Of grooves alone a free shape parameter does not make a lobe's.
bool lobes_have_free_shape(const Problem& problem) {
  if (problem.model != surface_model) return problem.shape.free > 0;
  const auto slope = problem.shape_index("slope");
  return slope && problem.shape.map.row(static_cast<Eigen::Index>(*slope)).squaredNorm() > 0.0;
}

// Probability that chi-square of `degrees` exceeds `chi2`.
double beyond(double chi2, double degrees) { return boost::math::gamma_q(0.5 * degrees, 0.5 * std::max(0.0, chi2)); }

// What leaving `lobes` out of one channel costs, by LinearSums' triangle of it. The residuals are linear in the
// coefficients (but for rho, whose square the linearisation leaves out).
double cost_of_dropping(const ProblemChannel& channel, const SmallVector& k, const Eigen::MatrixXd& triangle,
                        Eigen::Index shape, const std::vector<std::size_t>& lobes) {
  const Eigen::MatrixXd jacobian = triangle.middleCols(shape, k.size());
  const Eigen::VectorXd residual = triangle.rightCols(1);
  const SmallMatrix gram = jacobian.transpose() * jacobian;
  const SmallVector rhs = jacobian.transpose() * (jacobian * k - residual);
  SmallVector lower = channel.lower;
  SmallVector upper = channel.upper;
  const double with = solve_bounded(gram, rhs, lower, upper).value;
  for (const std::size_t j : lobes) lower[static_cast<Eigen::Index>(j)] = upper[static_cast<Eigen::Index>(j)] = 0.0;
  return std::max(0.0, solve_bounded(gram, rhs, lower, upper).value - with);
}

// What a robust estimate makes of the residuals as noise is much too much where bright readings rule a loss that leaves
// the dark ones to themselves. Noise of thousands of readings gives no lobe half of the loss.
bool halves_the_loss(const Problem& problem, double loss, double cost) {
  return cost > loss && cost > 1e-12 * problem.total;
}

}  // namespace

bool is_lobe(const Basis& basis, std::size_t coefficient) {
  if (basis.coefficients()[coefficient].name == name_of(Coefficient::rho)) return false;
  const std::vector<BasisColumn>& columns = basis.columns();
  return std::all_of(columns.begin(), columns.end(),
                     [&](const BasisColumn& c) { return c.coefficient != coefficient || c.reads_shape; });
}

LobeTest test_lobes(const Problem& problem, const FitPoint& point, const LinearSums& sums) {
  const std::vector<std::size_t> lobes = lobes_of(problem);
  if (lobes.empty() || !may_vanish(problem, lobes) || !lobes_have_free_shape(problem)) return {};
  LobeTest test;
  double most = 0.0;
  double of_loss = 0.0;
  for (std::size_t c = 0; c < problem.channels.size(); ++c) {
    const auto cost_by = [&](const Eigen::MatrixXd& triangle) {
      return cost_of_dropping(problem.channels[c], point.coefficients[c], triangle, problem.shape.free, lobes);
    };
    const double cost = cost_by(sums.whitened[c]);
    test.chi2 += cost;
    of_loss += cost_by(sums.triangles[c]);
    most = std::max(most, cost);
  }
  const auto channels = static_cast<double>(problem.channels.size());
  test.p = std::min({1.0, beyond(test.chi2, channels), channels * beyond(most, 1.0)});
  test.significant = test.p < lobe_level || halves_the_loss(problem, sums.loss, of_loss);
  return test;
}

double noise_makes_coherence(const LinearParts& parts, const NoiseModel& noise, double loss, const Material& material) {
  const Problem& problem = parts.problem();
  const bool coherent = material.model == surface_model && material.components.has(Effect::coh);
  if (!coherent || problem.known_sigma_um || problem.known_tau_um) return 0.0;
  const Evaluator evaluator(material);
  std::vector<double> least(problem.channels.size(), std::numeric_limits<double>::infinity());
  parts.for_each([&](const Problem& part, const Linearisation& l) {
    for (std::size_t c = 0; c < least.size(); ++c)
      least[c] = std::min(least[c], noise_of_rows(part, l, noise, c).sd.minCoeff());
  });
  double chi2 = 0.0;
  double of_loss = 0.0;
  parts.for_each([&](const Problem& part, const Linearisation& l) {
    for (std::size_t i = 0; i < part.readings(); ++i) {
      const Pair pair = part.pairs[i];
      if (!in_mirror_cone(pair, problem.solid_angle_sr)) continue;
      for (std::size_t c = 0; c < least.size(); ++c) {
        // The noise of the reading without it, which is what it is to be told from.
        const double coh = evaluator.value(pair, c, Effect::coh);
        const double rest = evaluator.value(pair, c) - coh;
        of_loss += std::pow(l.slopes[c][static_cast<Eigen::Index>(i)] * coh, 2);
        chi2 += std::pow(coh / std::max(noise.model[c].sd(rest), least[c]), 2);
      }
    }
  });
  if (halves_the_loss(problem, loss, of_loss)) return 0.0;
  return beyond(chi2, static_cast<double>(problem.channels.size()));
}

Polished without_lobes(Problem& problem, Model& model, const Polished& with) {
  HeldAtZero held(problem);
  FitPoint start = with.point;
  for (const std::size_t j : lobes_of(problem)) {
    for (std::size_t c = 0; c < problem.channels.size(); ++c) {
      held.hold(c, j);
      start.coefficients[c][static_cast<Eigen::Index>(j)] = 0.0;
    }
  }
  Polished without = polish(problem, model, start);
  without.iterations += with.iterations;
  return without;
}

}  // namespace goniofit
