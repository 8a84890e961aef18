#include <gtest/gtest.h>

#include <boost/math/special_functions/lambert_w.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>

#include "brdf/effects.h"
#include "geometry/angles.h"

namespace goniofit {
namespace {

using Big = boost::multiprecision::cpp_bin_float_50;

TEST(Shadowing, IsOneMinusAPowerAndFiniteOverCosines) {
  for (const double q : {0.1, 1.0, 5.85, 100.0, 1e6}) {
    for (const double theta : {0.0, 10.0, 45.0, 80.0, 89.0}) {
      const Pair p = make_pair(in_plane(theta, theta));
      EXPECT_NEAR(shadowing_li_torrance(q, p.log_one_minus_cos_i), 1.0 - std::pow(1.0 - cos_deg(theta), q), 1e-12);
    }
    // S1(c)/c -> q: what the naive 1 - (1-c)^q loses at grazing altogether.
    const Pair grazing = make_pair(in_plane(89.9999999999, 89.9999999999));
    const double per_side = std::sqrt(shadowing_over_cosines<ShadowingTier::li_torrance>(q, grazing));
    EXPECT_NEAR(per_side / q, 1.0, 1e-5) << q;
  }
  const Pair p = make_pair(in_plane(60.0, 60.0));
  EXPECT_NEAR(shadowing_over_cosines<ShadowingTier::none>(3.0, p), 4.0, 1e-14);
}

// He et al. 1991 (80): sigma_e/sigma = 1/sqrt(1 + W0(K²/8pi)), K = K_i + K_r.
double he_effective_roughness(double slope, double theta_i_deg, double theta_r_deg) {
  const auto k = [slope](double theta) {
    if (theta == 0.0) return 0.0;
    const double tangent = std::tan(radians(theta));
    return tangent * std::erfc(1.0 / (2.0 * slope * tangent));
  };
  const double sum = k(theta_i_deg) + k(theta_r_deg);
  return 1.0 / std::sqrt(1.0 + boost::math::lambert_w0(sum * sum / (8.0 * pi)));
}

TEST(EffectiveRoughness, IsAsFarFromTheExactOneAsTheHeaderSays) {
  const double slope = 0.5 / 3.0;
  const auto ours = [slope](double theta_i, double theta_r) {
    return std::exp(log_effective_roughness<EffectiveRoughnessTier::li_torrance>(
        1.0 / slope, make_pair(in_plane(theta_i, theta_r))));
  };
  double worst = 0.0;
  for (double i = 0.0; i <= 82.0; i += 2.0) {
    for (double r = 0.0; r <= 82.0; r += 2.0)
      worst = std::max(worst, std::fabs(ours(i, r) - he_effective_roughness(slope, i, r)));
  }
  EXPECT_LT(worst, 0.0185);
  EXPECT_GT(worst, 0.010);
  EXPECT_NEAR(std::fabs(ours(85, 85) - he_effective_roughness(slope, 85, 85)), 0.076, 0.002);
}

TEST(SlopeDistribution, IsBeckmannInLiTorrancesNormalisation) {
  for (const double slope : {0.02, 0.17, 0.6}) {
    for (const double theta_r : {-40.0, 0.0, 25.0, 30.0, 60.0}) {
      const Pair p = make_pair(in_plane(30.0, theta_r));
      const double alpha2 = 4.0 * slope * slope;
      const double cos4 = 1.0 / ((1.0 + p.tan2_b) * (1.0 + p.tan2_b));
      const double beckmann = std::exp(-p.tan2_b / alpha2) / (pi * alpha2 * cos4);
      const double d = slope_independent_factor(p) * std::exp(rough_limit_log(std::log(slope), p));
      EXPECT_NEAR(d, 0.25 * pi * beckmann, 1e-12 * d);
    }
  }
}

// The same template at 50 digits, from the same double-precision geometry: round-off of the formula alone.
template <EffectiveRoughnessTier roughness>
double dd_error(double slope, const AnglePair& angles) {
  const Pair p = make_pair(angles);
  const double f = dd_shape(surface_terms<ShadowingTier::li_torrance, roughness>(std::log(slope), 1.0 / slope, p), p);
  const Big m(slope);
  const Big truth = dd_shape(surface_terms<ShadowingTier::li_torrance, roughness>(Big(log(m)), Big(1 / m), p), p);
  if (truth < Big("1e-300")) return 0.0;
  return std::fabs(static_cast<double>((f - truth) / truth)) / (1.0 + std::fabs(static_cast<double>(log(truth))));
}

TEST(DirectionalDiffuse, RoundOffStaysSmallInHardCorners) {
  // Each corner with what a naive form does there.
  const std::vector<AnglePair> corners{
      in_plane(0.0, 0.0),               // ln(1 - cos) is infinite
      in_plane(1e-6, 1e-6),             // 1 - cos is 0 after rounding
      in_plane(45.0, 45.0),             // the mirror: tan² from acos is 1e-16 instead of 0
      in_plane(45.0, 45.0001),          // next to it
      in_plane(89.0, 89.0),             // sigma_e small: 1/m_e² large
      in_plane(89.9, 10.0),             // one grazing: S/c is 0/0
      in_plane(30.0, -30.0),            // retro
      AnglePair{60.0, 0.0, 60.0, 90.0}  // out of the plane
  };
  double worst = 0.0;
  for (const double slope : {1e-6, 1e-3, 0.01, 0.17, 1.0, 10.0}) {
    for (const AnglePair& a : corners) {
      const double error = dd_error<EffectiveRoughnessTier::li_torrance>(slope, a);
      EXPECT_LT(error, slope < 1e-3 ? 1e-9 : 1e-12) << slope << " at " << a.theta_i_deg << ", " << a.theta_r_deg;
      worst = std::max(worst, error);
    }
  }
  RecordProperty("worst_relative_error_over_1_plus_ln_f", std::to_string(worst));
}

}  // namespace
}  // namespace goniofit
