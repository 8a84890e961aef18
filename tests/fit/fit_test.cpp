#include "fit/fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "brdf/evaluator.h"
#include "support/error.h"
#include "support/error_message.h"
#include "support/materials.h"
#include "synthetic/simulate.h"

namespace goniofit {
namespace {

using test::error_message;

FitSettings settings_for(const Material& truth) {
  FitSettings s;
  s.components = truth.components;
  s.terms = truth.terms;
  s.forms.fs = truth.forms.fs;
  return s;
}

const FittedParameter& parameter(const FitResult& r, const std::string& name, const std::string& channel = "") {
  const auto it = std::find_if(r.parameters.begin(), r.parameters.end(),
                               [&](const FittedParameter& p) { return p.name == name && p.channel == channel; });
  if (it == r.parameters.end()) throw std::runtime_error("no parameter " + channel + "." + name);
  return *it;
}

void expect_recovered(const FitResult& r, const Material& truth, double tolerance) {
  ASSERT_TRUE(r.converged) << truth.name;
  EXPECT_NEAR(*r.material.surface.slope / *truth.surface.slope, 1.0, tolerance) << truth.name;
  for (std::size_t c = 0; c < truth.channels.size(); ++c) {
    for (const FittedParameter& p : r.parameters) {
      if (p.channel != truth.channels[c].name || p.name[0] != 'k') continue;
      const double expected = *truth.channels[c].coefficient(*parse_name<Coefficient>(p.name));
      EXPECT_NEAR(*p.value, expected, tolerance * std::max(1.0, expected))
          << truth.name << " " << p.channel << " " << p.name;
    }
  }
}

TEST(Fit, NoiseFreeScansGiveBackTheirParameters) {
  for (const Material& truth : {test::garnet_red_paint_13(), test::laser_paper_73(), test::ground_glass_41()}) {
    for (const Sampling sampling : {Sampling::hemisphere, Sampling::incidence_plane}) {
      const FitResult r = fit(simulate(truth, sampling, {0.0, 0.0}, 1), settings_for(truth));
      expect_recovered(r, truth, 1e-8);
    }
  }
}

TEST(Fit, VariantsOfTheModelAreRecoveredToo) {
  Material m = test::laser_paper_73();
  m.forms.fs = FsForm::reciprocal;
  expect_recovered(fit(simulate(m, Sampling::hemisphere, {0, 0}, 1), settings_for(m)), m, 1e-8);
  m.terms.fresnel = FresnelTier::exact;
  expect_recovered(fit(simulate(m, Sampling::hemisphere, {0, 0}, 1), settings_for(m)), m, 1e-8);
  m = test::ground_glass_41();
  m.terms.shadowing = ShadowingTier::none;
  expect_recovered(fit(simulate(m, Sampling::hemisphere, {0, 0}, 1), settings_for(m)), m, 1e-8);
  m.terms.effective_roughness = EffectiveRoughnessTier::none;
  expect_recovered(fit(simulate(m, Sampling::hemisphere, {0, 0}, 1), settings_for(m)), m, 1e-8);
  m.terms.fresnel = FresnelTier::none;
  expect_recovered(fit(simulate(m, Sampling::hemisphere, {0, 0}, 1), settings_for(m)), m, 1e-8);
}

TEST(Fit, CoherentPartDeterminesSigmaAndTau) {
  const Material truth = test::smooth_aluminium_45();
  for (const Sampling sampling : {Sampling::incidence_plane, Sampling::hemisphere}) {
    const FitResult r = fit(simulate(truth, sampling, {0.0, 0.0}, 1), settings_for(truth));
    expect_recovered(r, truth, 1e-7);
    EXPECT_NEAR(*r.material.surface.sigma_um, 0.23, 1e-7);
    EXPECT_NEAR(*r.material.surface.tau_um, 9.9, 1e-5);
    EXPECT_TRUE(r.material.fit->identifiable.at("sigma_um"));
  }
}

TEST(Fit, WithoutCoherenceSigmaAndTauStayUnknown) {
  const Material truth = test::garnet_red_paint_13();
  const FitResult r = fit(simulate(truth, Sampling::hemisphere, {0.02, 0.0}, 5), settings_for(truth));
  EXPECT_FALSE(r.material.surface.sigma_um);
  EXPECT_FALSE(r.material.surface.tau_um);
  EXPECT_FALSE(r.material.fit->identifiable.at("sigma_um"));
  EXPECT_FALSE(r.material.fit->identifiable.at("tau_um"));
  EXPECT_TRUE(r.material.fit->identifiable.at("slope"));
  EXPECT_TRUE(std::any_of(r.notes.begin(), r.notes.end(),
                          [](const std::string& n) { return n.find("neither is determined alone") != n.npos; }));
}

TEST(Fit, AMeasuredSigmaGivesTauWithItsUncertainty) {
  const Material truth = test::garnet_red_paint_13();
  FitSettings s = settings_for(truth);
  s.parameters["sigma_um"].value = 0.70;
  const FitResult r = fit(simulate(truth, Sampling::hemisphere, {0.02, 0.0}, 5), s);
  EXPECT_EQ(r.material.surface.sigma_um, 0.70);
  const FittedParameter& tau = parameter(r, "tau_um");
  EXPECT_TRUE(tau.derived);
  EXPECT_NEAR(*tau.value, 0.70 / *r.material.surface.slope, 1e-12);
  const FittedParameter& slope = parameter(r, "slope");
  EXPECT_NEAR(*tau.u / *tau.value, *slope.u / *slope.value, 1e-10);
  EXPECT_NO_THROW(validate(r.material, "fitted"));
}

TEST(Fit, FixedAndBoundedParametersAreKept) {
  const Material truth = test::laser_paper_73();
  const Scan scan = simulate(truth, Sampling::hemisphere, {0.02, 0.0}, 6);
  FitSettings s = settings_for(truth);
  s.parameters["k_fs"].value = 0.0;
  s.parameters["R.k_dd"].max = 0.2;
  s.parameters["slope"].min = 0.08;
  s.parameters["slope"].max = 0.12;
  const FitResult r = fit(scan, s);
  for (const char* channel : {"R", "G", "B"}) {
    EXPECT_EQ(*parameter(r, "k_fs", channel).value, 0.0);
    EXPECT_TRUE(parameter(r, "k_fs", channel).fixed);
    EXPECT_FALSE(parameter(r, "k_fs", channel).u);
  }
  EXPECT_EQ(*parameter(r, "k_dd", "R").value, 0.2);
  EXPECT_TRUE(parameter(r, "k_dd", "R").at_upper);
  EXPECT_FALSE(parameter(r, "k_dd", "R").u);
  EXPECT_EQ(*parameter(r, "slope").value, 0.08);
  EXPECT_TRUE(parameter(r, "slope").at_lower);
  EXPECT_FALSE(r.warnings.empty());
}

TEST(Fit, FreeOpticsAreFoundPerChannel) {
  Material truth = test::garnet_red_paint_13();
  truth.channels[0].n = 1.45;
  truth.channels[2].n = 2.1;
  const Scan scan = simulate(truth, Sampling::hemisphere, {0.0, 0.0}, 1);
  FitSettings s = settings_for(truth);
  s.free_optics = FreeOptics::n;
  FitResult r = fit(scan, s);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(*r.material.channels[c].n, *truth.channels[c].n, 1e-6);
  s.free_optics = FreeOptics::f0;
  r = fit(scan, s);
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(*r.material.channels[c].f0, truth.channels[c].normal_reflectance(), 1e-7);
}

// MODEL's table: the paper's paint and paper from their own parameters, with noise.
TEST(Fit, PapersSamplesComeBackFromNoisyScans) {
  for (const Material& truth : {test::garnet_red_paint_13(), test::laser_paper_73(), test::ground_glass_41()}) {
    const FitResult r = fit(simulate(truth, Sampling::hemisphere, {0.02, 0.0}, 13), settings_for(truth));
    ASSERT_TRUE(r.converged);
    EXPECT_NEAR(*r.material.surface.slope / *truth.surface.slope, 1.0, 0.01) << truth.name;
    for (const FittedParameter& p : r.parameters) {
      if (p.channel.empty() || !p.u) continue;
      const auto channel = std::find_if(truth.channels.begin(), truth.channels.end(),
                                        [&](const MaterialChannel& c) { return c.name == p.channel; });
      const double expected = *channel->coefficient(*parse_name<Coefficient>(p.name));
      EXPECT_LT(std::fabs(*p.value - expected), 5.0 * *p.u + 0.01) << truth.name << " " << p.channel << " " << p.name;
    }
  }
}

TEST(Fit, LossIsThePapersSum) {
  const Material truth = test::laser_paper_73();
  const Scan scan = simulate(truth, Sampling::incidence_plane, {0.05, 0.0}, 2);
  const FitResult r = fit(scan, settings_for(truth));
  const Evaluator e(r.material);
  double loss = 0.0;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Pair p = make_pair(scan.angles(i));
    for (std::size_t c = 0; c < 3; ++c) {
      const double difference = e.value(p, c) - scan.channels[c].values[i];
      loss += p.cos_i * difference * difference;
    }
  }
  EXPECT_NEAR(r.loss, loss, 1e-10 * loss);
  EXPECT_NEAR(r.rms, std::sqrt(loss / (3.0 * static_cast<double>(scan.size()))), 1e-12);
}

TEST(Fit, DoesNotDependOnTheOrderOfReadings) {
  const Material truth = test::garnet_red_paint_13();
  const Scan scan = simulate(truth, Sampling::hemisphere, {0.02, 0.0}, 8);
  std::vector<std::size_t> order(scan.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), std::mt19937_64(5));
  Scan shuffled = scan;
  for (std::size_t i = 0; i < order.size(); ++i) {
    shuffled.theta_i_deg[i] = scan.theta_i_deg[order[i]];
    shuffled.phi_i_deg[i] = scan.phi_i_deg[order[i]];
    shuffled.theta_r_deg[i] = scan.theta_r_deg[order[i]];
    shuffled.phi_r_deg[i] = scan.phi_r_deg[order[i]];
    for (std::size_t c = 0; c < 3; ++c) shuffled.channels[c].values[i] = scan.channels[c].values[order[i]];
  }
  const FitResult a = fit(scan, settings_for(truth));
  const FitResult b = fit(shuffled, settings_for(truth));
  EXPECT_NEAR(a.loss / b.loss, 1.0, 1e-12);
  EXPECT_NEAR(*a.material.surface.slope / *b.material.surface.slope, 1.0, 1e-8);
  const FitResult again = fit(scan, settings_for(truth));
  EXPECT_EQ(a.loss, again.loss);
  EXPECT_EQ(a.material.surface.slope, again.material.surface.slope);
}

TEST(Fit, ExcludesAndCounts) {
  Scan scan = simulate(test::laser_paper_73(), Sampling::incidence_plane, {0.0, 0.0}, 2);
  const std::size_t all = scan.size();
  scan.theta_r_deg[0] = 90.0;
  scan.channels[0].values[1] = -0.001;
  FitSettings s;
  s.max_theta_deg = 70.0;
  const FitResult r = fit(scan, s);
  EXPECT_EQ(r.left_out.at_90, 1U);
  EXPECT_GT(r.left_out.beyond_max_theta, 0U);
  EXPECT_EQ(r.samples + r.left_out.at_90 + r.left_out.beyond_max_theta, all);
  EXPECT_TRUE(r.components_were_auto);
  ASSERT_TRUE(r.selection);
  EXPECT_EQ(r.material.components, r.selection->chosen());
}

TEST(Fit, LambertianScanHasNoSlope) {
  Material truth = test::laser_paper_73();
  truth.components = {Effect::udf};
  for (MaterialChannel& c : truth.channels) c.coefficient(Coefficient::k_udf) = 0.5;
  FitSettings s;
  s.components = EffectSet{Effect::dd, Effect::udf};
  const FitResult r = fit(simulate(truth, Sampling::hemisphere, {0.0, 0.0}, 2), s);
  EXPECT_FALSE(r.material.surface.slope);
  EXPECT_FALSE(r.material.fit->identifiable.at("slope"));
  EXPECT_NEAR(*parameter(r, "k_udf", "R").value, 0.5, 1e-10);
  EXPECT_TRUE(std::any_of(r.warnings.begin(), r.warnings.end(),
                          [](const std::string& w) { return w.find("slope is not determined") != w.npos; }));
  EXPECT_NO_THROW(validate(r.material, "fitted"));
}

TEST(Fit, CoherenceThatTheScanCannotSeeIsLeftOut) {
  const Material truth = test::smooth_aluminium_45();
  Scan scan = simulate(truth, Sampling::incidence_plane, {0.01, 0.0}, 2);
  // A rougher surface: e^(-g) is nothing.
  Material rough = test::ground_glass_41();
  rough.components = {Effect::dd, Effect::udf};
  FitSettings s;
  s.components = EffectSet{Effect::coh, Effect::dd, Effect::udf};
  const FitResult r = fit(simulate(rough, Sampling::incidence_plane, {0.0, 0.0}, 2), s);
  EXPECT_FALSE(r.material.components.has(Effect::coh));
  EXPECT_FALSE(r.material.surface.sigma_um);
  // No mirror reading at all.
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const bool forward = scan.phi_r_deg[i] == 180.0;
    if (forward && std::fabs(scan.theta_r_deg[i] - scan.theta_i_deg[i]) < 1.5)
      scan.theta_r_deg[i] = scan.theta_i_deg[i] + 1.5;
  }
  s.components = truth.components;
  const FitResult without = fit(scan, s);
  EXPECT_FALSE(without.material.components.has(Effect::coh));
  EXPECT_TRUE(std::any_of(without.warnings.begin(), without.warnings.end(),
                          [](const std::string& w) { return w.find("coh was left out") != w.npos; }));
}

TEST(Fit, ContradictionsAreNamed) {
  const Scan scan = simulate(test::laser_paper_73(), Sampling::incidence_plane, {0.0, 0.0}, 2);
  const auto message = [&](const std::function<void(FitSettings&)>& change) {
    FitSettings s;
    change(s);
    return error_message([&] { (void)fit(scan, s); });
  };
  EXPECT_EQ(message([](FitSettings& s) { s.parameters["k_dx"].value = 1.0; }).substr(0, 25),
            "2 parameter k_dx: no such");
  EXPECT_NE(
      message([](FitSettings& s) { s.parameters["X.k_dd"].value = 1.0; }).find("no such channel, the scan has R, G, B"),
      std::string::npos);
  EXPECT_NE(message([](FitSettings& s) { s.parameters["R.slope"].value = 0.1; }).find("shared by all channels"),
            std::string::npos);
  EXPECT_NE(
      message([](FitSettings& s) { s.parameters["slope"].value = 20.0; }).find("out of range, expected [0.0001, 10]"),
      std::string::npos);
  EXPECT_NE(message([](FitSettings& s) {
              s.parameters["k_dd"] = {std::nullopt, 0.8, 0.2};
            }).find("above upper bound"),
            std::string::npos);
  EXPECT_NE(message([](FitSettings& s) {
              s.n = {1.5, 1.6};
            }).find("2 values given, expected one or one for each of the 3"),
            std::string::npos);
  EXPECT_NE(message([](FitSettings& s) { s.max_theta_deg = 3.0; }).find("no reading is left to fit"),
            std::string::npos);
  EXPECT_NE(message([](FitSettings& s) {
              s.components = EffectSet{Effect::dd, Effect::uds};
              s.parameters["sigma_um"].max = 3.0;
            }).find("bounds have no meaning without coh"),
            std::string::npos);
  EXPECT_NE(message([](FitSettings& s) {
              s.parameters["sigma_um"].value = 1.0;
              s.parameters["tau_um"].value = 10.0;
              s.parameters["slope"].value = 0.2;
            }).find("another value than sigma_um / tau_um"),
            std::string::npos);
  EXPECT_NE(message([](FitSettings& s) {
              s.terms.fresnel = FresnelTier::exact;
              s.f0 = {0.04};
            }).find("the exact Fresnel term needs n"),
            std::string::npos);
}

}  // namespace
}  // namespace goniofit
