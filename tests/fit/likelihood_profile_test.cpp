#include "fit/likelihood_profile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>

#include "fit/fit.h"
#include "fit/solve.h"
#include "fit/uncertainty.h"
#include "support/error_message.h"
#include "support/materials.h"
#include "synthetic/simulate.h"

namespace goniofit {
namespace {

FitSettings settings_for(const Material& truth, std::vector<std::string> names = {}) {
  FitSettings s;
  s.components = truth.components;
  s.profile = std::move(names);
  return s;
}

const LikelihoodProfile& profile_of(const FitResult& r, const std::string& key) {
  const auto found =
      std::find_if(r.profiles.begin(), r.profiles.end(), [&](const LikelihoodProfile& p) { return p.key() == key; });
  if (found == r.profiles.end()) throw std::out_of_range("no profile of " + key);
  return *found;
}

// Every so many readings of a scan: many fits in little time.
Scan thinned(const Scan& scan, std::size_t step) {
  Scan few = scan;
  const auto thin = [step](std::vector<double>& column) {
    std::vector<double> kept;
    for (std::size_t i = 0; i < column.size(); i += step) kept.push_back(column[i]);
    column = std::move(kept);
  };
  for (auto* column : {&few.theta_i_deg, &few.phi_i_deg, &few.theta_r_deg, &few.phi_r_deg}) thin(*column);
  for (ScanChannel& c : few.channels) {
    thin(c.values);
    thin(c.u);
  }
  return few;
}

// The loss of coefficients at a given shape is a parabola, and the interval value ± k u whatever the adjustment.
TEST(LikelihoodProfile, OfAQuadraticLossIsTheIntervalByU) {
  const Material truth = test::laser_paper_73();
  FitSettings s = settings_for(truth);
  s.parameters["slope"].value = truth.surface.slope;
  const FitResult r = fit(simulate(truth, Sampling::hemisphere, {0.02, 1e-3}, 3), s);
  ASSERT_EQ(r.profiles.size(), 9U);
  for (const LikelihoodProfile& p : r.profiles) {
    ASSERT_TRUE(p.u && p.interval_95 && p.interval_68) << p.key();
    const double reach = p.coverage_factor * *p.u;
    EXPECT_NEAR((p.value - p.interval_95->lower) / reach, 1.0, 1e-3) << p.key();
    EXPECT_NEAR((p.interval_95->upper - p.value) / reach, 1.0, 1e-3) << p.key();
    EXPECT_NEAR((p.interval_68->upper - p.value) / *p.u, 1.0, 1e-2) << p.key();
    EXPECT_EQ(p.remark(), "") << p.key();
    for (const ProfilePoint& at : p.points)
      EXPECT_NEAR(at.delta, std::pow((at.value - p.value) / *p.u, 2), 2e-3 * (1.0 + at.delta)) << p.key();
  }
}

TEST(LikelihoodProfile, TakesThePlaceOfTheIntervalByU) {
  const Material truth = test::ground_glass_41();
  const Scan scan = thinned(simulate(truth, Sampling::hemisphere, {0.05, 0.0}, 3), 7);
  const FitResult r = fit(scan, settings_for(truth, {"slope", "G.k_dd"}));
  ASSERT_EQ(r.profiles.size(), 2U);
  const LikelihoodProfile& slope = profile_of(r, "slope");
  const auto row = std::find_if(r.parameters.begin(), r.parameters.end(),
                                [](const FittedParameter& p) { return p.name == "slope"; });
  EXPECT_EQ(row->interval_95, slope.interval_95);
  EXPECT_EQ(row->interval_68, slope.interval_68);
  EXPECT_EQ(r.material.fit->interval_95.at("slope"), *slope.interval_95);
  EXPECT_EQ(r.material.fit->interval_95.at("G.k_dd"), *profile_of(r, "G.k_dd").interval_95);
  EXPECT_LT(slope.interval_95->lower, slope.interval_68->lower);
  EXPECT_GT(slope.interval_95->upper, slope.interval_68->upper);
}

// Weights 1/u² and the uncertainty that goes with them: c = 1, the likelihood ratio itself.
TEST(LikelihoodProfile, OfKnownUncertaintiesIsThePlainLikelihood) {
  const Material truth = test::ground_glass_41();
  const Scan scan = simulate(truth, Sampling::incidence_plane, {0.01, 1e-4}, 5, true);
  Problem problem(scan, settings_for(truth));
  std::vector<Eigen::VectorXd> emphasis;
  for (const ProblemChannel& c : problem.channels)
    emphasis.emplace_back((c.u.cwiseProduct(problem.weight)).cwiseInverse());
  problem.emphasise(std::move(emphasis));
  const Solved solved = solve(problem);
  const Uncertainties u = uncertainties(problem, solved.best.point, linearise(problem, solved.best.point));
  FittedParameter row;
  row.name = "slope";
  row.value = std::exp(solved.best.point.z[0]);
  row.u = *row.value * u.shape[0].u_unscaled;
  const auto profiles = likelihood_profiles(problem, solved.best.point, {row}, {"slope"});
  ASSERT_EQ(profiles.size(), 1U);
  // The linear model's curvature is the profile's but for residual times second derivative, of order 1/sqrt(N).
  EXPECT_NEAR(profiles[0].scale, 1.0, 0.03);
}

TEST(LikelihoodProfile, IsOneSidedOnABound) {
  const Material truth = test::garnet_red_paint_13();  // k_uds of G and B are 0
  const Scan scan = simulate(truth, Sampling::hemisphere, {0.0, 2e-3}, 11);
  const FitResult r = fit(scan, settings_for(truth, {"k_uds"}));
  std::size_t on_bound = 0;
  for (const LikelihoodProfile& p : r.profiles) {
    if (p.lower_end != ProfileEnd::bound) continue;
    ++on_bound;
    ASSERT_TRUE(p.interval_95);
    EXPECT_EQ(p.interval_95->lower, 0.0);
    EXPECT_GT(p.interval_95->upper, 0.0);
    EXPECT_LT(p.interval_95->upper, 0.02);
    EXPECT_EQ(p.upper_end, ProfileEnd::crossed);
    EXPECT_NE(p.remark().find("one-sided"), std::string::npos);
  }
  EXPECT_GE(on_bound, 1U);
}

TEST(LikelihoodProfile, OfWhatNothingDeterminesIsOpen) {
  Material lambertian = test::ground_glass_41();
  lambertian.components = {Effect::udf};
  FitSettings s = settings_for(lambertian, {"slope"});
  s.components = EffectSet{Effect::dd, Effect::udf};
  s.parameters["k_dd"].value = 0.0;
  const FitResult r = fit(simulate(lambertian, Sampling::hemisphere, {0.02, 0.0}, 2), s);
  const LikelihoodProfile& p = profile_of(r, "slope");
  EXPECT_FALSE(p.determined);
  EXPECT_EQ(p.lower_end, ProfileEnd::open);
  EXPECT_EQ(p.upper_end, ProfileEnd::open);
  EXPECT_NE(p.remark().find("open on both sides"), std::string::npos);
  EXPECT_FALSE(r.material.fit->interval_95.contains("slope"));
}

// Values that the model meets to round-off leave no curvature to speak of.
TEST(LikelihoodProfile, OfExactDataIsNone) {
  const Material truth = test::ground_glass_41();
  const FitResult r = fit(simulate(truth, Sampling::incidence_plane, {0.0, 0.0}, 1), settings_for(truth, {"slope"}));
  EXPECT_TRUE(profile_of(r, "slope").exact);
  EXPECT_FALSE(profile_of(r, "slope").interval_95);
}

// tau follows from two parameters: its profile is what fits with tau fixed give.
TEST(LikelihoodProfile, OfADerivedLengthHoldsThatLength) {
  Material truth = test::ground_glass_41();
  truth.surface = test::surface(0.2, 4.0);  // smooth enough for its wavelengths to tell sigma
  truth.terms.distribution = DistributionTier::he_torrance;
  const Scan scan = thinned(select_channels(simulate(truth, Sampling::hemisphere, {0.03, 0.0}, 8), {"G"}), 9);
  FitSettings s = settings_for(truth, {"tau_um"});
  s.terms.distribution = DistributionTier::he_torrance;
  Problem problem(scan, s);
  const Solved solved = solve(problem);
  const auto profiles = likelihood_profiles(problem, solved.best.point, {}, {"tau_um"});
  ASSERT_EQ(profiles.size(), 1U);
  const LikelihoodProfile& p = profiles[0];
  ASSERT_GT(p.points.size(), 4U);
  for (const std::size_t i : {std::size_t{0}, p.points.size() - 1}) {
    FitSettings fixed = s;
    fixed.parameters["tau_um"].value = p.points[i].value;
    const Problem with_tau(scan, fixed);
    EXPECT_NEAR(solve(with_tau).best.point.loss / p.points[i].loss, 1.0, 1e-7) << p.points[i].value;
  }
}

TEST(LikelihoodProfile, IsDeterministicAndLeavesTheProblemAlone) {
  const Material truth = test::laser_paper_73();
  const Scan scan = thinned(simulate(truth, Sampling::hemisphere, {0.02, 0.0}, 3), 9);
  Problem problem(scan, settings_for(truth));
  const Solved solved = solve(problem);
  const auto once = likelihood_profiles(problem, solved.best.point, {}, {});
  const auto again = likelihood_profiles(problem, solved.best.point, {}, {});
  ASSERT_EQ(once.size(), again.size());
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(once[i].interval_95, again[i].interval_95) << once[i].key();
    ASSERT_EQ(once[i].points.size(), again[i].points.size());
    for (std::size_t j = 0; j < once[i].points.size(); ++j) EXPECT_EQ(once[i].points[j].loss, again[i].points[j].loss);
  }
  EXPECT_EQ(solve(problem).best.point.loss, solved.best.point.loss);
}

// A fit that ended in a wrong minimum is found out.
TEST(LikelihoodProfile, TellsOfALowerLoss) {
  const Material truth = test::laser_paper_73();
  const Scan scan = thinned(simulate(truth, Sampling::hemisphere, {0.02, 0.0}, 3), 9);
  Problem problem(scan, settings_for(truth));
  FitPoint wrong = solve(problem).best.point;
  wrong.z[0] += 0.05;
  wrong.loss = linearise(problem, wrong).loss;
  const auto profiles = likelihood_profiles(problem, wrong, {}, {"k_fs"});
  ASSERT_FALSE(profiles.empty());
  EXPECT_TRUE(profiles[0].lower_loss);
  EXPECT_FALSE(profiles[0].interval_95);
  EXPECT_NE(profiles[0].remark().find("lower loss"), std::string::npos);
}

TEST(LikelihoodProfile, NamesTheParametersThereAre) {
  const Material truth = test::laser_paper_73();
  const Scan scan = simulate(truth, Sampling::incidence_plane, {0.02, 0.0}, 3);
  FitSettings s = settings_for(truth, {"slope", "k_dd", "R.k_fs"});
  const Problem problem(scan, s);
  EXPECT_NO_THROW(check_profile_names(problem, *s.profile));
  for (const char* const name : {"roughness", "X.k_dd", "sigma_um"}) {
    const std::string message = test::error_message([&] { check_profile_names(problem, {name}); });
    EXPECT_NE(message.find(name), std::string::npos) << message;
    EXPECT_NE(message.find("slope, k_dd, k_uds, k_fs"), std::string::npos) << message;
  }
}

// How often the truth lies within, at the exact binomial limits of probability 1e-4.
TEST(LikelihoodProfile, Covers95Percent) {
  constexpr std::size_t scans = 200;
  const Material truth = test::ground_glass_41();
  std::size_t slope = 0;
  std::size_t k_dd = 0;
  for (std::size_t seed = 0; seed < scans; ++seed) {
    const Scan all = simulate(truth, Sampling::hemisphere, {0.03, 1e-3}, 900 + seed);
    const Scan scan = thinned(select_channels(all, {"R"}), 8);
    const FitResult r = fit(scan, settings_for(truth, {"slope", "k_dd"}));
    const auto holds = [&](const char* key, double value) {
      const Interval i = *profile_of(r, key).interval_95;
      return i.lower <= value && value <= i.upper ? 1U : 0U;
    };
    slope += holds("slope", *truth.surface.slope);
    k_dd += holds("R.k_dd", *truth.channels[0].coefficient("k_dd"));
  }
  const boost::math::binomial_distribution<double> expected(static_cast<double>(scans), 0.95);
  const double low = boost::math::quantile(expected, 0.5e-4);
  const double high = boost::math::quantile(boost::math::complement(expected, 0.5e-4));
  for (const std::size_t covered : {slope, k_dd}) {
    EXPECT_GE(static_cast<double>(covered), low);
    EXPECT_LE(static_cast<double>(covered), high);
  }
  RecordProperty("slope", static_cast<int>(slope));
  RecordProperty("k_dd", static_cast<int>(k_dd));
}

}  // namespace
}  // namespace goniofit
