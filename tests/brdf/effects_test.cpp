#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>

#include "brdf/evaluator.h"
#include "geometry/angles.h"
#include "support/materials.h"

namespace goniofit {
namespace {

using test::garnet_red_paint_13;
using test::ground_glass_41;
using test::laser_paper_73;

TEST(Effects, DdWithoutEffectiveRoughnessIsCookTorrance) {
  Material m = ground_glass_41();
  m.terms.effective_roughness = EffectiveRoughnessTier::none;
  m.components = {Effect::dd};
  const Evaluator e(m);
  const double slope = *m.surface.slope;
  for (const double theta_r : {-20.0, 10.0, 35.0, 70.0}) {
    const Pair p = make_pair(in_plane(40.0, theta_r));
    const double alpha2 = 4.0 * slope * slope;
    const double sec2 = 1.0 + p.tan2_b;
    const double d = std::exp(-p.tan2_b / alpha2) / (pi * alpha2) * sec2 * sec2;
    const double f0 = m.channels[0].normal_reflectance();
    const double f = f0 + (1.0 - f0) * std::pow(1.0 - p.cos_h, 5);
    const double s = (1.0 - std::pow(1.0 - p.cos_i, 1.0 / slope)) * (1.0 - std::pow(1.0 - p.cos_r, 1.0 / slope));
    const double expected = *m.channels[0].coefficient(Coefficient::k_dd) * f * s * d / (4.0 * p.cos_i * p.cos_r);
    EXPECT_NEAR(e.value(p, 0), expected, 1e-12 * expected);
  }
}

TEST(Effects, CoherentConeHoldsItsEnergy) {
  // Integrated over directions, coh must give k_dd F S e^(-g) whatever the cone's solid angle.
  Material m = test::smooth_aluminium_45();
  m.components = {Effect::coh};
  for (const double solid_angle : {1e-5, 5e-4}) {
    m.solid_angle_sr = solid_angle;
    const Evaluator e(m);
    for (const double theta : {0.0, 30.0, 60.0, 80.0}) {
      const Pair mirror = make_pair(in_plane(theta, theta));
      const double expected = e.value(mirror, 0) * mirror.cos_i * solid_angle;
      // Polar grid about the mirror direction, to beyond the cone's edge.
      const double half_angle = std::acos(1.0 - solid_angle / (2.0 * pi));
      double sum = 0.0;
      constexpr int rings = 400;
      constexpr int spokes = 64;
      for (int i = 0; i < rings; ++i) {
        const double a = 1.25 * half_angle * (i + 0.5) / rings;
        for (int j = 0; j < spokes; ++j) {
          const double b = 2.0 * pi * (j + 0.5) / spokes;
          const double ct = cos_deg(theta);
          const double st = sin_deg(theta);
          const double x = std::sin(a) * std::cos(b);
          const double vx = x * ct + std::cos(a) * st;
          const double vy = std::sin(a) * std::sin(b);
          const double vz = std::cos(a) * ct - x * st;
          if (vz <= 0.0) continue;
          const AnglePair pair{theta, 180.0, degrees(std::acos(std::min(1.0, vz))), degrees(std::atan2(vy, vx))};
          sum += e.value(make_pair(pair), 0) * vz * std::sin(a) * (1.25 * half_angle / rings) * (2.0 * pi / spokes);
        }
      }
      EXPECT_NEAR(sum / expected, 1.0, 0.01) << theta << " " << solid_angle;
    }
  }
}

TEST(Effects, CoherentPartFollowsItsFormula) {
  const Material m = test::smooth_aluminium_45();
  const Evaluator e(m);
  const Pair p = make_pair(in_plane(60.0, 60.0));
  const double slope = *m.surface.slope;
  const double q = 1.0 / slope;
  const double ratio = std::pow((1.0 - std::pow(0.5, 1.6 * q)) * (1.0 - std::pow(0.5, 1.6 * q)), 0.1 * q);
  const double phase = 2.0 * pi * *m.surface.sigma_um * ratio / *m.channels[0].wavelength_um * (p.cos_i + p.cos_r);
  const double f0 = m.channels[0].normal_reflectance();
  const double f = f0 + (1.0 - f0) * std::pow(0.5, 5);
  const double s = std::pow(1.0 - std::pow(0.5, q), 2);
  const double expected =
      *m.channels[0].coefficient(Coefficient::k_dd) * f * s * std::exp(-phase * phase) / (0.5 * m.solid_angle_sr);
  EXPECT_NEAR(e.value(p, 0, Effect::coh), expected, 1e-12 * expected);
  EXPECT_EQ(e.value(make_pair(in_plane(60.0, 61.0)), 0, Effect::coh), 0.0);
}

TEST(Effects, ForwardScatterHasNoImageOnTheRetroSide) {
  const Evaluator e(garnet_red_paint_13());
  for (double theta = 5.0; theta < 90.0; theta += 5.0) {
    if (theta >= 45.0) {  // nearer to the normal e^(-tan²) is below the smallest double
      EXPECT_GT(e.value(make_pair(in_plane(70.0, theta)), 0, Effect::fs), 0.0);
    }
    EXPECT_EQ(e.value(make_pair(in_plane(70.0, -theta)), 0, Effect::fs), 0.0);
  }
  EXPECT_EQ(e.value(make_pair(in_plane(0.0, 60.0)), 0, Effect::fs), 0.0);  // L = N
}

TEST(Effects, PrintedForwardScatterIsNotReciprocalAndTheOtherFormIs) {
  Material m = laser_paper_73();
  const auto worst_violation = [](const Material& material) {
    const Evaluator e(material);
    double difference = 0.0;
    double largest = 0.0;
    for (double i = 5.0; i < 90.0; i += 5.0) {
      for (double r = 5.0; r < 90.0; r += 5.0) {
        const double f = e.value(make_pair(in_plane(i, r)), 0, Effect::fs);
        const double g = e.value(make_pair(swapped(in_plane(i, r))), 0, Effect::fs);
        difference = std::max(difference, std::fabs(f - g));
        largest = std::max({largest, f, g});
      }
    }
    return difference / largest;
  };
  const double printed = worst_violation(m);
  EXPECT_NEAR(printed, 0.86, 0.02);
  m.forms.fs = FsForm::reciprocal;
  EXPECT_LT(worst_violation(m), 1e-13);
}

}  // namespace
}  // namespace goniofit
