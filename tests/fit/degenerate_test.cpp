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

// Not determined: no value, no uncertainty, and the material says so.
void expect_undetermined(const FitResult& r, const std::string& name, const std::string& channel = "") {
  const FittedParameter& p = parameter(r, name, channel);
  EXPECT_FALSE(p.value || p.u || p.identifiable) << channel << "." << name;
  EXPECT_FALSE(r.material.fit->identifiable.at(channel.empty() ? name : channel + "." + name));
}

Material lambertian() {
  Material m = test::ground_glass_41();
  m.components = {Effect::udf};
  m.surface = {};
  return m;
}

TEST(Degenerate, LambertianScanHasNoLobe) {
  const FitResult r = fit(simulate(lambertian(), Sampling::hemisphere, {0.0, 0.0}, 1), with(dd_udf));
  expect_sound(r);
  expect_undetermined(r, "slope");
  EXPECT_TRUE(says(r.warnings, "slope is not determined"));
  for (const char* channel : {"R", "G", "B"}) {
    EXPECT_EQ(parameter(r, "k_dd", channel).value.value_or(0.0), 0.0);
    EXPECT_FALSE(parameter(r, "k_dd", channel).u);
    EXPECT_TRUE(parameter(r, "k_udf", channel).u);
  }
}

// Under noise a search finds some lobe in it, and residuals some uncertainty for its slope: neither is to be stated.
TEST(Degenerate, LobeOfALambertianScansNoiseIsNoLobe) {
  const Material truth = lambertian();
  for (const Sampling sampling : {Sampling::hemisphere, Sampling::incidence_plane}) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      SCOPED_TRACE(seed);
      const FitResult r = fit(simulate(truth, sampling, {0.02, 0.0}, seed), with(dd_udf));
      expect_sound(r);
      expect_undetermined(r, "slope");
      EXPECT_TRUE(parameter(r, "slope").has(ParameterFlag::insignificant));
      EXPECT_TRUE(says(r.warnings, "slope is not determined: no directional part (dd, fs)"));
      for (std::size_t c = 0; c < truth.channels.size(); ++c) {
        const std::string& channel = truth.channels[c].name;
        EXPECT_EQ(parameter(r, "k_dd", channel).value.value_or(0.0), 0.0);
        EXPECT_FALSE(parameter(r, "k_dd", channel).u || parameter(r, "k_dd", channel).identifiable);
        const FittedParameter& k = parameter(r, "k_udf", channel);
        EXPECT_TRUE(k.identifiable);
        EXPECT_NEAR(*k.value, *truth.channels[c].coefficient(Coefficient::k_udf), 4.0 * *k.u);
      }
    }
  }
}

// The other side of it: what stands at five standard uncertainties is not taken for noise.
TEST(Degenerate, WeakLobeIsKept) {
  std::size_t significant = 0;
  for (const double k_dd : {3e-5, 1e-4, 2e-4, 4e-4, 1e-3}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      Material truth = test::ground_glass_41();
      for (MaterialChannel& c : truth.channels) c.coefficient(Coefficient::k_dd) = k_dd;
      const Scan scan = simulate(truth, Sampling::hemisphere, {0.02, 0.0}, seed);
      FitSettings known = with(dd_udf);
      known.parameters["slope"].value = *truth.surface.slope;
      const FitResult by_slope = fit(scan, known);
      const bool stands_clear = std::any_of(by_slope.parameters.begin(), by_slope.parameters.end(), [](const auto& p) {
        return p.name == "k_dd" && p.value && p.u && *p.value > 5.0 * *p.u;
      });
      if (!stands_clear) continue;
      ++significant;
      EXPECT_TRUE(parameter(fit(scan, with(dd_udf)), "slope").value) << k_dd << " " << seed;
    }
  }
  EXPECT_GE(significant, 5U);
  EXPECT_LT(significant, 15U);  // so that the weakest kept is near the limit
}

TEST(Degenerate, OneIncidenceStillTellsTheLobe) {
  const Material truth = test::ground_glass_41();
  const Scan scan = simulate(truth, Sampling::hemisphere, {0.02, 0.0}, 2);
  const FitResult r =
      fit(readings_where(scan, [&](std::size_t row) { return scan.theta_i_deg[row] == 10.0; }), with(dd_udf));
  expect_sound(r);
  const FittedParameter& slope = parameter(r, "slope");
  EXPECT_NEAR(*slope.value, *truth.surface.slope, 4.0 * *slope.u);
  EXPECT_TRUE(says(r.notes, "sigma and tau enter only as sigma/tau: slope 0.17"));
  EXPECT_TRUE(says(r.notes, "neither is determined alone"));
  EXPECT_TRUE(says(r.diagnostics->findings, "one incidence angle only (10°)"));
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
    for (const char* name : {"k_uds", "k_fs"}) {
      expect_undetermined(r, name, channel);
      EXPECT_TRUE(parameter(r, name, channel).has(ParameterFlag::opaque));
    }
  }
  EXPECT_TRUE(says(r.warnings, "a metal lets no light below its surface (kappa of R is 7.79)"));
  EXPECT_TRUE(says(r.warnings, "k_fs of every channel, k_uds of every channel left out"));
  EXPECT_FALSE(says(r.warnings, "on the upper bound: k_uds"));
}

// All but one wavelength of a dye: what is below the surface is seen through it.
TEST(Degenerate, WeakAbsorptionIsNoMetal) {
  Scan scan = simulate(test::laser_paper_73(), Sampling::hemisphere, {0.02, 0.0}, 2);
  FitSettings s = with(dd_uds_fs);
  s.n = {1.5};
  s.kappa = {0.001};
  const FitResult r = fit(scan, s);
  EXPECT_TRUE(parameter(r, "k_uds", "R").identifiable);
  EXPECT_FALSE(says(r.warnings, "metal"));
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
  EXPECT_TRUE(says(r.warnings, "channel G is dark: all its readings are 0"));
  // The dark channel's readings say nothing, so what the others say is what they say alone.
  const FitResult alone = fit(select_channels(scan, {"R", "B"}), with(dd_udf));
  for (const FittedParameter& p : alone.parameters) {
    if (!p.u) continue;
    EXPECT_NEAR(*parameter(r, p.name, p.channel).value / *p.value, 1.0, 1e-7) << p.name;
    EXPECT_NEAR(*parameter(r, p.name, p.channel).u / *p.u, 1.0, 1e-5) << p.name;
  }
}

TEST(Degenerate, ChannelBelowZeroIsDark) {
  Scan scan = simulate(test::ground_glass_41(), Sampling::hemisphere, {0.02, 0.0}, 2);
  for (double& value : scan.channels[2].values) value = -1e-3 * value;
  const FitResult r = fit(scan, with(dd_udf));
  expect_sound(r);
  EXPECT_EQ(parameter(r, "k_dd", "B").value, 0.0);
  EXPECT_EQ(parameter(r, "k_udf", "B").value, 0.0);
  EXPECT_TRUE(says(r.warnings, "channel B is dark: none of its readings is above 0"));
  EXPECT_TRUE(parameter(r, "slope").identifiable);
}

TEST(Degenerate, DarkScanHasNothing) {
  Scan dark = simulate(test::ground_glass_41(), Sampling::hemisphere, {0.0, 0.0}, 2);
  for (ScanChannel& c : dark.channels) std::fill(c.values.begin(), c.values.end(), 0.0);
  const FitResult r = fit(dark, with(dd_udf));
  expect_sound(r);
  expect_undetermined(r, "slope");
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
  const auto clipped = std::count_if(red.begin(), red.end(), [limit](double value) { return value >= limit; });
  for (double& value : red) value = std::min(value, limit);
  const FitResult r = fit(scan, with(dd_udf));
  expect_sound(r);
  const FittedParameter& k = parameter(r, "k_dd", "R");
  EXPECT_LT(*k.value, 0.8 * *truth.channels[0].coefficient(Coefficient::k_dd));
  EXPECT_GT(*k.u, 10.0 * *k.u_classical);
  const FittedParameter& slope = parameter(r, "slope");
  EXPECT_NEAR(*slope.value, *truth.surface.slope, 5.0 * *slope.u);
  EXPECT_TRUE(says(r.diagnostics->findings, std::to_string(clipped) + " readings of R share its largest value"));
  EXPECT_TRUE(says(r.diagnostics->findings, "the detector saturated; exclude them (--exclude-saturated)"));
}

TEST(Degenerate, ForwardScatterNeedsGrazingReadings) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    const Scan scan = simulate(test::garnet_red_paint_13(), Sampling::hemisphere, {0.02, 0.0}, seed);
    const Scan steep = readings_where(
        scan, [&](std::size_t row) { return std::max(scan.theta_i_deg[row], scan.theta_r_deg[row]) <= 45.0; });
    const FitResult r = fit(steep, with(dd_uds_fs));
    expect_sound(r);
    for (const char* channel : {"R", "G", "B"}) {
      expect_undetermined(r, "k_fs", channel);
      EXPECT_TRUE(parameter(r, "k_fs", channel).has(ParameterFlag::unsupported)) << channel;
    }
    EXPECT_TRUE(says(r.warnings,
                     "k_fs of every channel is not determined: no forward reading has theta_i and theta_r "
                     "both above 39.4°, and a single one shows k_fs = 1 above the noise only from about"));
    EXPECT_TRUE(parameter(r, "slope").identifiable);
    const FitResult whole = fit(scan, with(dd_uds_fs));
    for (const char* channel : {"R", "G", "B"}) EXPECT_TRUE(parameter(whole, "k_fs", channel).identifiable);
  }
}

// Towards the normal T(cos_i) T(cos_r) is constant: udf and uds are one effect, of which only the sum is known.
TEST(Degenerate, DiffuseEffectsNeedARangeOfAngles) {
  Material truth = test::laser_paper_73();
  for (MaterialChannel& c : truth.channels) {
    c.coefficient(Coefficient::k_udf) = 0.2;
    c.coefficient(Coefficient::k_uds) = 0.3;
  }
  truth.components = {Effect::dd, Effect::udf, Effect::uds};
  const double t = 0.96 * 0.96;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    const Scan scan = simulate(truth, Sampling::hemisphere, {0.02, 0.0}, seed);
    const Scan steep = readings_where(
        scan, [&](std::size_t row) { return std::max(scan.theta_i_deg[row], scan.theta_r_deg[row]) <= 35.0; });
    const FitResult r = fit(steep, with(truth.components));
    expect_sound(r);
    EXPECT_TRUE(
        says(r.warnings, "k_udf, k_uds of every channel trade for each other: only known is R: k_udf + 0.92 k_uds"));
    EXPECT_TRUE(says(r.warnings, "no theta beyond 3"));
    EXPECT_TRUE(says(r.warnings, "measure at theta_i beyond 60"));
    std::size_t pairs = 0;
    for (const OpenDirection& open : r.identifiability.open) {
      ASSERT_TRUE(open.known);
      EXPECT_NEAR(open.known->value, 0.2 + 0.3 * t, 4.0 * open.known->u + 0.001);
      EXPECT_LT(open.known->u, 0.01);
      ++pairs;
    }
    EXPECT_EQ(pairs, 3U);
    for (const char* channel : {"R", "G", "B"}) {
      EXPECT_FALSE(parameter(r, "k_udf", channel).identifiable || parameter(r, "k_uds", channel).identifiable);
      EXPECT_TRUE(parameter(r, "k_dd", channel).identifiable);
    }
    EXPECT_TRUE(fit(scan, with(truth.components)).identifiability.open.empty());
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
