#include "synthetic/verify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "io/material_io.h"
#include "support/error.h"
#include "support/materials.h"
#include "support/paths.h"

namespace goniofit {
namespace {

/// A rough metal of one channel: quick to fit.
Material metal() {
  Material m;
  m.name = "metal";
  m.components = {Effect::dd, Effect::udf};
  m.surface.slope = 0.17;
  MaterialChannel g{.name = "G", .wavelength_um = 0.55, .n = 0.958, .kappa = 6.69, .f0 = {}, .k = {}, .peer_k = {}};
  g.coefficient(Coefficient::k_dd) = 0.45;
  g.coefficient(Coefficient::k_udf) = 0.33;
  m.channels = {g};
  return m;
}

class VerifyRecipe : public ::testing::Test {
 protected:
  void SetUp() override { truth(metal()); }

  void truth(const Material& material) {
    write_material(scratch_ / "metal.truth.json", material);
    recipe_.source = scratch_ / "metal.toml";
    recipe_.settings.components = EffectSet{Effect::dd, Effect::udf};
    recipe_.verify = VerifySettings{};
    recipe_.verify->truth = scratch_ / "metal.truth.json";
    recipe_.verify->sampling = Sampling::incidence_plane;
    recipe_.verify->trials = 30;
  }

  test::ScratchDir scratch_;
  Recipe recipe_;
};

const Recovery& find(const VerifyReport& report, const std::string& parameter) {
  const auto found = std::find_if(report.parameters.begin(), report.parameters.end(),
                                  [&](const Recovery& r) { return r.parameter == parameter; });
  if (found == report.parameters.end()) throw std::runtime_error("no parameter " + parameter);
  return *found;
}

TEST_F(VerifyRecipe, RecoversTheTruth) {
  const VerifyReport report = verify_recipe(recipe_, 0, 1);
  EXPECT_EQ(report.name, "metal");
  EXPECT_EQ(report.trials, 30U);
  EXPECT_EQ(report.failures, 0U);
  EXPECT_TRUE(report.missed.empty()) << report.missed.front();
  for (const auto& [name, value] : {std::pair{"slope", 0.17}, {"G.k_dd", 0.45}, {"G.k_udf", 0.33}}) {
    const Recovery& r = find(report, name);
    EXPECT_DOUBLE_EQ(r.truth, value);
    EXPECT_EQ(r.coverage_95.of, 30U) << name;
    EXPECT_GT(r.spread, 0.0) << name;
    EXPECT_LT(std::fabs(r.bias), 4.0 * r.spread / std::sqrt(30.0)) << name;
    EXPECT_GT(r.mean_u, 0.5 * r.spread) << name;
    EXPECT_LT(r.mean_u, 2.0 * r.spread) << name;
    EXPECT_GT(r.coverage_95.fraction(), 0.8) << name;
  }
}

TEST_F(VerifyRecipe, IsAFunctionOfTheSeed) {
  const VerifyReport once = verify_recipe(recipe_, 8, 3);
  const VerifyReport again = verify_recipe(recipe_, 8, 3);
  const VerifyReport other = verify_recipe(recipe_, 8, 4);
  EXPECT_EQ(once.trials, 8U);
  for (const char* name : {"slope", "G.k_dd"}) {
    EXPECT_EQ(find(once, name).mean, find(again, name).mean);
    EXPECT_EQ(find(once, name).spread, find(again, name).spread);
    EXPECT_NE(find(once, name).mean, find(other, name).mean);
  }
}

// More trials than one block of them, which is where the order of the sums could depend on threads.
TEST_F(VerifyRecipe, IsTheSameForAnyNumberOfThreads) {
  const VerifyReport one = verify_recipe(recipe_, 140, 3, {.threads = 1});
  const VerifyReport three = verify_recipe(recipe_, 140, 3, {.threads = 3});
  ASSERT_EQ(one.parameters.size(), three.parameters.size());
  for (std::size_t i = 0; i < one.parameters.size(); ++i) {
    EXPECT_EQ(one.parameters[i].determined, 140U);
    EXPECT_EQ(one.parameters[i].mean, three.parameters[i].mean);
    EXPECT_EQ(one.parameters[i].spread, three.parameters[i].spread);
    EXPECT_EQ(one.parameters[i].mean_u, three.parameters[i].mean_u);
    EXPECT_EQ(one.parameters[i].coverage_68.count, three.parameters[i].coverage_68.count);
  }
}

TEST_F(VerifyRecipe, ReportsProgressOverAllTrials) {
  std::size_t last = 0;
  const auto progress = [&](std::size_t done, std::size_t total) {
    EXPECT_EQ(done, last + 1);
    EXPECT_EQ(total, 130U);
    last = done;
  };
  recipe_.settings.parameters["slope"].value = 0.17;  // linear, so quick
  (void)verify_recipe(recipe_, 130, 1, {.progress = progress});
  EXPECT_EQ(last, 130U);
}

TEST_F(VerifyRecipe, RecipesDoNotShareTheirNoise) {
  const VerifyReport metal_report = verify_recipe(recipe_, 2, 3);
  recipe_.source = scratch_ / "other.toml";
  EXPECT_NE(find(metal_report, "slope").mean, find(verify_recipe(recipe_, 2, 3), "slope").mean);
}

TEST_F(VerifyRecipe, KnownNoiseIsStatedInTheScans) {
  std::size_t with_u = 0;
  std::size_t scans = 0;
  VerifyRun run{.threads = 1};
  run.fitter = [&](const Scan& scan, const FitSettings& settings) {
    ++scans;
    with_u += scan.channels[0].u.empty() ? 0 : 1;
    return fit(scan, settings);
  };
  (void)verify_recipe(recipe_, 2, 1, run);
  EXPECT_EQ(with_u, 0U);
  recipe_.verify->known_noise = true;
  (void)verify_recipe(recipe_, 2, 1, run);
  EXPECT_EQ(with_u, 2U);
  EXPECT_EQ(scans, 4U);
}

// The fit, but for what it says of its own uncertainty.
TEST_F(VerifyRecipe, SeesAFitterThatHalvesItsUncertainties) {
  recipe_.verify->coverage_95 = std::pair{0.93, 0.97};
  VerifyRun run;
  EXPECT_TRUE(verify_recipe(recipe_, 120, 1, run).missed.empty());
  run.fitter = [](const Scan& scan, const FitSettings& settings) {
    FitResult result = fit(scan, settings);
    for (FittedParameter& p : result.parameters) {
      if (p.u) *p.u *= 0.5;
      p.interval_68.reset();
      p.interval_95.reset();
    }
    return result;
  };
  EXPECT_EQ(verify_recipe(recipe_, 120, 1, run).missed.size(), 3U);
}

TEST_F(VerifyRecipe, AFitThatDoesNotConvergeIsAFailure) {
  VerifyRun run;
  run.fitter = [](const Scan& scan, const FitSettings& settings) {
    FitResult result = fit(scan, settings);
    result.converged = false;
    return result;
  };
  const VerifyReport report = verify_recipe(recipe_, 3, 1, run);
  EXPECT_EQ(report.failures, 3U);
  ASSERT_EQ(report.missed.size(), 1U);
}

TEST_F(VerifyRecipe, AParameterNoTrialDeterminesIsNamed) {
  Material known_lengths = metal();
  known_lengths.surface = test::surface(0.85, 5.0);
  truth(known_lengths);
  const VerifyReport report = verify_recipe(recipe_, 2, 1);
  EXPECT_EQ(report.undetermined, (std::vector<std::string>{"sigma_um", "tau_um"}));
}

TEST_F(VerifyRecipe, MissesABoundThatNoFitterMeets) {
  recipe_.verify->slope_bias = 1e-9;
  const VerifyReport report = verify_recipe(recipe_, 4, 1);
  ASSERT_EQ(report.missed.size(), 1U);
  EXPECT_EQ(report.missed[0].rfind("slope: the mean is ", 0), 0U) << report.missed[0];
}

// A fit that is told half of the metal's reflectance puts k_dd at twice its value: the intervals must be seen to be
// wrong.
TEST_F(VerifyRecipe, SeesAFitWithWrongOpticalConstants) {
  Material half = metal();
  half.channels[0].coefficient(Coefficient::k_dd) = 0.2;
  truth(half);
  recipe_.settings.n = {1.5};
  recipe_.settings.kappa = {1.5};
  recipe_.verify->coverage_95 = std::pair{0.9, 1.0};
  const VerifyReport report = verify_recipe(recipe_, 10, 1);
  EXPECT_FALSE(report.missed.empty());
  EXPECT_EQ(find(report, "G.k_dd").coverage_95.count, 0U);
}

TEST_F(VerifyRecipe, FixedParametersAreNotRecovered) {
  recipe_.settings.parameters["slope"].value = 0.17;
  const VerifyReport report = verify_recipe(recipe_, 3, 1);
  EXPECT_EQ(report.parameters.size(), 2U);
  EXPECT_THROW((void)find(report, "slope"), std::runtime_error);
}

TEST_F(VerifyRecipe, WithoutNoiseRecoversExactly) {
  recipe_.verify->noise = {0.0, 0.0};
  const VerifyReport report = verify_recipe(recipe_, 1, 1);
  EXPECT_EQ(report.failures, 0U);
  EXPECT_NEAR(find(report, "slope").mean, 0.17, 1e-7);
  EXPECT_NEAR(find(report, "G.k_udf").mean, 0.33, 1e-7);
}

TEST_F(VerifyRecipe, RecoversAnAnisotropicSurface) {
  Material brushed = metal();
  brushed.surface.slope_y = 0.05;
  truth(brushed);
  recipe_.settings.anisotropic = true;
  const VerifyReport report = verify_recipe(recipe_, 4, 1);
  EXPECT_EQ(report.failures, 0U);
  EXPECT_DOUBLE_EQ(find(report, "slope_y").truth, 0.05);
  EXPECT_NEAR(find(report, "slope_y").mean, 0.05, 0.001);
  EXPECT_NEAR(find(report, "slope").mean, 0.17, 0.004);
}

TEST_F(VerifyRecipe, RecoversGroovesUnderALobe) {
  Material plaster = metal();
  plaster.components = {Effect::dd, Effect::rough};
  plaster.surface.facet_slope_deg = 30.0;
  plaster.channels[0].coefficient(Coefficient::rho) = 0.7;
  truth(plaster);
  recipe_.settings.components = plaster.components;
  const VerifyReport report = verify_recipe(recipe_, 4, 1);
  EXPECT_EQ(report.failures, 0U);
  EXPECT_NEAR(find(report, "facet_slope_deg").mean, 30.0, 1.5);
  EXPECT_NEAR(find(report, "G.rho").mean, 0.7, 0.03);
}

TEST_F(VerifyRecipe, RecoversAPeer) {
  Material ggx = test::anisotropic_ggx();
  ggx.channels.resize(1);
  truth(ggx);
  recipe_.settings.model = ggx.model;
  recipe_.settings.components.reset();
  const VerifyReport report = verify_recipe(recipe_, 4, 1);
  EXPECT_EQ(report.failures, 0U);
  for (const auto& [name, value] : {std::pair{"alpha_x", 0.1}, {"alpha_y", 0.3}, {"R.k_d", 0.25}, {"R.k_s", 0.75}}) {
    EXPECT_DOUBLE_EQ(find(report, name).truth, value);
    EXPECT_NEAR(find(report, name).mean, value, 0.02 * value) << name;
    EXPECT_EQ(find(report, name).coverage_95.of, 4U) << name;
  }
}

// Another model than the truth's has nothing to recover, but can still be fitted.
TEST_F(VerifyRecipe, AnotherModelOnlyHasToConverge) {
  recipe_.settings.model = "ggx";
  recipe_.settings.components.reset();
  const VerifyReport report = verify_recipe(recipe_, 2, 1);
  EXPECT_EQ(report.failures, 0U);
  EXPECT_TRUE(report.parameters.empty());
}

TEST_F(VerifyRecipe, AChannelIsComparedWithItsOwnTruth) {
  Material two = metal();
  two.channels.push_back(two.channels[0]);
  two.channels[1].name = "B";
  two.channels[1].coefficient(Coefficient::k_dd) = 0.2;
  truth(two);
  recipe_.channels = {"B"};
  const VerifyReport report = verify_recipe(recipe_, 4, 1);
  EXPECT_EQ(report.failures, 0U);
  EXPECT_DOUBLE_EQ(find(report, "B.k_dd").truth, 0.2);
  EXPECT_NEAR(find(report, "B.k_dd").mean, 0.2, 0.01);
}

TEST_F(VerifyRecipe, NeedsATruthAndATrial) {
  recipe_.verify->trials = 0;
  EXPECT_THROW((void)verify_recipe(recipe_, 0, 1), Error);
  recipe_.verify.reset();
  EXPECT_THROW((void)verify_recipe(recipe_, 5, 1), Error);
}

TEST(VerifyRandom, FindsTheMinimumOfMaterialsNobodyChose) {
  const RandomRecoveryReport report = verify_random(12, 1, 2);
  EXPECT_EQ(report.materials, 12U);
  EXPECT_EQ(report.polish_starts, 24U);
  EXPECT_EQ(report.wrong_minima, 0U) << report.failures.front();
  EXPECT_TRUE(report.failures.empty());
  EXPECT_GE(report.worst_ratio, 1.0);
  EXPECT_LT(report.worst_ratio, 1.0005);
  EXPECT_LE(report.polish_failures, report.polish_starts);
}

TEST(VerifyRandom, IsAFunctionOfTheSeed) {
  EXPECT_EQ(verify_random(2, 5, 1).worst_ratio, verify_random(2, 5, 1).worst_ratio);
}

}  // namespace
}  // namespace goniofit
