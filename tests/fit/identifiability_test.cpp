// The whitened Jacobian's singular values, and what is read from them.

#include "fit/identifiability_analysis.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "fit/fit.h"
#include "fit/lobe_significance.h"
#include "fit/solve.h"
#include "support/materials.h"
#include "synthetic/simulate.h"

namespace goniofit {
namespace {

FitSettings of(EffectSet components) {
  FitSettings s;
  s.components = components;
  return s;
}

struct Fitted {
  Problem problem;
  FitPoint point;
  Linearisation l;
  ReadingNoise noise;

  Fitted(const Scan& scan, const FitSettings& settings)
      : problem(scan, settings),
        point(solve(problem).best.point),
        l(linearise(problem, point)),
        noise(reading_noise(problem, l)) {}
  [[nodiscard]] LinearSums sums() const { return linear_sums(LinearParts(problem, point, l), &noise); }
  [[nodiscard]] Identifiability identifiability() const { return identify(problem, point, sums()); }
};

TEST(Identifiability, SingularValuesAreThoseOfTheWhitenedJacobian) {
  const Material truth = test::ground_glass_41();
  const Fitted f(simulate(truth, Sampling::incidence_plane, {0.02, 0.0}, 1), of(truth.components));
  const Identifiability i = f.identifiability();
  ASSERT_EQ(i.singular_values.size(), 7U);
  // The dense matrix, row by row: a noise of 2 % of the value, slope by its logarithm, coefficients by their values.
  const auto n = static_cast<Eigen::Index>(f.problem.samples());
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(3 * n, 7);
  for (Eigen::Index c = 0; c < 3; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    for (Eigen::Index row = 0; row < n; ++row) {
      const double model = (f.l.residuals[channel][row] + f.problem.channels[channel].target[row]);
      const double sd = f.noise.model[channel].sd(model / f.problem.weight[row]) * f.problem.weight[row];
      dense(c * n + row, 0) = f.l.by_shape[channel](row, 0) / sd;
      for (Eigen::Index j = 0; j < 2; ++j) {
        dense(c * n + row, 1 + 2 * c + j) = f.l.by_coefficient[channel](row, j) * f.point.coefficients[channel][j] / sd;
      }
    }
  }
  const Eigen::VectorXd expected = Eigen::JacobiSVD<Eigen::MatrixXd>(dense).singularValues();
  for (Eigen::Index k = 0; k < 7; ++k) {
    EXPECT_NEAR(i.singular_values[static_cast<std::size_t>(k)] / expected[k], 1.0, 1e-9);
  }
  EXPECT_NEAR(i.condition / (expected[0] / expected[6]), 1.0, 1e-9);
  EXPECT_TRUE(i.open.empty());
  const Eigen::MatrixXd covariance = (dense.transpose() * dense).inverse();
  EXPECT_NEAR(i.least_u.at("R.k_dd") / (std::sqrt(covariance(1, 1)) * f.point.coefficients[0][0]), 1.0, 1e-6);
}

TEST(Identifiability, LessNoiseIsMoreInformation) {
  const Material truth = test::laser_paper_73();
  const auto at = [&](double noise) {
    return Fitted(simulate(truth, Sampling::hemisphere, {noise, 0.0}, 2), of(truth.components)).identifiability();
  };
  const Identifiability coarse = at(0.02);
  const Identifiability fine = at(0.002);
  for (std::size_t k = 0; k < fine.singular_values.size(); ++k) {
    EXPECT_NEAR(fine.singular_values[k] / coarse.singular_values[k], 10.0, 1.0);
  }
}

TEST(Identifiability, TheScansOwnUncertaintiesCount) {
  const Material truth = test::ground_glass_41();
  const Scan with = simulate(truth, Sampling::hemisphere, {0.02, 0.001}, 3, true);
  Scan without = with;
  for (ScanChannel& c : without.channels) c.u.clear();
  const Identifiability stated = Fitted(with, of(truth.components)).identifiability();
  const Identifiability estimated = Fitted(without, of(truth.components)).identifiability();
  for (std::size_t k = 0; k < stated.singular_values.size(); ++k) {
    EXPECT_NEAR(estimated.singular_values[k] / stated.singular_values[k], 1.0, 0.15);
  }
  // Uncertainties that the residuals exceed threefold are not taken at their word.
  Scan modest = with;
  for (ScanChannel& c : modest.channels) {
    for (double& u : c.u) u /= 3.0;
  }
  const Identifiability corrected = Fitted(modest, of(truth.components)).identifiability();
  EXPECT_NEAR(corrected.singular_values.back() / stated.singular_values.back(), 1.0, 0.15);
}

// Three channels alike have alike singular values, whose vectors mix as they like: what is said must not.
TEST(Identifiability, ChannelsAreToldApart) {
  Material truth = test::laser_paper_73();
  truth.components = {Effect::dd, Effect::udf, Effect::uds};
  for (MaterialChannel& c : truth.channels) {
    c.n = 1.5;
    c.k = {0.28, 0.2, 0.3};
  }
  Scan scan = simulate(truth, Sampling::hemisphere, {0.02, 0.0}, 1);
  for (ScanChannel& c : scan.channels) c.values = scan.channels[0].values;
  FitSettings s = of(truth.components);
  s.max_theta_deg = 30.0;
  const Identifiability i = Fitted(scan, s).identifiability();
  ASSERT_EQ(i.open.size(), 3U);
  for (const OpenDirection& open : i.open) {
    EXPECT_EQ(open.names, (std::vector<std::string>{"k_udf", "k_uds"}));
    EXPECT_FALSE(open.channel.empty());
    EXPECT_FALSE(open.null);
    EXPECT_GT(open.u, 1.0);
    ASSERT_TRUE(open.known);
    EXPECT_EQ(open.known->text, "k_udf + 0.92 k_uds");
  }
}

TEST(LobeSignificance, DroppingALobeCostsItsSquaredSignificance) {
  Material truth = test::ground_glass_41();
  truth.channels.resize(1);
  truth.channels[0].coefficient(Coefficient::k_dd) = 0.02;
  const Fitted f(simulate(truth, Sampling::hemisphere, {0.02, 0.0}, 1), of(truth.components));
  const LobeTest test = test_lobes(f.problem, f.point, f.sums());
  EXPECT_TRUE(test.significant);
  // Given the slope one coefficient is left, whose square over its variance it is.
  const Eigen::MatrixXd j = f.noise.whitener[0].asDiagonal() * f.l.by_coefficient[0];
  const Eigen::MatrixXd covariance = (j.transpose() * j).inverse();
  const Eigen::VectorXd step = covariance * (j.transpose() * f.noise.whitener[0].cwiseProduct(f.l.residuals[0]));
  const double k = f.point.coefficients[0][0] - step[0];  // solved by the weights that the test has
  EXPECT_NEAR(test.chi2 / (k * k / covariance(0, 0)), 1.0, 1e-6);
}

TEST(LobeSignificance, WhatTheSettingsDemandIsNotTested) {
  Material truth = test::ground_glass_41();
  truth.components = {Effect::udf};
  truth.surface = {};
  FitSettings s = of({Effect::dd, Effect::udf});
  s.parameters["k_dd"].value = 0.1;
  const Fitted f(simulate(truth, Sampling::incidence_plane, {0.02, 0.0}, 1), s);
  EXPECT_TRUE(test_lobes(f.problem, f.point, f.sums()).significant);
}

}  // namespace
}  // namespace goniofit
