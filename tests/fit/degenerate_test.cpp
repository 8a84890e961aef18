// Scans that cannot determine what is asked of them: each fit has to end, in numbers that are finite or absent, with
// the right words, and with nothing stated that the scan does not hold.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "fit/fit.h"
#include "support/materials.h"
#include "synthetic/simulate.h"

namespace goniofit {
namespace {

FitSettings with(const EffectSet& components) {
  FitSettings s;
  s.components = components;
  return s;
}

const EffectSet dd_udf{Effect::dd, Effect::udf};
const EffectSet dd_uds_fs{Effect::dd, Effect::uds, Effect::fs};

Scan readings_where(const Scan& scan, const std::function<bool(std::size_t)>& wanted) {
  Scan out = scan;
  const auto keep = [&](std::vector<double>& column) {
    std::vector<double> kept;
    for (std::size_t row = 0; row < column.size(); ++row) {
      if (wanted(row)) kept.push_back(column[row]);
    }
    column = std::move(kept);
  };
  for (auto* column : {&out.theta_i_deg, &out.phi_i_deg, &out.theta_r_deg, &out.phi_r_deg}) keep(*column);
  for (ScanChannel& c : out.channels) keep(c.values);
  return out;
}

const FittedParameter& parameter(const FitResult& r, const std::string& name, const std::string& channel = "") {
  const auto it = std::find_if(r.parameters.begin(), r.parameters.end(),
                               [&](const FittedParameter& p) { return p.name == name && p.channel == channel; });
  if (it == r.parameters.end()) throw std::runtime_error("no parameter " + channel + "." + name);
  return *it;
}

bool says(const std::vector<std::string>& sentences, const std::string& words) {
  return std::any_of(sentences.begin(), sentences.end(),
                     [&](const std::string& s) { return s.find(words) != std::string::npos; });
}

// What holds of every fit: no number that is none, no uncertainty where it means nothing, and a valid material.
void expect_sound(const FitResult& r) {
  EXPECT_TRUE(std::isfinite(r.loss));
  for (const FittedParameter& p : r.parameters) {
    SCOPED_TRACE(p.channel + "." + p.name);
    if (p.value) {
      EXPECT_TRUE(std::isfinite(*p.value));
    }
    if (p.u) {
      EXPECT_TRUE(p.value && std::isfinite(*p.u) && *p.u >= 0.0);
      EXPECT_FALSE(p.fixed || p.at_lower || p.at_upper);
    }
    EXPECT_EQ(p.u_classical.has_value(), p.u.has_value());
    if (p.at_lower) {
      EXPECT_EQ(p.value.value_or(p.lower), p.lower);
    }
    if (p.at_upper) {
      EXPECT_EQ(p.value.value_or(p.upper), p.upper);
    }
  }
  EXPECT_NO_THROW(validate(r.material, "fitted"));
}

Scan lambertian(double noise) {
  Material m = test::ground_glass_41();
  m.components = {Effect::udf};
  m.surface = {};
  return simulate(m, Sampling::hemisphere, {noise, 0.0}, 1);
}

TEST(Degenerate, LambertianScanHasNoLobe) {
  const FitResult r = fit(lambertian(0.0), with(dd_udf));
  expect_sound(r);
  EXPECT_FALSE(parameter(r, "slope").value);
  EXPECT_TRUE(says(r.warnings, "slope is not determined"));
  for (const char* channel : {"R", "G", "B"}) {
    EXPECT_EQ(parameter(r, "k_dd", channel).value.value_or(0.0), 0.0);
    EXPECT_FALSE(parameter(r, "k_dd", channel).u);
    EXPECT_TRUE(parameter(r, "k_udf", channel).u);
  }
}

// Under noise the fit finds some lobe in it; what it states of the lobe's strength has to include none.
TEST(Degenerate, LobeOfALambertianScansNoiseIsWithinItsUncertainty) {
  const FitResult r = fit(lambertian(0.02), with(dd_udf));
  expect_sound(r);
  for (const char* channel : {"R", "G", "B"}) {
    const FittedParameter& k = parameter(r, "k_dd", channel);
    EXPECT_LE(k.value.value_or(0.0), 3.0 * k.u.value_or(0.0));
    EXPECT_LT(k.value.value_or(0.0), 1e-3);
  }
}

TEST(Degenerate, OneIncidenceStillTellsTheLobe) {
  const Material truth = test::ground_glass_41();
  const Scan scan = simulate(truth, Sampling::hemisphere, {0.02, 0.0}, 2);
  const FitResult r =
      fit(readings_where(scan, [&](std::size_t row) { return scan.theta_i_deg[row] == 10.0; }), with(dd_udf));
  expect_sound(r);
  const FittedParameter& slope = parameter(r, "slope");
  EXPECT_NEAR(*slope.value, *truth.surface.slope, 4.0 * *slope.u);
  EXPECT_TRUE(says(r.notes, "neither is determined alone"));
}

// k_dd alone of one incidence and one direction: two unknowns that only occur together.
TEST(Degenerate, OneReadingDeterminesNoLobe) {
  const Scan scan = simulate(test::ground_glass_41(), Sampling::hemisphere, {0.0, 0.0}, 2);
  const FitResult r = fit(readings_where(scan, [](std::size_t row) { return row == 200; }), with(dd_udf));
  expect_sound(r);
  for (const FittedParameter& p : r.parameters) EXPECT_FALSE(p.u) << p.channel << "." << p.name;
}

TEST(Degenerate, MetalLetsNoLightBelowItsSurface) {
  const Scan scan = simulate(test::ground_glass_41(), Sampling::hemisphere, {0.02, 0.0}, 2);
  const FitResult r = fit(scan, with(dd_uds_fs));
  expect_sound(r);
  for (const char* channel : {"R", "G", "B"}) {
    EXPECT_TRUE(parameter(r, "k_uds", channel).at_upper);
    EXPECT_TRUE(parameter(r, "k_fs", channel).at_lower);
  }
  EXPECT_TRUE(says(r.warnings, "on the upper bound: k_uds of every channel"));
  EXPECT_TRUE(says(r.notes, "on the lower bound: k_fs of every channel"));
}

TEST(Degenerate, DarkChannelLeavesTheOthersAlone) {
  const Scan scan = simulate(test::ground_glass_41(), Sampling::hemisphere, {0.02, 0.0}, 2);
  Scan dark = scan;
  std::fill(dark.channels[1].values.begin(), dark.channels[1].values.end(), 0.0);
  const FitResult r = fit(dark, with(dd_udf));
  expect_sound(r);
  EXPECT_EQ(parameter(r, "k_dd", "G").value, 0.0);
  EXPECT_EQ(parameter(r, "k_udf", "G").value, 0.0);
  EXPECT_FALSE(parameter(r, "k_dd", "G").u || parameter(r, "k_udf", "G").u);
  EXPECT_TRUE(says(r.notes, "on the lower bound: k_dd of G, k_udf of G"));
  // The dark channel's readings say nothing, so what the others say is what they say alone.
  const FitResult alone = fit(select_channels(scan, {"R", "B"}), with(dd_udf));
  for (const FittedParameter& p : alone.parameters) {
    if (!p.u) continue;
    EXPECT_NEAR(*parameter(r, p.name, p.channel).value / *p.value, 1.0, 1e-7) << p.name;
    EXPECT_NEAR(*parameter(r, p.name, p.channel).u / *p.u, 1.0, 1e-5) << p.name;
  }
}

TEST(Degenerate, DarkScanHasNothing) {
  Scan dark = simulate(test::ground_glass_41(), Sampling::hemisphere, {0.0, 0.0}, 2);
  for (ScanChannel& c : dark.channels) std::fill(c.values.begin(), c.values.end(), 0.0);
  const FitResult r = fit(dark, with(dd_udf));
  expect_sound(r);
  EXPECT_FALSE(parameter(r, "slope").value);
  EXPECT_TRUE(says(r.warnings, "slope is not determined"));
  for (const FittedParameter& p : r.parameters) {
    EXPECT_EQ(p.value.value_or(0.0), 0.0) << p.name;
    EXPECT_FALSE(p.u) << p.name;
  }
}

// A detector that saturates at a tenth of the peak: the lobe's strength is wrong, and HC3 says by much, where the
// classical form, which takes the clipped peak for a few readings among thousands, does not.
TEST(Degenerate, SaturatedChannelIsNotStatedAsExact) {
  const Material truth = test::ground_glass_41();
  Scan scan = simulate(truth, Sampling::hemisphere, {0.02, 0.0}, 2);
  std::vector<double>& red = scan.channels[0].values;
  const double limit = 0.1 * *std::max_element(red.begin(), red.end());
  for (double& value : red) value = std::min(value, limit);
  const FitResult r = fit(scan, with(dd_udf));
  expect_sound(r);
  const FittedParameter& k = parameter(r, "k_dd", "R");
  EXPECT_LT(*k.value, 0.8 * *truth.channels[0].coefficient(Coefficient::k_dd));
  EXPECT_GT(*k.u, 10.0 * *k.u_classical);
  const FittedParameter& slope = parameter(r, "slope");
  EXPECT_NEAR(*slope.value, *truth.surface.slope, 3.0 * *slope.u);
}

TEST(Degenerate, ForwardScatterNeedsGrazingReadings) {
  const Scan scan = simulate(test::garnet_red_paint_13(), Sampling::hemisphere, {0.02, 0.0}, 3);
  const Scan steep = readings_where(
      scan, [&](std::size_t row) { return std::max(scan.theta_i_deg[row], scan.theta_r_deg[row]) <= 45.0; });
  const FitResult r = fit(steep, with(dd_uds_fs));
  expect_sound(r);
  for (const char* channel : {"R", "G", "B"}) {
    const FittedParameter& k = parameter(r, "k_fs", channel);
    // On its bound, unknown, or known to nothing: never a number with an uncertainty to trust.
    EXPECT_TRUE(k.at_lower || !k.value || *k.u > 0.3 * *k.value) << channel;
  }
}

TEST(Degenerate, CoherenceNeedsMirrorReadings) {
  const Scan scan = simulate(test::smooth_aluminium_45(), Sampling::incidence_plane, {0.02, 0.0}, 4);
  const Scan off = readings_where(
      scan, [&](std::size_t row) { return std::fabs(scan.theta_i_deg[row] - scan.signed_theta_r_deg(row)) > 3.0; });
  const FitResult r = fit(off, with({Effect::coh, Effect::dd}));
  expect_sound(r);
  EXPECT_FALSE(r.material.components.has(Effect::coh));
  EXPECT_FALSE(parameter(r, "sigma_um").value || parameter(r, "tau_um").value);
  EXPECT_TRUE(says(r.warnings, "coh was left out"));
}

}  // namespace
}  // namespace goniofit
