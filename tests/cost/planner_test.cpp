#include "cost/planner.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "cost/reference.h"
#include "io/material_io.h"
#include "support/error_message.h"
#include "support/materials.h"

namespace goniofit::test {
namespace {

const PlanSettings quick = PlanSettings::quick();

const PlanLine& line_of(const Plan& p, const std::string& subject) {
  const auto found =
      std::find_if(p.lines.begin(), p.lines.end(), [&](const PlanLine& line) { return line.subject == subject; });
  if (found == p.lines.end()) throw std::runtime_error("no line about " + subject);
  return *found;
}

TEST(Planner, AnEffectThatAddsNothingGoes) {
  Material m = garnet_red_paint_13();
  for (MaterialChannel& c : m.channels) c.coefficient(Coefficient::k_fs) = 1e-6;
  const Plan p = plan(m, {}, 0.01, quick);
  EXPECT_EQ(p.material.components, (EffectSet{Effect::dd, Effect::uds}));
  const PlanLine& fs = line_of(p, "fs");
  EXPECT_EQ(fs.choice, "left out");
  EXPECT_TRUE(fs.simplified);
  EXPECT_LT(fs.change, 1e-5);
  EXPECT_EQ(fs.text().rfind("fs left out: changes ", 0), 0U) << fs.text();
  EXPECT_EQ(line_of(p, "uds").choice, "kept");
}

TEST(Planner, AMirrorKeepsItsCoherentPart) {
  Material m = smooth_aluminium_45();
  m.surface = rough_surface(0.03, 3.0);
  const Plan p = plan(m, {}, 0.01, quick);
  EXPECT_TRUE(p.material.components.has(Effect::coh));
  EXPECT_GT(line_of(p, "coh").change, 0.5) << "most of the light";
  const Plan rough = plan(ground_glass_41(), {}, 0.01, quick);
  EXPECT_FALSE(rough.material.components.has(Effect::coh));
}

// Among other directions at other angles: a bound with three standard errors holds there as well.
TEST(Planner, StaysWithinTheToleranceOnFreshDirections) {
  for (const double tolerance : {0.01, 0.05}) {
    for (const Material& m : {garnet_red_paint_13(), laser_paper_73(), ground_glass_41(), smooth_aluminium_45()}) {
      const Plan p = plan(m, {}, tolerance, quick);
      EXPECT_LE(p.error.worst_l1_bound, tolerance) << m.name;
      const Material exact = reference_of(m, WaveOptics::fast).material;
      const ErrorSettings fresh{.incidences = 12, .directions = 1024, .random_incidence = true, .seed = 4711};
      EXPECT_LE(error_within(exact, p.material, {}, fresh).worst_l1, tolerance) << m.name << " to " << tolerance;
    }
  }
}

// The errors of combinations are sums over effects; those of the whole material must be the same.
TEST(Planner, SumsOfPartsAreTheWhole) {
  const Plan p = plan(laser_paper_73(), {}, 0.03, quick);
  const Material exact = reference_of(laser_paper_73(), WaveOptics::fast).material;
  ErrorSettings same = quick.errors;
  same.seed = quick.seed;
  const ModelError planned = error_within(exact, p.material, {}, same);
  EXPECT_NEAR(planned.worst_l1, p.error.worst_l1, 1e-9);
  EXPECT_NEAR(planned.rms_relative, p.error.rms_relative, 1e-9);
  const ModelError given = error_within(exact, laser_paper_73(), {}, same);
  EXPECT_NEAR(given.worst_l1, p.error_before.worst_l1, 1e-9);
}

// Where the material as given is more than it needs, the plan is not slower; loosely, for the machine's noise.
TEST(Planner, SavesTimeWhereThereIsSomeToSave) {
  const Plan p = plan(laser_paper_73(), {.theta_i_max_deg = 60.0, .theta_r_max_deg = 60.0}, 0.1, quick);
  ASSERT_LE(p.error_before.worst_l1_bound, 0.1);
  EXPECT_GT(p.ratio_before, 0.95);
  EXPECT_GT(p.ratio_reference, 1.2);
  EXPECT_GE(p.searched, p.within);
  EXPECT_GE(p.within, p.timed);
  EXPECT_GT(p.timed, 0U);
}

TEST(Planner, DarkDirectionsCountOnRequest) {
  PlanSettings settings = quick;
  const Domain d{.theta_i_max_deg = 60.0, .theta_r_max_deg = 70.0};
  const Plan bright = plan(laser_paper_73(), d, 0.03, settings);
  settings.bound_rms = true;
  const Plan dark = plan(laser_paper_73(), d, 0.03, settings);
  EXPECT_LE(dark.error.rms_relative, 0.03);
  EXPECT_LE(dark.error.worst_l1_bound, 0.03);
  EXPECT_LE(dark.within, bright.within) << "one more bound";
}

TEST(Planner, NearTheNormalNothingIsShadowed) {
  const Domain steep{.theta_i_max_deg = 20.0, .theta_r_max_deg = 30.0};
  const Plan p = plan(garnet_red_paint_13(), steep, 0.01, quick);
  const PlanLine& shadowing = line_of(p, "shadowing");
  EXPECT_LT(shadowing.change, 0.01) << shadowing.text();
  const PlanLine& roughness = line_of(p, "effective_roughness");
  EXPECT_EQ(roughness.choice, "none") << roughness.text();
  EXPECT_EQ(roughness.text().rfind("effective_roughness left out: changes ", 0), 0U) << roughness.text();
}

TEST(Planner, WritesAMaterialThatEveryOneTakes) {
  Material m = smooth_aluminium_45();
  m.fit = FitSummary{};
  const Plan p = plan(m, {}, 0.02, quick);
  EXPECT_EQ(p.material.channels, m.channels) << "coefficients are the material's";
  EXPECT_EQ(p.material.surface, m.surface);
  EXPECT_FALSE(p.material.fit);
  EXPECT_EQ(parse_material(to_json(p.material), "planned"), p.material);
}

TEST(Planner, EveryDecisionHasALine) {
  const Plan p = plan(smooth_aluminium_45(), {}, 0.01, quick);
  for (const char* subject : {"coh", "dd", "fresnel", "shadowing", "effective_roughness", "distribution"}) {
    EXPECT_FALSE(line_of(p, subject).text().empty());
  }
  const PlanLine& fresnel = line_of(p, "fresnel");
  EXPECT_EQ(fresnel.choice, "exact");
  EXPECT_NE(fresnel.text().find("schlick would change"), std::string::npos) << fresnel.text();
}

TEST(Planner, AnUnknownSigmaMakesTheRoughLimitTheReference) {
  const Plan p = plan(garnet_by_slope(), {}, 0.01, quick);
  EXPECT_NE(p.reference.find("rough-limit, exact terms"), std::string::npos);
  EXPECT_EQ(p.material.terms.distribution, DistributionTier::rough_limit);
}

TEST(Planner, OnlyTheWavelengthsAskedForCount) {
  const Material m = garnet_red_paint_13();
  EXPECT_EQ(channels_in(m, {}), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(channels_in(m, {.wavelengths_um = {0.55, 0.65}}), (std::vector<std::size_t>{1, 0}));
  EXPECT_NE(error_message([&] { (void)channels_in(m, {.wavelengths_um = {0.5}}); }).find("has no channel of it"),
            std::string::npos);
  // uds is 0 in green and blue.
  const Plan green = plan(m, {.wavelengths_um = {0.55}}, 0.01, quick);
  EXPECT_FALSE(green.material.components.has(Effect::uds));
  EXPECT_EQ(green.material.channels.size(), 3U) << "the others stay in the file";
}

TEST(Planner, CheaperFormsOfGrooves) {
  const Plan p = plan(rough_plaster(), {.theta_i_max_deg = 40.0, .theta_r_max_deg = 50.0}, 0.4, quick);
  EXPECT_TRUE(p.material.components.has(Effect::rough));
  EXPECT_EQ(p.material.forms.rough, RoughForm::qualitative);
  EXPECT_LE(p.error.worst_l1_bound, 0.4);
}

// What a scene hands over: directions of its own, an error of its own.
TEST(Planner, PlansOnDirectionsThatTheCallerChose) {
  const Material m = laser_paper_73();
  const Domain steep{.theta_i_max_deg = 20.0, .theta_r_max_deg = 30.0};
  const Material exact = reference_of(m, WaveOptics::fast).material;
  PlanSamples samples{.directions = error_samples(exact, steep, quick.errors), .error = {}, .channels = {0, 1, 2}};
  samples.error = [&](const ModelValues& reference, const ModelValues& other) {
    return model_error(samples.directions, reference, other);
  };
  const Plan free = plan_on(samples, m, 0.01, quick);
  EXPECT_EQ(free.material.terms, plan(m, steep, 0.01, quick).material.terms);
  EXPECT_FALSE(free.material.components.has(Effect::fs)) << "nothing scatters forward near the normal";

  samples.keep[Effect::fs] = "someone wants it";
  const Plan kept = plan_on(samples, m, 0.01, quick);
  EXPECT_TRUE(kept.material.components.has(Effect::fs));
  EXPECT_EQ(line_of(kept, "fs").text(), "fs kept: someone wants it");
  EXPECT_LT(kept.searched, free.searched);

  PlanSettings single = quick;
  single.arithmetic = Arithmetic::batch_float;
  const Plan in_float = plan_on(samples, m, 0.01, single);
  EXPECT_GT(in_float.error.worst_l1, 1e-9) << "rounding is part of the error";
  EXPECT_LE(in_float.error.worst_l1_bound, 0.01);
}

TEST(Planner, RefusesWhatCannotBePlanned) {
  EXPECT_THROW((void)plan(garnet_red_paint_13(), {}, 0.0, quick), Error);
  EXPECT_THROW((void)plan(garnet_red_paint_13(), {}, 1.0, quick), Error);
  EXPECT_THROW((void)plan(anisotropic_ggx(), {}, 0.01, quick), Error);
  EXPECT_THROW((void)plan(garnet_red_paint_13(), {.theta_i_max_deg = 95.0}, 0.01, quick), Error);
  Material black = ground_glass_41();
  for (MaterialChannel& c : black.channels) c.k = {};
  EXPECT_THROW((void)plan(black, {}, 0.01, quick), Error);
}

}  // namespace
}  // namespace goniofit::test
