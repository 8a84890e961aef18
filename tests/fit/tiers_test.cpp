// Fits with every tier, effect and isotropy: what the data determine comes back, whatever it is.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "fit/fit.h"
#include "fit/polish.h"
#include "support/materials.h"
#include "synthetic/simulate.h"

namespace goniofit {
namespace {

FitSettings settings_of(const Material& truth) {
  FitSettings s;
  s.model = truth.model;
  if (truth.model == surface_model) s.components = truth.components;
  s.terms = truth.terms;
  s.forms = truth.forms;
  s.anisotropic = truth.surface.anisotropic();
  return s;
}

double value_of(const Surface& surface, std::string_view name) { return Surface(surface).find(name)->value_or(NAN); }

// Every parameter of the surface and every coefficient that is not on a bound, to `tolerance` of itself.
void expect_recovered(const Material& truth, const FitResult& r, const std::vector<std::string>& shape,
                      double tolerance) {
  EXPECT_TRUE(r.converged) << truth.name;
  for (const std::string& name : shape) {
    EXPECT_NEAR(value_of(r.material.surface, name) / value_of(truth.surface, name), 1.0, tolerance)
        << truth.name << " " << name;
    EXPECT_TRUE(r.material.fit->identifiable.at(name)) << name;
  }
  for (std::size_t c = 0; c < truth.channels.size(); ++c) {
    for (const Coefficient k : all_coefficients) {
      const double expected = truth.channels[c].coefficient(k).value_or(0.0);
      EXPECT_NEAR(r.material.channels[c].coefficient(k).value_or(0.0), expected, tolerance * std::max(1.0, expected))
          << truth.name << " " << name_of(k);
    }
  }
}

struct Case {
  std::string name;
  Material truth;
  Sampling sampling;
  std::vector<std::string> shape;  ///< what the data determine
};

// Noise-free scans of every configuration that a scan determines.
std::vector<Case> cases() {
  const std::vector<std::string> slope{"slope"};
  const std::vector<std::string> lengths{"slope", "sigma_um", "tau_um"};
  std::vector<Case> all;
  const auto add = [&](const char* name, Sampling sampling, const std::vector<std::string>& shape, const Material& from,
                       const std::function<void(Material&)>& change = {}) {
    Case c{name, from, sampling, shape};
    c.truth.name = name;
    if (change) change(c.truth);
    all.push_back(c);
  };
  const auto hemisphere = Sampling::hemisphere;
  const auto plane = Sampling::incidence_plane;
  add("HeTorrance", plane, lengths, test::he_ground_glass());
  add("HeTorranceSeries", plane, lengths, test::he_ground_glass(), [](Material& m) {
    m.terms.distribution = DistributionTier::he_torrance_series;
    m.channels.resize(1);
  });
  add("HeTorranceSmooth", plane, lengths, test::smooth_aluminium_45(),
      [](Material& m) { m.terms = test::he_torrance_terms(); });
  for (const auto tier : {ShadowingTier::smith, ShadowingTier::schlick, ShadowingTier::none}) {
    add(("Shadowing" + std::to_string(static_cast<int>(tier))).c_str(), hemisphere, slope, test::laser_paper_73(),
        [tier](Material& m) { m.terms.shadowing = tier; });
  }
  add("HeRoughness", hemisphere, slope, test::ground_glass_41(),
      [](Material& m) { m.terms.effective_roughness = EffectiveRoughnessTier::he; });
  add("StudentT", hemisphere, {"slope", "tail"}, test::long_tailed_paint());
  add("StudentTSmith", plane, {"slope", "tail"}, test::long_tailed_paint(),
      [](Material& m) { m.terms.shadowing = ShadowingTier::smith; });
  add("Anisotropic", hemisphere, {"slope", "slope_y"}, test::brushed_aluminium());
  add("AnisotropicSwapped", hemisphere, {"slope", "slope_y"}, test::brushed_aluminium(),
      [](Material& m) { std::swap(m.surface.slope, m.surface.slope_y); });
  add("AnisotropicHeTorrance", plane, {"slope", "slope_y", "sigma_um", "tau_um", "tau_y_um"}, test::brushed_aluminium(),
      [](Material& m) {
        m.terms = test::he_torrance_terms();
        m.surface = {.slope = 0.1, .sigma_um = 0.3, .tau_um = 3.0, .slope_y = 0.02, .tau_y_um = 15.0};
        m.channels.resize(1);
      });
  add("Rough", hemisphere, {"slope", "facet_slope_deg"}, test::rough_plaster());
  add("RoughQualitative", hemisphere, {"slope", "facet_slope_deg"}, test::rough_plaster(),
      [](Material& m) { m.forms.rough = RoughForm::qualitative; });
  add("RoughIntegral", plane, {"facet_slope_deg"}, test::rough_plaster(), [](Material& m) {
    m.forms.rough = RoughForm::integral;
    m.components = {Effect::rough};
    m.surface = {.facet_slope_deg = 25.0};
    for (MaterialChannel& c : m.channels) c.coefficient(Coefficient::k_dd) = 0.0;
  });
  return all;
}

class Tiers : public testing::TestWithParam<std::size_t> {};

TEST_P(Tiers, ComeBackFromNoiseFreeScans) {
  const Case c = cases()[GetParam()];
  const Scan scan = simulate(c.truth, c.sampling, {0.0, 0.0}, 1);
  // The integral is computed to 1e-6, so its derivative by the facet slope is no more exact.
  expect_recovered(c.truth, fit(scan, settings_of(c.truth)), c.shape,
                   c.truth.forms.rough == RoughForm::integral ? 1e-6 : 1e-8);
}

TEST_P(Tiers, ComeBackFromNoisyScansWithinTheirUncertainties) {
  const Case c = cases()[GetParam()];
  const Scan scan = simulate(c.truth, c.sampling, {0.02, 0.0}, 5);
  const FitResult r = fit(scan, settings_of(c.truth));
  EXPECT_TRUE(r.converged);
  for (const FittedParameter& p : r.parameters) {
    if (!p.channel.empty() || !p.value || !p.u) continue;
    EXPECT_LT(std::fabs(*p.value - value_of(c.truth.surface, p.name)), 4.5 * *p.u) << p.name;
  }
  // No worse than the truth itself.
  EXPECT_LE(r.loss, polish_from(scan, settings_of(c.truth), c.truth).loss * (1.0 + 1e-9));
}

INSTANTIATE_TEST_SUITE_P(EveryTier, Tiers, testing::Range<std::size_t>(0, cases().size()),
                         [](const auto& each) { return cases()[each.param].name; });

// Table 1 of Li & Torrance 2005: their model fitted to He et al.'s, at sigma 0.90, tau 5.2. They print a slope of
// 0.172, k_udf of 0.33 to 0.34 and k_dd of 0.44 to 0.45.
TEST(PublishedTable, OfGroundGlassIsReproducedFromHeTorrance) {
  const Scan scan = simulate(test::he_ground_glass(), Sampling::hemisphere, {0.0, 0.0}, 1);
  FitSettings s;
  s.components = EffectSet{Effect::dd, Effect::udf};
  const FitResult r = fit(scan, s);
  EXPECT_NEAR(*r.material.surface.slope / 0.1709, 1.0, 0.01);
  EXPECT_NEAR(*r.material.surface.slope / 0.172, 1.0, 0.02);
  for (const MaterialChannel& c : r.material.channels) {
    EXPECT_NEAR(*c.coefficient(Coefficient::k_udf), 0.34, 0.01);
    EXPECT_NEAR(*c.coefficient(Coefficient::k_dd), 0.43, 0.0105);
    EXPECT_NEAR(*c.coefficient(Coefficient::k_udf), 0.335, 0.03);
    EXPECT_NEAR(*c.coefficient(Coefficient::k_dd), 0.445, 0.03);
  }
  // Channel by channel the slope moves by a percent.
  for (std::size_t c = 0; c < scan.channels.size(); ++c) {
    Scan one = scan;
    one.channels = {scan.channels[c]};
    EXPECT_NEAR(*fit(one, s).material.surface.slope, 0.1715, 0.0023) << scan.channels[c].name;
  }
}

TEST(PublishedTable, NeedsShadowingAndEffectiveRoughness) {
  const Scan scan = simulate(test::he_ground_glass(), Sampling::hemisphere, {0.0, 0.0}, 1);
  FitSettings s;
  s.components = EffectSet{Effect::dd, Effect::udf};
  const FitResult whole = fit(scan, s);
  s.terms.shadowing = ShadowingTier::none;
  s.terms.effective_roughness = EffectiveRoughnessTier::none;
  const FitResult bare = fit(scan, s);
  EXPECT_NEAR(*bare.material.surface.slope / 0.136, 1.0, 0.015);
  for (const MaterialChannel& c : bare.material.channels) EXPECT_NEAR(*c.coefficient(Coefficient::k_dd), 0.20, 0.01);
  EXPECT_NEAR(std::sqrt(bare.loss / whole.loss), 5.0, 0.5);  // the RMS error
}

// Their smooth sample: sigma 0.23, tau 9.9 printed, from 0.23 and 10.4.
TEST(PublishedTable, OfSmoothAluminiumIsReproducedFromHeTorrance) {
  Material truth = test::with_surface(test::smooth_aluminium_45(), 0.23, 10.4);
  truth.terms = test::he_torrance_terms();
  const Scan scan = simulate(truth, Sampling::incidence_plane, {0.0, 0.0}, 1);
  FitSettings s;
  s.components = truth.components;
  s.parameters["k_dd"].value = 1.0;
  const FitResult r = fit(scan, s);
  EXPECT_NEAR(*r.material.surface.sigma_um, 0.236, 0.004);
  EXPECT_NEAR(*r.material.surface.tau_um, 9.95, 0.3);
  EXPECT_NEAR(*r.material.surface.tau_um / 9.9, 1.0, 0.03);
}

TEST(Anisotropy, InPlaneReadingsAtOneAzimuthDoNotDetermineTheSecondSlope) {
  const Material truth = test::brushed_aluminium();
  const FitSettings s = settings_of(truth);
  const FitResult one = fit(simulate(truth, Sampling::incidence_plane, {0.01, 0.0}, 2, false, {0.0}), s);
  EXPECT_FALSE(one.material.surface.slope_y);
  EXPECT_FALSE(one.material.fit->identifiable.at("slope_y"));
  const bool said = std::any_of(one.warnings.begin(), one.warnings.end(), [](const std::string& w) {
    return w.find("slope_y is not determined") != std::string::npos;
  });
  EXPECT_TRUE(said);
  const FitResult three = fit(simulate(truth, Sampling::incidence_plane, {0.01, 0.0}, 2, false, {0.0, 45.0, 90.0}), s);
  ASSERT_TRUE(three.material.surface.slope_y);
  EXPECT_NEAR(*three.material.surface.slope_y / 0.02, 1.0, 0.01);
}

// A surface so rough that wave optics leaves no trace: sigma is not determined, and not invented.
TEST(HeTorrance, LeavesSigmaOpenInTheRoughLimit) {
  Material truth = test::with_surface(test::ground_glass_41(), 60.0, 300.0);
  truth.terms = test::he_torrance_terms();
  truth.channels.resize(1);
  const Scan scan = simulate(truth, Sampling::incidence_plane, {0.02, 0.0}, 3);
  const FitResult r = fit(scan, settings_of(truth));
  EXPECT_NEAR(*r.material.surface.slope, 0.2, 0.004);
  EXPECT_FALSE(r.material.surface.sigma_um);
  EXPECT_FALSE(r.material.surface.tau_um);
  EXPECT_EQ(r.material.terms.distribution, DistributionTier::rough_limit);
}

// Random materials of the models of several shape parameters: never another minimum than the truth's, or a better one.
TEST(GlobalSearch, FindsTheMinimumOfManyShapeParameters) {
  std::mt19937_64 random(11);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const auto decades = [&](double a, double b) { return std::exp(uniform(std::log(a), std::log(b))); };
  int worse = 0;
  constexpr int trials = 60;
  for (int trial = 0; trial < trials; ++trial) {
    Material m = trial % 2 == 0 ? test::laser_paper_73() : test::ground_glass_41();
    m.channels.resize(1);
    m.surface = {.slope = decades(0.01, 0.6)};
    for (std::optional<double>& k : m.channels[0].k) {
      if (k.value_or(0.0) != 0.0) k = uniform(0.1, 1.0);
    }
    const int kind = trial % 5;
    if (kind == 0 || kind == 4) m.surface.slope_y = decades(0.01, 0.6);
    if (kind == 1 || kind == 4) {
      m.terms.distribution = DistributionTier::student_t;
      m.surface.tail = 1.0 + decades(0.3, 30.0);
    }
    if (kind == 2) {
      m.terms = test::he_torrance_terms();
      m.surface.sigma_um = decades(0.05, 1.0);
    }
    if (kind == 3) {
      m.components.insert(Effect::rough);
      m.surface.facet_slope_deg = uniform(5.0, 45.0);
      m.channels[0].coefficient(Coefficient::rho) = uniform(0.1, 0.9);
    }
    const Scan scan = simulate(m, Sampling::incidence_plane, {0.02, 0.0}, static_cast<std::uint64_t>(trial));
    const double reachable = polish_from(scan, settings_of(m), m).loss;
    const FitResult r = fit(scan, settings_of(m));
    // A surface in its rough limit is answered by that.
    if (r.material.terms.distribution != m.terms.distribution) continue;
    if (r.loss > reachable * (1.0 + 1e-6)) {
      ++worse;
      ADD_FAILURE() << "trial " << trial << ": loss " << r.loss << " where " << reachable
                    << " is reached from the truth";
    }
  }
  RecordProperty("wrong_minima", worse);
}

}  // namespace
}  // namespace goniofit
