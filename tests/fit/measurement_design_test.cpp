// The angles that a fit asks for: what is promised of them is what they bring.

#include "fit/measurement_design.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "brdf/evaluator.h"
#include "fit/fit.h"
#include "support/materials.h"
#include "synthetic/simulate.h"

namespace goniofit {
namespace {

constexpr double noise = 0.02;

// Readings of `truth` at more directions, appended to the scan.
void measure(Scan& scan, const Material& truth, const std::vector<AnglePair>& directions, unsigned seed) {
  const Evaluator evaluator(truth);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  for (const AnglePair& a : directions) {
    scan.theta_i_deg.push_back(a.theta_i_deg);
    scan.phi_i_deg.push_back(a.phi_i_deg);
    scan.theta_r_deg.push_back(a.theta_r_deg);
    scan.phi_r_deg.push_back(a.phi_r_deg);
    for (std::size_t c = 0; c < scan.channels.size(); ++c) {
      scan.channels[c].values.push_back(evaluator.value(make_pair(a), c) * (1.0 + noise * normal(random)));
    }
  }
}

Scan up_to(const Scan& scan, double theta_i_deg) {
  Scan out = scan;
  out.theta_i_deg.clear(), out.phi_i_deg.clear(), out.theta_r_deg.clear(), out.phi_r_deg.clear();
  for (ScanChannel& c : out.channels) c.values.clear();
  for (std::size_t row = 0; row < scan.size(); ++row) {
    if (scan.theta_i_deg[row] > theta_i_deg) continue;
    out.theta_i_deg.push_back(scan.theta_i_deg[row]);
    out.phi_i_deg.push_back(scan.phi_i_deg[row]);
    out.theta_r_deg.push_back(scan.theta_r_deg[row]);
    out.phi_r_deg.push_back(scan.phi_r_deg[row]);
    for (std::size_t c = 0; c < out.channels.size(); ++c)
      out.channels[c].values.push_back(scan.channels[c].values[row]);
  }
  return out;
}

FitSettings of(EffectSet components) {
  FitSettings s;
  s.components = components;
  return s;
}

const FittedParameter& parameter(const FitResult& r, const std::string& name, const std::string& channel) {
  return *std::find_if(r.parameters.begin(), r.parameters.end(),
                       [&](const FittedParameter& p) { return p.name == name && p.channel == channel; });
}

// Root mean square over seeds of the uncertainty that a fit states once the angles were measured.
double stated_after(const Material& truth, const Scan& scan, const FitSettings& settings,
                    const MeasurementDesign& design, const DesignOption& option) {
  double sum = 0.0;
  constexpr unsigned seeds = 5;
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    Scan more = scan;
    for (const double theta : option.theta_i_deg) measure(more, truth, candidate_directions(scan, theta), seed);
    const FitResult r = fit(more, settings);
    const double u = parameter(r, design.name, design.channel).u.value_or(0.0);
    sum += u * u / seeds;
  }
  return std::sqrt(sum);
}

TEST(MeasurementDesign, WhatItPromisesOfForwardScatteringIsWhatComes) {
  const Material truth = test::garnet_red_paint_13();
  for (const Sampling sampling : {Sampling::hemisphere, Sampling::incidence_plane}) {
    const Scan scan = up_to(simulate(truth, sampling, {noise, 0.0}, 3), 20.0);
    const FitSettings settings = of(truth.components);
    FitResult r = fit(scan, settings);
    add_measurement_design(r, scan, settings);
    ASSERT_TRUE(r.design);
    EXPECT_EQ(r.design->name, "k_fs");
    ASSERT_EQ(r.design->options.size(), 2U);
    for (const DesignOption& single : r.design->singles) EXPECT_LE(r.design->options[0].u, single.u);
    EXPECT_EQ(r.design->singles.size(), candidate_angles().size());
    for (const DesignOption& option : r.design->options) {
      const double stated = stated_after(truth, scan, settings, *r.design, option);
      EXPECT_NEAR(stated / option.u, 1.0, 0.3) << design_sentence(*r.design);
    }
    EXPECT_LT(r.design->options[1].u, r.design->options[0].u);
    EXPECT_NE(design_sentence(*r.design).find("too would bring k_fs of " + r.design->channel), std::string::npos);
  }
}

TEST(MeasurementDesign, TellsTheDiffuseEffectsApart) {
  Material truth = test::laser_paper_73();
  truth.components = {Effect::dd, Effect::udf, Effect::uds};
  for (MaterialChannel& c : truth.channels) {
    c.coefficient(Coefficient::k_udf) = 0.2;
    c.coefficient(Coefficient::k_uds) = 0.3;
  }
  const Scan scan = up_to(simulate(truth, Sampling::incidence_plane, {noise, 0.0}, 5), 30.0);
  const FitSettings settings = of(truth.components);
  FitResult r = fit(scan, settings);
  add_measurement_design(r, scan, settings);
  ASSERT_TRUE(r.design);
  EXPECT_GE(r.design->options[0].theta_i_deg.front(), 60.0);
  EXPECT_NEAR(stated_after(truth, scan, settings, *r.design, r.design->options[0]) / r.design->options[0].u, 1.0, 0.3);
}

TEST(MeasurementDesign, HasNothingToSayOfWhatIsWellKnown) {
  const Material truth = test::ground_glass_41();
  const Scan scan = simulate(truth, Sampling::hemisphere, {noise, 0.0}, 1);
  const FitSettings settings = of(truth.components);
  FitResult r = fit(scan, settings);
  add_measurement_design(r, scan, settings);
  ASSERT_TRUE(r.design);
  EXPECT_FALSE(r.design->worth_saying);
  const FittedParameter& p = parameter(r, r.design->name, r.design->channel);
  EXPECT_NEAR(r.design->u / *p.u, 1.0, 0.3);  // the present scan, by the same reckoning
}

TEST(MeasurementDesign, RepeatsTheScansOwnSweep) {
  const Scan plane = simulate(test::smooth_aluminium_45(), Sampling::incidence_plane, {}, 1);
  const std::vector<AnglePair> sweep = candidate_directions(plane, 50.0);
  EXPECT_GE(sweep.size(), 40U);
  EXPECT_TRUE(std::any_of(sweep.begin(), sweep.end(), [](const AnglePair& a) {
    return a.theta_i_deg == 50.0 && a.theta_r_deg == 50.0 && a.phi_r_deg == 180.0;
  }));
  const Scan hemisphere = simulate(test::ground_glass_41(), Sampling::hemisphere, {}, 1);
  EXPECT_EQ(candidate_directions(hemisphere, 50.0).size(), 441U);
}

}  // namespace
}  // namespace goniofit
