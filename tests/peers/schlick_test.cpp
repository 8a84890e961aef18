#include "peers/schlick.h"

#include <gtest/gtest.h>

#include "peer_support.h"
#include "peers/ggx.h"
#include "peers/lafortune.h"
#include "peers/neumann_neumann.h"

namespace goniofit {
namespace {

constexpr SchlickAzimuth isotropic = SchlickAzimuth::isotropic;

TEST(Schlick, IsLambertAtRoughnessOne) {
  std::mt19937_64 random(31);
  const double z[] = {0.0};
  for (int trial = 0; trial < 1000; ++trial) {
    const Pair p = make_pair(test::random_pair(random));
    if (p.cos_i <= 0.0 || p.cos_r <= 0.0) continue;
    EXPECT_NEAR(schlick_directional<isotropic>(p, z, 0.0), 1.0 / pi, 1e-15);
  }
}

// Z/pi is GGX's D with alpha² = r, an identity that the paper does not mention.
TEST(Schlick, ZenithFactorIsGgx) {
  for (const double r : {1e-4, 0.01, 0.3, 1.0}) {
    for (const double theta_r : {-80.0, -20.0, 0.0, 29.0, 30.0, 75.0}) {
      const Pair p = make_pair(in_plane(30.0, theta_r));
      const double ggx = ggx_distribution(0.5 * std::log(r), p);
      EXPECT_NEAR(schlick_zenith(r, p) / pi, ggx, 1e-13 * ggx);
    }
  }
}

// The equations as printed, term by term, at a place where nothing cancels.
TEST(Schlick, IsTheSumOfItsPrintedTerms) {
  const AnglePair angles{50.0, 20.0, 35.0, 170.0};
  const Pair pair = make_pair(angles);
  const double v = cos_deg(35.0);
  const double w1 = cos_deg(50.0);  // v'
  const double t = 1.0 / std::sqrt(1.0 + pair.tan2_b);
  const double w2 = pair.s_x2 / (pair.s_x2 + pair.s_y2);
  for (const double r : {0.2, 0.7}) {
    for (const double p : {0.3, 1.0}) {
      const double z[] = {std::log(r), std::log(p)};
      const double zenith = r / std::pow(1.0 + r * t * t - t * t, 2);
      const double a2 = p / (p * p - p * p * w2 + w2);
      const double g = v / (r - r * v + v) * (w1 / (r - r * w1 + w1));
      const double b = 4.0 * r * (1.0 - r);
      const auto blend = [&](double azimuth, double mirror) {
        const double a = r > 0.5 ? 1.0 - b : 0.0;
        const double c = r > 0.5 ? 0.0 : 1.0 - b;
        return a / pi + b / (4.0 * pi * v * w1) * (g * zenith * azimuth + 1.0 - g) + c * mirror;
      };
      EXPECT_NEAR(schlick_directional<SchlickAzimuth::normalised>(pair, z, 0.0), blend(a2, 0.0), 1e-14);
      EXPECT_NEAR(schlick_directional<SchlickAzimuth::printed>(pair, z, 7.0), blend(std::sqrt(a2), 7.0), 1e-14);
    }
  }
}

// (24): the colour C and the white rest, through the columns.
TEST(Schlick, ColourTurnsWhiteAtGrazing) {
  const auto basis = make_peer("schlick-single-isotropic");
  const ChannelOptics none = ChannelOptics::of_index(1.0, 0.0);
  const Pair p = make_pair(in_plane(80.0, 75.0));
  const std::vector<double> z{std::log(0.6)};
  const double d = schlick_directional<isotropic>(p, z.data(), 0.0);
  for (const double c : {0.0, 0.3, 1.0}) {
    const double s = c + (1.0 - c) * std::pow(1.0 - p.cos_h, 5);
    EXPECT_NEAR(test::value(*basis, p, z, {c, 1.0}, none, FresnelTier::exact), s * d, 1e-14 * d);
  }
}

// R = S D + (1 - S) S' D' with S the exact Fresnel reflectance of the clear layer.
TEST(Schlick, DoubleIsALayerOverASingle) {
  const auto layered = make_peer("schlick-double", 0.0);
  const auto single = make_peer("schlick-single", 0.0);
  const Pair p = make_pair({50.0, 20.0, 35.0, 170.0});
  const ChannelOptics glass = ChannelOptics::of_index(1.5, 0.0);
  const std::vector<double> clear{std::log(0.1), std::log(0.8)};
  const std::vector<double> base{std::log(0.6), std::log(0.4)};
  const double s = fresnel_exact(1.5, 0.0, p.cos_h, p.one_minus_cos_h);
  const double expected = s * schlick_directional<SchlickAzimuth::normalised>(p, clear.data(), 0.0) +
                          (1.0 - s) * test::value(*single, p, base, {0.3, 1.0}, glass, FresnelTier::exact);
  EXPECT_NEAR(
      test::value(*layered, p, {clear[0], clear[1], base[0], base[1]}, {1.0, 0.3, 1.0}, glass, FresnelTier::exact),
      expected, 1e-15);
}

// The mean of A over the azimuth of H: 1 without the root for every p.
TEST(Schlick, OnlyTheNormalisedAzimuthMeetsItsCondition) {
  const auto mean = [](auto form_tag, double p) {
    constexpr SchlickAzimuth form = decltype(form_tag)::value;
    constexpr int n = 20000;
    double sum = 0.0;
    for (int i = 0; i < n; ++i) {
      Pair pair = make_pair({0.0, 0.0, 40.0, 360.0 * (i + 0.5) / n});
      sum += schlick_azimuth<form>(p, pair) / n;
    }
    return sum;
  };
  constexpr std::integral_constant<SchlickAzimuth, SchlickAzimuth::normalised> normalised;
  constexpr std::integral_constant<SchlickAzimuth, SchlickAzimuth::printed> printed;
  for (const double p : {0.02, 0.05, 0.3, 0.7, 1.0}) {
    EXPECT_NEAR(mean(normalised, p), 1.0, 1e-9) << p;
    std::printf("p %.2f: mean of the printed A(w) %.4f\n", p, mean(printed, p));
  }
  EXPECT_LT(mean(printed, 0.05), 0.99);
  EXPECT_NEAR(mean(printed, 1.0), 1.0, 1e-12);
}

// Inside the cone c/(v dw), outside nothing; its energy is c.
TEST(Schlick, MirrorPartIsAConeOfTheInstrumentsSolidAngle) {
  const ChannelOptics none = ChannelOptics::of_index(1.0, 0.0);
  const std::vector<double> z{std::log(0.1)};
  const double c = 0.64;  // (1 - 2r)²
  const double theta = 60.0;
  const double half_angle = degrees(std::acos(1.0 - 0.0005 / (2.0 * pi)));
  const auto with = make_peer("schlick-single-isotropic");
  const auto without = make_peer("schlick-single-isotropic", 0.0);
  const auto mirror_part = [&](double theta_i, double theta_r) {
    const Pair p = make_pair(in_plane(theta_i, theta_r));
    return test::value(*with, p, z, {1.0, 1.0}, none, FresnelTier::none) -
           test::value(*without, p, z, {1.0, 1.0}, none, FresnelTier::none);
  };
  EXPECT_NEAR(mirror_part(theta, theta) * 0.5 * 0.0005, c, 1e-12);
  EXPECT_GT(mirror_part(theta, theta + 0.99 * half_angle), 0.0);
  EXPECT_EQ(mirror_part(theta, theta + 1.01 * half_angle), 0.0);
  EXPECT_EQ(mirror_part(theta, -theta), 0.0);
  // Not reciprocal across the cone, as LT's coherent part: cos_r/cos_i.
  const double there = mirror_part(theta, theta + 0.9 * half_angle);
  const double back = mirror_part(theta + 0.9 * half_angle, theta);
  EXPECT_NEAR(there / back, cos_deg(theta + 0.9 * half_angle) / cos_deg(theta), 1e-9);
  EXPECT_NEAR(1.0 - there / back, 0.020, 0.001);
}

TEST(Lafortune, AtEqualHeightsIsPhongsLobe) {
  std::mt19937_64 random(32);
  for (int trial = 0; trial < 200; ++trial) {
    const Pair p = make_pair(test::random_pair(random));
    if (p.cos_i <= 0.0 || p.cos_r <= 0.0 || p.mirror_distance2 > 1.99) continue;
    const double phong = neumann_neumann_lobe(std::log(7.0), p) * std::max(p.cos_i, p.cos_r);
    EXPECT_NEAR(lafortune_lobe(std::log(7.0), 0.0, p), phong, 1e-9 * phong);
  }
}

}  // namespace
}  // namespace goniofit
