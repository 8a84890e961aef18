#include "fit/uncertainty.h"
#include "fit/fit.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "fit/polish.h"
#include "fit/search.h"
#include "support/materials.h"
#include "synthetic/simulate.h"

namespace goniofit {
namespace {

FitSettings settings_for(const Material& truth) {
  FitSettings s;
  s.components = truth.components;
  return s;
}

// The formula written out over the whole dense Jacobian.
TEST(Uncertainty, IsTheSandwichOfTheWholeJacobian) {
  const Material truth = test::laser_paper_73();
  const Scan scan = simulate(truth, Sampling::incidence_plane, {0.03, 0.0}, 4);
  FitSettings settings = settings_for(truth);
  settings.uncertainty = UncertaintySource::hc3;
  const Problem problem(scan, settings);
  const Polished best = polish(problem, search(problem).minima.front());
  const Linearisation l = linearise(problem, best.point);
  const Uncertainties u = uncertainties(problem, best.point, l);
  const auto n = static_cast<Eigen::Index>(problem.samples());
  Eigen::MatrixXd j = Eigen::MatrixXd::Zero(3 * n, 1 + 9);
  Eigen::VectorXd r(3 * n);
  for (Eigen::Index c = 0; c < 3; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    j.block(c * n, 0, n, 1) = l.by_shape[channel];
    j.block(c * n, 1 + 3 * c, n, 3) = l.by_coefficient[channel];
    r.segment(c * n, n) = l.residuals[channel];
  }
  const Eigen::MatrixXd bread = (j.transpose() * j).inverse();
  const Eigen::VectorXd h = (j * bread).cwiseProduct(j).rowwise().sum();
  const Eigen::VectorXd e = r.array() / (1.0 - h.array());
  const double s2 = r.squaredNorm() / static_cast<double>(3 * n - 10);
  EXPECT_NEAR(u.residual_variance / s2, 1.0, 1e-12);
  const Eigen::MatrixXd v = bread * j.transpose() * e.array().square().matrix().asDiagonal() * j * bread;
  EXPECT_NEAR(u.shape[0].u / std::sqrt(v(0, 0)), 1.0, 1e-9);
  EXPECT_NEAR(u.shape[0].u_unscaled / std::sqrt(bread(0, 0)), 1.0, 1e-9);
  EXPECT_NEAR(u.shape[0].u_classical / std::sqrt(s2 * bread(0, 0)), 1.0, 1e-9);
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto at = static_cast<Eigen::Index>(1 + 3 * c + k);
      ASSERT_EQ(u.coefficients[c][k].state, ParameterState::free);
      EXPECT_NEAR(u.coefficients[c][k].u / std::sqrt(v(at, at)), 1.0, 1e-9);
      EXPECT_NEAR(u.coefficients[c][k].u_classical / std::sqrt(s2 * bread(at, at)), 1.0, 1e-9);
    }
  }
}

// Noise that the residuals show is that of the instrument, whose u columns the first fit does not read.
TEST(Uncertainty, OfResidualsIsThatOfTheReadings) {
  for (const Sampling sampling : {Sampling::incidence_plane, Sampling::hemisphere}) {
    for (const Noise noise : {Noise{0.02, 1e-5}, Noise{0.0, 0.002}, Noise{0.02, 0.002}}) {
      const Material truth = test::laser_paper_73();
      const Scan scan = simulate(truth, sampling, noise, 4, true);
      FitSettings settings = settings_for(truth);
      const FitResult by_readings = fit(scan, settings);
      settings.uncertainty = UncertaintySource::residuals;
      const FitResult by_residuals = fit(scan, settings);
      EXPECT_EQ(by_residuals.uncertainty_from, UncertaintySource::residuals);
      for (std::size_t i = 0; i < by_readings.parameters.size(); ++i) {
        const FittedParameter& p = by_readings.parameters[i];
        if (!p.u) continue;
        EXPECT_NEAR(*by_residuals.parameters[i].u / *p.u, 1.0, 0.5) << p.channel << p.name << noise.additive;
      }
    }
  }
}

// The same with the readings' own uncertainties in place of the residuals, and an error of the scale.
TEST(Uncertainty, PropagatesThatOfTheReadingsAndOfTheScale) {
  const Material truth = test::laser_paper_73();
  const Scan scan = simulate(truth, Sampling::incidence_plane, {0.02, 0.002}, 4, true);
  FitSettings settings = settings_for(truth);
  settings.scale_u = 0.02;
  const Problem problem(scan, settings);
  ASSERT_EQ(problem.uncertainty, UncertaintySource::readings);
  const Polished best = polish(problem, search(problem).minima.front());
  const Linearisation l = linearise(problem, best.point);
  const Uncertainties u = uncertainties(problem, best.point, l);
  const auto n = static_cast<Eigen::Index>(problem.samples());
  Eigen::MatrixXd j = Eigen::MatrixXd::Zero(3 * n, 10);
  Eigen::VectorXd sd(3 * n);
  Eigen::VectorXd y(3 * n);
  for (Eigen::Index c = 0; c < 3; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    j.block(c * n, 0, n, 1) = l.by_shape[channel];
    j.block(c * n, 1 + 3 * c, n, 3) = l.by_coefficient[channel];
    sd.segment(c * n, n) = problem.weight.cwiseProduct(problem.channels[channel].u);
    y.segment(c * n, n) = problem.channels[channel].target;
  }
  const Eigen::MatrixXd bread = (j.transpose() * j).inverse();
  const Eigen::MatrixXd v = bread * j.transpose() * sd.array().square().matrix().asDiagonal() * j * bread;
  const Eigen::VectorXd g = bread * j.transpose() * y;
  EXPECT_LT((u.covariance_readings - v).norm() / v.norm(), 1e-9);
  EXPECT_LT((u.covariance - v - 4e-4 * g * g.transpose()).norm() / u.covariance.norm(), 1e-9);
  EXPECT_NEAR(u.reduced_chi_square, 1.0, 0.2);
  // A scale that is off moves every k by its full part, and leaves the slope where it is.
  EXPECT_LT(u.shape[0].u_scale, 1e-6);
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(u.coefficients[c][k].u_scale / best.point.coefficients[c][static_cast<Eigen::Index>(k)], 0.02, 1e-6);
  }
  const Eigen::Index r = u.coefficients[0][1].index;
  const Eigen::Index b = u.coefficients[2][1].index;
  EXPECT_GT(u.covariance(r, b) / std::sqrt(u.covariance(r, r) * u.covariance(b, b)), 0.95);
}

TEST(Uncertainty, HasNoneWhereFixed) {
  const Material truth = test::garnet_red_paint_13();  // k_uds of G and B are 0
  const Scan scan = simulate(truth, Sampling::hemisphere, {0.0, 0.0}, 4);
  FitSettings s = settings_for(truth);
  s.parameters["k_uds"].value = 0.0;
  s.parameters["R.k_dd"].value = 0.0;
  const Problem problem(scan, s);
  const Polished best = polish(problem, search(problem).minima.front());
  const Uncertainties u = uncertainties(problem, best.point, linearise(problem, best.point));
  EXPECT_EQ(u.coefficients[0][0].state, ParameterState::fixed);
  EXPECT_EQ(u.coefficients[1][1].state, ParameterState::fixed);
  EXPECT_FALSE(std::isfinite(u.coefficients[1][1].u));
  EXPECT_FALSE(std::isfinite(u.coefficients[1][1].u_classical));
  EXPECT_FALSE(std::isfinite(u.coefficients[1][1].u_unscaled));
  EXPECT_EQ(u.coefficients[1][0].state, ParameterState::free);
}

TEST(Uncertainty, GrowsWithTheNoise) {
  const Material truth = test::ground_glass_41();
  const auto slope_u = [&](double noise) {
    const Problem problem(simulate(truth, Sampling::hemisphere, {noise, 0.0}, 9), settings_for(truth));
    const Polished best = polish(problem, search(problem).minima.front());
    return uncertainties(problem, best.point, linearise(problem, best.point)).shape[0].u;
  };
  EXPECT_NEAR(slope_u(0.02) / slope_u(0.002), 10.0, 0.3);
}

// Where every reading has the same absolute noise all forms say the same, and the unscaled one says it of weights that
// are the inverse variance.
TEST(Uncertainty, FormsAgreeOnEvenNoise) {
  const Material truth = test::ground_glass_41();
  constexpr double noise = 0.003;
  FitSettings s = settings_for(truth);
  s.weight = Weight::none;
  const Problem problem(simulate(truth, Sampling::hemisphere, {0.0, noise}, 9), s);
  const Polished best = polish(problem, search(problem).minima.front());
  const ParameterUncertainty slope = uncertainties(problem, best.point, linearise(problem, best.point)).shape[0];
  EXPECT_NEAR(slope.u_classical / (noise * slope.u_unscaled), 1.0, 0.02);  // s of 10^4 readings is known to 0.7 %
  EXPECT_NEAR(slope.u / slope.u_classical, 1.0, 0.05);
}

// As many readings as parameters leave no residual to estimate from, but weights that are known still state theirs.
TEST(Uncertainty, UnscaledNeedsNoSpareReadings) {
  const Material truth = test::ground_glass_41();
  Scan scan = simulate(truth, Sampling::incidence_plane, {0.0, 0.0}, 1);
  const std::vector<std::size_t> kept{0, 30, 33};
  Scan few = select_channels(scan, {"R"});
  for (std::vector<double>* column :
       {&few.theta_i_deg, &few.phi_i_deg, &few.theta_r_deg, &few.phi_r_deg, &few.channels[0].values}) {
    const std::vector<double> all = *column;
    column->clear();
    for (const std::size_t row : kept) column->push_back(all[row]);
  }
  const Problem problem(few, settings_for(truth));
  const Polished best = polish(problem, search(problem).minima.front());
  const ParameterUncertainty slope = uncertainties(problem, best.point, linearise(problem, best.point)).shape[0];
  EXPECT_TRUE(std::isfinite(slope.u_unscaled));
  EXPECT_FALSE(std::isfinite(slope.u_classical));
  EXPECT_FALSE(std::isfinite(slope.u));
}

// The spread of the slope over simulated scans against what each scan states of itself.
TEST(Uncertainty, StatesTheSpreadOfRepeatedScans) {
  const Material truth = test::ground_glass_41();
  constexpr int trials = 120;
  double sum = 0.0;
  double sum2 = 0.0;
  double stated2 = 0.0;
  for (int t = 0; t < trials; ++t) {
    const Problem problem(simulate(truth, Sampling::incidence_plane, {0.02, 0.0}, 1000 + static_cast<std::uint64_t>(t)),
                          settings_for(truth));
    const Polished best = polish(problem, search(problem).minima.front());
    const double u = uncertainties(problem, best.point, linearise(problem, best.point)).shape[0].u;
    sum += best.point.z[0];
    sum2 += best.point.z[0] * best.point.z[0];
    stated2 += u * u;
  }
  const double spread = std::sqrt((sum2 - sum * sum / trials) / (trials - 1));
  const double stated = std::sqrt(stated2 / trials);
  EXPECT_NEAR(stated / spread, 1.0, 0.25);  // the spread of 120 trials is itself known to 6.5 %
}

}  // namespace
}  // namespace goniofit
