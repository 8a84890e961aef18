#include "fit/intervals.h"

#include <gtest/gtest.h>

#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <limits>

#include "fit/fit.h"
#include "fit/studentised.h"
#include "fit/unified_interval.h"
#include "support/materials.h"
#include "synthetic/random.h"
#include "synthetic/simulate.h"

namespace goniofit {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Feldman & Cousins 1998, table X.
TEST(UnifiedInterval, IsTheirs) {
  const auto upper = [](double x, double p) { return unified_interval(x, 1.0, 0.0, infinity, p); };
  EXPECT_NEAR(upper(-3.0, 0.90).upper, 0.26, 0.006);
  EXPECT_NEAR(upper(-3.0, 0.95).upper, 0.42, 0.006);
  EXPECT_NEAR(upper(0.0, 0.90).upper, 1.64, 0.006);
  EXPECT_NEAR(upper(0.0, 0.95).upper, 1.96, 0.006);
  EXPECT_NEAR(upper(1.0, 0.90).upper, 2.64, 0.006);
  EXPECT_EQ(upper(1.0, 0.90).lower, 0.0);
  EXPECT_NEAR(upper(3.0, 0.90).lower, 1.37, 0.012);
}

TEST(UnifiedInterval, HasItsProbabilityForEveryMeanWithinTheBounds) {
  for (const double probability : {probability_68, probability_95}) {
    for (const double mean : {0.0, 0.2, 0.7, 1.5, 2.5, 5.0}) {
      double covered = 0.0;
      constexpr double step = 0.004;
      for (double x = mean - 6.0; x < mean + 6.0; x += step) {
        // Mirrored at an upper bound of 1, and in other units.
        const Interval in = unified_interval(1.0 - 0.1 * x, 0.1, -infinity, 1.0, probability);
        const bool holds = in.lower <= 1.0 - 0.1 * mean + 1e-12 && 1.0 - 0.1 * mean <= in.upper + 1e-12;
        if (holds) covered += step * std::exp(-0.5 * (x - mean) * (x - mean)) / std::sqrt(2.0 * pi);
      }
      EXPECT_NEAR(covered, probability, 0.003) << mean;
    }
  }
}

TEST(UnifiedInterval, IsCentralFarFromBounds) {
  const Interval in = unified_interval(5.0, 0.5, 0.0, 10.0, probability_95);
  EXPECT_NEAR(in.lower, 5.0 - 0.979982, 1e-5);
  EXPECT_NEAR(in.upper, 5.0 + 0.979982, 1e-5);
}

// A variance that does not know the estimate: Student's t.
TEST(SignedForm, IsStudentsTWhereTheVarianceIsIndependent) {
  for (const double freedom : {3.0, 8.0, 40.0}) {
    const SignedForm form(Eigen::MatrixXd::Zero(1, 1), 1.0, freedom);
    for (const double p : {probability_68, probability_95})
      EXPECT_NEAR(form.factor(p) / coverage_factor(p, freedom), 1.0, 0.03) << freedom;
  }
}

// Σ y / √Σ y²: its square over n has a beta distribution, its tails are shorter than the normal ones.
TEST(SignedForm, IsTheSelfNormalisedSumWhereTheReadingsDecideBoth) {
  for (const int n : {3, 6, 20}) {
    const SignedForm form(Eigen::MatrixXd::Identity(n, n) / n, 1e-12, 1.0);
    const boost::math::beta_distribution<double> beta(0.5, 0.5 * (n - 1));
    for (const double p : {probability_68, probability_95})
      EXPECT_NEAR(form.factor(p) / std::sqrt(n * boost::math::quantile(beta, p)), 1.0, 0.03) << n;
  }
}

// How many of n intervals that have 93 to 97 % may hold.
void expect_95_percent(int holds, int n) {
  EXPECT_GE(holds, boost::math::quantile(boost::math::binomial(n, 0.93), 1e-4));
  EXPECT_LE(holds, boost::math::quantile(boost::math::complement(boost::math::binomial(n, 0.97), 1e-4)));
}

struct Coverage {
  int holds = 0, plain = 0, stated = 0;  ///< by the interval; by value ± 1.96 u; all intervals
};

Coverage coverage_of(const std::string& name, const std::vector<FitResult>& fits, double truth) {
  Coverage out;
  for (const FitResult& f : fits) {
    for (const FittedParameter& p : f.parameters) {
      if (p.name != name || !p.interval_95) continue;
      ++out.stated;
      out.holds += p.interval_95->lower <= truth && truth <= p.interval_95->upper ? 1 : 0;
      out.plain += p.u && std::fabs(*p.value - truth) <= 1.96 * *p.u ? 1 : 0;
    }
  }
  return out;
}

// A handful of mirror readings decide sigma, and with it how sure it seems.
TEST(Intervals, HoldWhereAFewBrightReadingsDecide) {
  const Material truth = test::smooth_aluminium_45();
  FitSettings s;
  s.components = truth.components;
  std::vector<FitResult> fits;
  for (std::uint64_t t = 0; t < 150; ++t)
    fits.push_back(fit(simulate(truth, Sampling::incidence_plane, {0.02, 0.0}, subkey(451, t)), s));
  for (const auto& [name, value] : {std::pair{"sigma_um", 0.23}, {"slope", 0.23 / 9.9}, {"tau_um", 9.9}}) {
    const Coverage c = coverage_of(name, fits, value);
    EXPECT_EQ(c.stated, 150);
    expect_95_percent(c.holds, c.stated);
  }
  // k_dd is 1, its bound.
  const Coverage k = coverage_of("k_dd", fits, 1.0);
  EXPECT_EQ(k.stated, 150);
  expect_95_percent(k.holds, k.stated);
}

TEST(Intervals, OfOneOnItsBoundIsOneSided) {
  const Material truth = test::garnet_red_paint_13();  // k_uds of G and B are 0
  FitSettings s;
  s.components = truth.components;
  int bound = 0;
  for (std::uint64_t t = 0; t < 6; ++t) {
    const FitResult r = fit(simulate(truth, Sampling::incidence_plane, {0.02, 0.0}, subkey(13, t)), s);
    for (const FittedParameter& p : r.parameters) {
      if (!p.at_lower) continue;
      ++bound;
      ASSERT_TRUE(p.interval_95 && p.interval_68) << p.name;
      EXPECT_EQ(p.interval_95->lower, 0.0);
      EXPECT_GT(p.interval_95->upper, p.interval_68->upper);
      if (p.name == "k_uds") {
        EXPECT_LT(p.interval_95->upper, 0.05);
      }
      EXPECT_FALSE(p.coverage_factor);
    }
  }
  EXPECT_GT(bound, 0);
}

// A scan whose readings at one incidence angle are off by a common factor.
Scan with_angle_errors(Scan scan, double sd, std::uint64_t seed) {
  for (ScanChannel& channel : scan.channels) {
    for (std::size_t row = 0; row < scan.size(); ++row) {
      RandomStream stream(subkey(seed, static_cast<std::uint64_t>(std::lround(10.0 * scan.theta_i_deg[row]))));
      channel.values[row] *= 1.0 + sd * stream.gaussian();
    }
  }
  return scan;
}

TEST(Intervals, FromAnglesHoldWhereReadingsOfAnAngleShareErrors) {
  Material truth = test::ground_glass_41();
  truth.channels.resize(1);
  FitSettings by_angles;
  by_angles.components = truth.components;
  by_angles.uncertainty = UncertaintySource::angles;
  FitSettings by_residuals = by_angles;
  by_residuals.uncertainty = UncertaintySource::residuals;
  constexpr int trials = 150;
  std::vector<FitResult> angles;
  std::vector<FitResult> residuals;
  for (std::uint64_t t = 0; t < trials; ++t) {
    const Scan scan =
        with_angle_errors(simulate(truth, Sampling::incidence_plane, {0.005, 0.0}, subkey(7, t)), 0.03, subkey(8, t));
    angles.push_back(fit(scan, by_angles));
    residuals.push_back(fit(scan, by_residuals));
  }
  EXPECT_EQ(angles.front().uncertainty_from, UncertaintySource::angles);
  for (const auto& [name, value] : {std::pair{"slope", 0.86 / 4.99}, {"k_dd", 0.45}, {"k_udf", 0.33}}) {
    const Coverage honest = coverage_of(name, angles, value);
    EXPECT_EQ(honest.stated, trials);
    // Of seven angles the bootstrap is no exact test: 90 to 99 %.
    EXPECT_GE(honest.holds, boost::math::quantile(boost::math::binomial(trials, 0.90), 1e-4)) << name;
    const Coverage blind = coverage_of(name, residuals, value);
    EXPECT_LT(blind.holds, boost::math::quantile(boost::math::binomial(trials, 0.90), 1e-4)) << name;
    if (name == std::string("k_udf")) {
      EXPECT_LT(honest.plain, honest.holds);
    }
  }
}

}  // namespace
}  // namespace goniofit
