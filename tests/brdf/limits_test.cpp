// What the models become in a limit, and the energies that have closed forms.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "brdf/evaluator.h"
#include "geometry/angles.h"
#include "peers/ggx.h"
#include "support/albedo.h"
#include "support/laws.h"
#include "support/materials.h"
#include "support/random_directions.h"

namespace goniofit::test {
namespace {

// dd alone with F = 1 and k_dd = 1.
Material white_dd(double slope, const Terms& terms = {}) {
  Material m = ground_glass_41();
  m.channels.resize(1);
  m.components = {Effect::dd};
  m.terms = terms;
  m.terms.fresnel = FresnelTier::none;
  m.surface = {.slope = slope};
  m.channels[0].k = {};
  m.channels[0].coefficient(Coefficient::k_dd) = 1.0;
  return m;
}

Material one_channel(Material m, EffectSet components, Coefficient only, double k) {
  m.components = components;
  m.channels.resize(1);
  m.channels[0].k = {};
  m.channels[0].coefficient(only) = k;
  return m;
}

TEST(Limits, AnisotropicSurfaceOfEqualSlopesIsTheIsotropicOne) {
  for (const AnisotropyForm form : {AnisotropyForm::consistent, AnisotropyForm::printed}) {
    for (Material m :
         {laser_paper_73(), ground_glass_41(), smooth_aluminium_45(), he_ground_glass(), long_tailed_paint()}) {
      m.forms.anisotropy = form;
      Material equal = m;
      equal.surface.slope_y = m.surface.slope;
      expect_same(equal, m, 1e-12);
      m.forms.fs = equal.forms.fs = FsForm::reciprocal;
      expect_same(equal, m, 1e-12);
    }
  }
}

Material peer(const char* model, const std::map<std::string, std::optional<double>>& parameters) {
  Material m;
  m.name = m.model = model;
  m.parameters = parameters;
  m.channels = {channel("R", 0.55, 1.5, 0.0, 0.0, 0.0, 0.0, 0.0)};
  m.channels[0].k = {};
  if (m.model.starts_with("schlick-single")) m.channels[0].peer_k = {{"C", 0.3}};
  if (m.model.starts_with("schlick-double")) m.channels[0].peer_k = {{"C_2", 0.3}};
  if (!m.model.starts_with("schlick")) m.channels[0].peer_k = {{"k_d", 0.2}, {"k_s", 0.5}};
  return m;
}

TEST(Limits, AnisotropicPeersOfEqualWidthsAreTheIsotropicOnes) {
  expect_same(peer("ward-anisotropic", {{"alpha_x", 0.2}, {"alpha_y", 0.2}}), peer("ward", {{"alpha", 0.2}}), 1e-12);
  expect_same(peer("ggx-anisotropic", {{"alpha_x", 0.2}, {"alpha_y", 0.2}}), peer("ggx", {{"alpha", 0.2}}), 1e-12);
  for (const std::string form : {"", "-printed"}) {
    expect_same(peer(("schlick-single" + form).c_str(), {{"r", 0.2}, {"p", 1.0}}),
                peer("schlick-single-isotropic", {{"r", 0.2}}), 1e-12);
    expect_same(peer(("schlick-double" + form).c_str(), {{"r_1", 0.1}, {"p_1", 1.0}, {"r_2", 0.7}, {"p_2", 1.0}}),
                peer("schlick-double-isotropic", {{"r_1", 0.1}, {"r_2", 0.7}}), 1e-12);
  }
}

TEST(Limits, StudentsTailOfTwoIsGgx) {
  constexpr Terms bare{.shadowing = ShadowingTier::none,
                       .effective_roughness = EffectiveRoughnessTier::none,
                       .distribution = DistributionTier::student_t};
  for (const double slope : {0.01, 0.2, 1.0}) {
    Material m = white_dd(slope, bare);
    m.surface.tail = 2.0;
    const Evaluator e(m);
    Draw draw(41);
    for (int i = 0; i < 500; ++i) {
      const Pair p = make_pair(draw.angles());
      if (!(p.cos_i > 0.0) || !(p.cos_r > 0.0)) continue;
      const double expected = ggx_distribution(std::log(2.0 * slope), p) / (4.0 * p.cos_i * p.cos_r);
      EXPECT_NEAR(e.value(p, 0), std::min(expected, saturation), 1e-12 * expected);
    }
  }
}

// (1 + y/n)^-(n+1) is e^-y (1 + y²/2n - y/n) for large n.
TEST(Limits, StudentsLongestTailsAreTheRoughLimit) {
  constexpr double slope = 0.2;
  for (const ShadowingTier shadowing :
       {ShadowingTier::li_torrance, ShadowingTier::smith, ShadowingTier::schlick, ShadowingTier::none}) {
    const Terms rough{.shadowing = shadowing, .effective_roughness = EffectiveRoughnessTier::none};
    const Evaluator limit(white_dd(slope, rough));
    Material student = limit.material();
    student.terms.distribution = DistributionTier::student_t;
    student.surface.tail = 1e6;
    const Evaluator tailed(student);
    Draw draw(42);
    int compared = 0;
    while (compared < 500) {
      const Pair p = make_pair(draw.angles());
      if (!(p.cos_i > 0.0) || !(p.cos_r > 0.0) || p.tan2_b > 16.0 * slope * slope) continue;  // y <= 4
      ++compared;
      EXPECT_NEAR(tailed.value(p, 0) / limit.value(p, 0), 1.0, 1e-5);
    }
    for (const double theta : {0.0, 40.0, 80.0}) {
      EXPECT_NEAR(directional_albedo(student, theta) / directional_albedo(limit.material(), theta), 1.0, 1e-5) << theta;
    }
  }
}

Material he(double sigma_um, double tau_um, DistributionTier tier) {
  Material m = he_ground_glass();
  m.surface = surface(sigma_um, tau_um);
  m.terms.distribution = tier;
  return m;
}

TEST(Limits, HeTorranceOfVeryRoughSurfacesIsTheRoughLimit) {
  // sigma 5 to 500 um: g = 1e4 to 1e8 and what is missing is of order 1/g.
  double before = 1.0;
  for (const double sigma : {5.0, 50.0, 500.0}) {
    const double slope = 0.2;
    const Evaluator wave(he(sigma, sigma / slope, DistributionTier::he_torrance));
    const Evaluator limit(he(sigma, sigma / slope, DistributionTier::rough_limit));
    double worst = 0.0;
    for (double theta_r = -80.0; theta_r <= 80.0; theta_r += 4.0) {
      const Pair p = make_pair(in_plane(45.0, theta_r));
      if (p.tan2_b > 16.0 * slope * slope) continue;  // y <= 4
      worst = std::max(worst, std::fabs(wave.value(p, 0, Effect::dd) / limit.value(p, 0, Effect::dd) - 1.0));
    }
    std::printf("he-torrance against its limit, sigma %g um: %.2g\n", sigma, worst);
    EXPECT_LT(worst, 0.02 * before);
    before = worst;
  }
  EXPECT_LT(before, 1e-7);
}

TEST(Limits, HeTorranceIsItsSeries) {
  for (const double sigma : {0.005, 0.05, 0.2, 0.9, 3.0}) {
    for (const double tau : {2.0, 10.0}) {
      expect_same(he(sigma, tau, DistributionTier::he_torrance), he(sigma, tau, DistributionTier::he_torrance_series),
                  1e-9, 200);
    }
  }
}

TEST(Limits, RoughOfLevelFacetsIsLambert) {
  Material lambert = one_channel(rough_plaster(), {Effect::udf}, Coefficient::k_udf, 0.8);
  for (const RoughForm form : {RoughForm::integral, RoughForm::functional, RoughForm::qualitative}) {
    Material m = one_channel(rough_plaster(), {Effect::rough}, Coefficient::rho, 0.8);
    m.forms.rough = form;
    m.surface.facet_slope_deg = 0.0;
    expect_same(m, lambert, 1e-15);
  }
}

// Diffracted light and mirrored light share what the facets reflect: e^-g stays in the mirror direction (HT 1991, 5).
// Exact F, n = 1.3, lambda 0.526 um, 5 degrees; smooth enough (tau 3 um) that the lobe's own F is that of the mirror's.
TEST(Energy, HeTorrancesSmoothSurfaceDividesFresnelsReflectance) {
  double worst_dd = 0.0;
  double worst_sum = 0.0;
  for (const double sigma : {0.01, 0.02, 0.03, 0.05, 0.08}) {
    constexpr double theta = 5.0;
    Material m = one_channel(he(sigma, 3.0, DistributionTier::he_torrance), {Effect::dd}, Coefficient::k_dd, 1.0);
    m.channels[0].wavelength_um = 0.526;
    m.channels[0].n = 1.3;
    m.channels[0].kappa = 0.0;
    const double g = std::pow(4.0 * pi * sigma / 0.526 * cos_deg(theta), 2);
    const double f0 = std::pow(0.3 / 2.3, 2);
    const double dd = directional_albedo(m, theta);
    m.components.insert(Effect::coh);
    const double sum = directional_albedo(m, theta);
    std::printf("sigma %.2f: dd %.5f of %.5f, dd + coh %.5f of %.5f\n", sigma, dd, -f0 * std::expm1(-g), sum, f0);
    worst_dd = std::max(worst_dd, std::fabs(dd / (-f0 * std::expm1(-g)) - 1.0));
    worst_sum = std::max(worst_sum, std::fabs(sum / f0 - 1.0));
    // What the library's own quadrature says of both.
    EXPECT_NEAR(hemispherical_reflectance(Evaluator(m), theta).front() / sum, 1.0, 1e-3) << sigma;
  }
  EXPECT_LT(worst_dd, 0.01);
  EXPECT_LT(worst_sum, 0.01);
}

TEST(Energy, UniformSubsurfaceLightHasItsClosedForm) {
  const Material m = one_channel(laser_paper_73(), {Effect::uds}, Coefficient::k_uds, 0.9);
  const double t0 = 1.0 - m.channels[0].normal_reflectance();
  for (const double theta : {0.0, 30.0, 60.0, 85.0, 89.0}) {
    const double expected = 0.9 * t0 * t0 * (20.0 / 21.0) * -std::expm1(5.0 * std::log1p(-cos_deg(theta)));
    EXPECT_NEAR(directional_albedo(m, theta), theta == 0.0 ? 0.9 * t0 * t0 * (20.0 / 21.0) : expected, 2e-5) << theta;
  }
}

// LT's k_fs looks like a large number and is a small effect; most at 72 degrees.
TEST(Energy, ForwardScatterOfThePapersSamplesIsFaint) {
  const auto largest = [](const Material& sample) {
    const Material m = one_channel(sample, {Effect::fs}, Coefficient::k_fs, 1.0);
    double albedo = 0.0;
    for (double theta = 0.0; theta < 90.0; theta += 4.0) albedo = std::max(albedo, directional_albedo(m, theta));
    return albedo;
  };
  EXPECT_NEAR(largest(garnet_red_paint_13()), 0.00206, 2e-5);
  EXPECT_NEAR(largest(laser_paper_73()), 0.00139, 2e-5);
}

// Oren and Nayar's fit (14), (15) returns more than a white surface receives, their integral never.
TEST(Energy, FunctionalGroovesReflectAFewPercentTooMuch) {
  double largest = 0.0;
  for (const double facet_slope : {5.0, 10.0, 15.0, 20.0, 25.0, 30.0}) {
    Material m = one_channel(rough_plaster(), {Effect::rough}, Coefficient::rho, 1.0);
    m.surface.facet_slope_deg = facet_slope;
    for (const double theta : {60.0, 80.0, 85.0, 89.0}) largest = std::max(largest, directional_albedo(m, theta));
  }
  std::printf("functional grooves, rho = 1: albedo up to %.4f\n", largest);
  EXPECT_NEAR(largest, 1.043, 0.005);
}

// The library's quadrature against this one, for what has lobes, no lobes, a cone, two axes.
TEST(Energy, HemisphericalReflectanceIsAsPreciseAsItSays) {
  for (const Material& m : {garnet_red_paint_13(), laser_paper_73(), ground_glass_41(), smooth_aluminium_45(),
                            he_ground_glass(), brushed_aluminium(), rough_plaster(), long_tailed_paint()}) {
    for (const double theta : {5.0, 45.0, 80.0}) {
      const double own = directional_albedo(m, theta);
      const double allowed = m.surface.anisotropic() ? 1e-3 : 3e-4;
      EXPECT_NEAR(hemispherical_reflectance(Evaluator(m), theta).front() / own, 1.0, allowed) << m.name << " " << theta;
    }
  }
}

}  // namespace
}  // namespace goniofit::test
