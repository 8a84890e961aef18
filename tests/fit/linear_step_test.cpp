// One step to the minimum within bounds.

#include "fit/linear_step.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fit/bounded_least_squares.h"
#include "fit/cross_validation.h"
#include "fit/solve.h"
#include "support/materials.h"
#include "synthetic/random.h"
#include "synthetic/simulate.h"

namespace goniofit {
namespace {

TEST(BoundedNewtonStep, AgreesWithTheSolverOfCoefficients) {
  RandomStream random(7);
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::Index n = 1 + trial % 6;
    Eigen::MatrixXd a(9, n);
    for (double& x : a.reshaped()) x = random.gaussian();
    const Eigen::MatrixXd gram = a.transpose() * a;
    Eigen::VectorXd rhs(n);
    Eigen::VectorXd lower(n);
    Eigen::VectorXd upper(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      rhs[i] = 5.0 * random.gaussian();
      lower[i] = random.uniform() < 0.3 ? 0.0 : -random.uniform();
      upper[i] = random.uniform() < 0.2 ? std::numeric_limits<double>::infinity() : random.uniform();
    }
    const Eigen::VectorXd x = bounded_newton_step(gram, -rhs, lower, upper);
    const BoundedSolution known = solve_bounded(gram, rhs, lower, upper);
    for (Eigen::Index i = 0; i < n; ++i) EXPECT_NEAR(x[i], known.x[i], 1e-7) << "trial " << trial;
  }
}

TEST(BoundedNewtonStep, LeavesAColumnOfZerosWhereItIs) {
  const Eigen::MatrixXd gram = Eigen::Vector2d(2.0, 0.0).asDiagonal();
  const Eigen::VectorXd x =
      bounded_newton_step(gram, Eigen::Vector2d(-1.0, 0.0), Eigen::Vector2d(-9.0, -9.0), Eigen::Vector2d(9.0, 9.0));
  EXPECT_NEAR(x[0], 0.5, 1e-9);
  EXPECT_EQ(x[1], 0.0);
}

// What the step predicts of left-out readings is what the fit to the others does.
TEST(LeftOutScores, AreThoseOfThePolishedFits) {
  Material truth = test::laser_paper_73();
  truth.channels.resize(1);
  const Scan scan = simulate(truth, Sampling::incidence_plane, {0.02, 0.0}, 3);
  FitSettings settings;
  settings.components = truth.components;
  Problem problem(scan, settings);
  std::vector<Eigen::VectorXd> all{(0.02 * problem.channels[0].target.cwiseAbs().array() + 1e-9).inverse().matrix()};
  problem.emphasise(all);
  const FitPoint point = polish(problem, solve(problem).best.point).point;
  const AngleGroups groups = angle_groups(problem);
  const Eigen::VectorXd scores = left_out_scores(problem, point, groups);
  for (std::size_t g = 0; g < groups.count(); ++g) {
    std::vector<Eigen::VectorXd> others = all;
    for (std::size_t i = 0; i < groups.of.size(); ++i) {
      if (groups.of[i] == g) others[0][static_cast<Eigen::Index>(i)] = 0.0;
    }
    problem.emphasise(others);
    const FitPoint left = polish(problem, point).point;
    problem.emphasise(all);
    const auto own = static_cast<Eigen::Index>(g);
    const double exact = group_scores(problem, left, groups)[own];
    EXPECT_NEAR(scores[own], exact, 0.02 * groups.readings[g]) << g;
    EXPECT_GT(exact, group_scores(problem, point, groups)[own] - 1e-3) << "left out, a group is predicted no better";
  }
}

}  // namespace
}  // namespace goniofit
