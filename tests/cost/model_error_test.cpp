// Errors of known size: by closed forms, and by quadratures that know nothing of the sampling.

#include "cost/model_error.h"

#include <gtest/gtest.h>

#include <cmath>

#include "brdf/evaluator.h"
#include "cost/reference.h"
#include "geometry/angles.h"
#include "peers/quadrature.h"
#include "support/materials.h"

namespace goniofit::test {
namespace {

Material lambert(double k_udf) {
  Material m = ground_glass_41();
  m.components = {Effect::udf};
  for (MaterialChannel& c : m.channels) c.coefficient(Coefficient::k_udf) = k_udf;
  return m;
}

ModelError error_of(const Material& reference, const Material& other, const Domain& domain,
                    const ErrorSettings& settings) {
  const ErrorSamples s = error_samples(reference, domain, settings);
  return model_error(s, model_values({.name = "a", .material = reference}, s),
                     model_values({.name = "b", .material = other}, s));
}

constexpr Domain at(double theta_i_deg) { return {.theta_i_min_deg = theta_i_deg, .theta_i_max_deg = theta_i_deg}; }
constexpr ErrorSettings one_angle{.incidences = 1, .directions = 20000};

TEST(ModelError, AConstantFactorIsEveryError) {
  const ModelError e = error_of(lambert(0.5), lambert(0.45), {}, {.incidences = 5, .directions = 50});
  for (const double x : {e.l1, e.worst_l1, e.rms_relative, e.max_relative}) EXPECT_NEAR(x, 0.1, 1e-14);
  EXPECT_NEAR(e.worst_l1_bound, 0.1, 1e-7) << "a quotient that does not vary has no standard error";
}

TEST(ModelError, NothingIsNothing) {
  const ModelError e = error_of(garnet_red_paint_13(), garnet_red_paint_13(), {}, {.incidences = 3, .directions = 50});
  for (const double x : {e.l1, e.worst_l1, e.worst_l1_bound, e.rms_relative, e.max_relative}) EXPECT_EQ(x, 0.0);
}

TEST(ModelError, ADarkReferenceDividesByTheLeastThatCanBeSeen) {
  const ModelError e = error_of(lambert(1e-6 * pi), lambert(1e-4 * pi), {}, {.incidences = 1, .directions = 10});
  EXPECT_NEAR(e.max_relative, (1e-4 - 1e-6) / 1e-3, 1e-12);
  EXPECT_NEAR(e.l1, 99.0, 1e-9);
}

// uds of the laser paper against Lambert's surface: both broad.
TEST(ModelError, BroadDifferencesByQuadrature) {
  Material uds = laser_paper_73();
  uds.components = {Effect::uds};
  uds.channels.resize(1);
  Material udf = uds;
  udf.components = {Effect::udf};
  udf.channels[0].coefficient(Coefficient::k_udf) = 0.8;
  const Evaluator a(uds);
  const Evaluator b(udf);
  const double theta_i = 35.0;
  const double expected =
      broad_albedo([&](const Pair& p) { return std::fabs(b.value(p, 0) - a.value(p, 0)); }, theta_i) /
      broad_albedo([&](const Pair& p) { return a.value(p, 0); }, theta_i);
  EXPECT_NEAR(error_of(uds, udf, at(theta_i), one_angle).l1, expected, 0.02 * expected);
}

// The lobe of the ground glass with Schlick's Fresnel term instead of the exact one, and with another slope.
TEST(ModelError, LobesByQuadratureOverHalfVectors) {
  Material lobe = ground_glass_41();
  lobe.components = {Effect::dd};
  lobe.channels.resize(1);
  lobe.terms.fresnel = FresnelTier::exact;
  Material schlick = lobe;
  schlick.terms.fresnel = FresnelTier::schlick;
  Material wider = with_surface(lobe, 0.86, 4.5);
  for (const Material& other : {schlick, wider}) {
    const Evaluator a(lobe);
    const Evaluator b(other);
    for (const double theta_i : {0.0, 40.0, 70.0}) {
      const double width = 2.0 * *lobe.surface.slope;
      const double expected =
          directional_albedo([&](const Pair& p) { return std::fabs(b.value(p, 0) - a.value(p, 0)); }, theta_i, width) /
          directional_albedo([&](const Pair& p) { return a.value(p, 0); }, theta_i, width);
      const ModelError e = error_of(lobe, other, at(theta_i), one_angle);
      EXPECT_NEAR(e.l1, expected, 0.03 * expected) << theta_i;
      EXPECT_NEAR(e.worst_l1, e.l1, 1e-12) << "one angle and channel: the worst is the only one";
      EXPECT_NEAR(e.worst_theta_i_deg, theta_i, 1e-12);
    }
  }
}

// coh by its energy k F S exp(-g): leaving it out is E/(E + k_udf), whatever the solid angle.
TEST(ModelError, TheCoherentPartCountsByItsEnergy) {
  Material m = smooth_aluminium_45();
  m.surface = rough_surface(0.05, 3.0);
  m.components = {Effect::coh, Effect::udf};
  m.terms.shadowing = ShadowingTier::none;
  m.terms.effective_roughness = EffectiveRoughnessTier::none;
  m.channels[0].coefficient(Coefficient::k_udf) = 0.2;
  Material without = m;
  without.components = {Effect::udf};
  const double theta_i = 30.0;
  const double phase = 2.0 * pi * 0.05 / 0.55 * 2.0 * cos_deg(theta_i);
  const double f0 = m.channels[0].normal_reflectance();
  const double energy = (f0 + (1.0 - f0) * std::pow(1.0 - cos_deg(theta_i), 5)) * std::exp(-phase * phase);
  for (const double solid_angle : {0.0005, 0.01}) {
    m.solid_angle_sr = without.solid_angle_sr = solid_angle;
    const ModelError e = error_of(m, without, at(theta_i), one_angle);
    EXPECT_NEAR(e.l1, energy / (energy + 0.2), 0.01);
    const double height = energy / (cos_deg(theta_i) * solid_angle);
    EXPECT_NEAR(e.max_relative, height / (height + 0.2 / pi), 1e-9);
  }
}

// A peer's mirror part is found by its energy too: Schlick's SINGLE of r < 1/2 has c = 1 - 4 r (1 - r) of it.
TEST(ModelError, APeersMirrorPartCountsByItsEnergy) {
  Material m;
  m.name = "mirror";
  m.model = "schlick-single-isotropic";
  m.parameters = {{"r", 0.1}};
  MaterialChannel c;
  c.name = "R";
  c.peer_k = {{"C", 0.7}};
  m.channels = {c};
  const ErrorSamples s = error_samples(lambert(0.5), at(40.0), {.incidences = 1, .directions = 100});
  const ModelValues values = model_values({.name = "m", .material = m}, s);
  const double u = cos_deg(40.0);
  const double schlick = 0.7 + 0.3 * std::pow(1.0 - u, 5);
  EXPECT_NEAR(values.mirror_energy[0], schlick * (1.0 - 4.0 * 0.1 * 0.9), 1e-9);
}

// The standard error that a bound is made of is that of the estimates over seeds.
TEST(ModelError, TheBoundKnowsTheSpreadOfTheEstimates) {
  const Material exact = reference_of(laser_paper_73(), WaveOptics::fast).material;
  constexpr int seeds = 30;
  double sum = 0.0;
  double squares = 0.0;
  double stated = 0.0;
  Material one = exact;
  one.channels.resize(1);
  Material given = laser_paper_73();
  given.channels.resize(1);
  for (int seed = 1; seed <= seeds; ++seed) {
    const ErrorSettings settings{.incidences = 1, .directions = 256, .seed = static_cast<std::uint64_t>(seed)};
    const ModelError e = error_of(one, given, at(60.0), settings);
    sum += e.worst_l1;
    squares += e.worst_l1 * e.worst_l1;
    stated += (e.worst_l1_bound - e.worst_l1) / 3.0;
  }
  const double mean = sum / seeds;
  const double spread = std::sqrt(squares / seeds - mean * mean);
  EXPECT_GT(spread, 0.0);
  EXPECT_NEAR(stated / seeds / spread, 1.0, 0.45);
}

TEST(ModelError, SinglePrecisionIsNearDouble) {
  const Material m = reference_of(garnet_red_paint_13(), WaveOptics::fast).material;
  const ErrorSamples s = error_samples(m, {}, {.incidences = 5, .directions = 200});
  const EvaluationCandidate in_double{.name = "d", .material = m};
  EvaluationCandidate in_float = in_double;
  in_float.arithmetic = Arithmetic::batch_float;
  const ModelError e = model_error(s, model_values(in_double, s), model_values(in_float, s));
  EXPECT_GT(e.l1, 0.0) << "it is another arithmetic";
  EXPECT_LT(e.l1, 1e-4);
}

}  // namespace
}  // namespace goniofit::test
