#include "geometry/pair.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "geometry/angles.h"

namespace goniofit {
namespace {

struct Vector {
  double x, y, z;
};
Vector unit(double theta_deg, double phi_deg) {
  return {sin_deg(theta_deg) * cos_deg(phi_deg), sin_deg(theta_deg) * sin_deg(phi_deg), cos_deg(theta_deg)};
}

TEST(Pair, AgreesWithVectorsAtOrdinaryDirections) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> theta(1.0, 85.0);
  std::uniform_real_distribution<double> phi(-360.0, 360.0);
  for (int trial = 0; trial < 2000; ++trial) {
    const AnglePair a{theta(random), phi(random), theta(random), phi(random)};
    const Pair p = make_pair(a);
    const Vector l = unit(a.theta_i_deg, a.phi_i_deg);
    const Vector v = unit(a.theta_r_deg, a.phi_r_deg);
    const double sx = l.x + v.x;
    const double sy = l.y + v.y;
    const double sz = l.z + v.z;
    const double length = std::sqrt(sx * sx + sy * sy + sz * sz);
    EXPECT_NEAR(p.s_h2, sx * sx + sy * sy, 1e-14);
    EXPECT_NEAR(p.s_z, sz, 1e-15);
    EXPECT_NEAR(p.cos_h, (sx * v.x + sy * v.y + sz * v.z) / length, 1e-14);
    EXPECT_NEAR(p.one_minus_cos_h, 1.0 - p.cos_h, 1e-15);
    EXPECT_NEAR(p.tan2_b, (sx * sx + sy * sy) / (sz * sz), 1e-12 * (1.0 + p.tan2_b));
    // The mirror of L is (-l.x, -l.y, l.z).
    EXPECT_NEAR(p.mirror_distance2, sx * sx + sy * sy + (v.z - l.z) * (v.z - l.z), 1e-14);
    const double cos_f = -(v.x * l.x + v.y * l.y) / std::hypot(l.x, l.y);
    EXPECT_EQ(p.forward, cos_f > 0.0);
    if (cos_f > 1e-3) {
      EXPECT_NEAR(p.tan2_f, 1.0 / (cos_f * cos_f) - 1.0, 1e-8 * (1.0 + p.tan2_f));
    }
  }
}

TEST(Pair, MirrorDirectionIsExact) {
  for (const double theta : {0.0, 1e-6, 20.0, 45.0, 89.999999}) {
    const Pair p = make_pair(in_plane(theta, theta));
    EXPECT_EQ(p.tan2_b, 0.0) << theta;  // from a sum of vectors: 1e-32 over cos², which is 1e-16 at grazing
    EXPECT_EQ(p.mirror_distance2, 0.0) << theta;
    EXPECT_NEAR(p.cos_h, cos_deg(theta), 1e-15 * (1.0 + p.cos_h));
  }
}

TEST(Pair, RetroDirectionIsExact) {
  for (const double theta : {0.0, 1e-6, 33.3, 89.0}) {
    const Pair p = make_pair({theta, 10.0, theta, 10.0});
    EXPECT_EQ(p.one_minus_cos_h, 0.0) << theta;
    EXPECT_EQ(p.cos_h, 1.0) << theta;
    EXPECT_FALSE(p.forward);
  }
}

TEST(Pair, NearTheNormalNothingIsLost) {
  // 1 - cos(1e-7 deg) is 1.5e-18, below the round-off of 1 - cos itself.
  const Pair p = make_pair({1e-7, 0.0, 2e-7, 90.0});
  const double a = radians(1e-7);
  EXPECT_NEAR(p.one_minus_cos_i / (0.5 * a * a), 1.0, 1e-12);
  EXPECT_NEAR(p.log_one_minus_cos_i, std::log(0.5 * a * a), 1e-12);
  EXPECT_NEAR(p.s_h2 / (5.0 * a * a), 1.0, 1e-12);
  EXPECT_EQ(make_pair({0.0, 0.0, 5.0, 0.0}).log_one_minus_cos_i, log_of_zero);
}

TEST(Pair, ForwardAngleInPlaneIsTheComplementOfTheta) {
  for (double theta = 5.0; theta < 90.0; theta += 5.0) {
    const Pair p = make_pair(in_plane(40.0, theta));
    ASSERT_TRUE(p.forward);
    const double cot = cos_deg(theta) / sin_deg(theta);
    EXPECT_NEAR(p.tan2_f, cot * cot, 1e-13 * (1.0 + cot * cot));
    EXPECT_FALSE(make_pair(in_plane(40.0, -theta)).forward);
  }
}

TEST(Pair, SwappingExchangesTheTwoSides) {
  const AnglePair a{20.0, 15.0, 70.0, 190.0};
  const Pair p = make_pair(a);
  const Pair q = make_pair(swapped(a));
  EXPECT_EQ(p.cos_i, q.cos_r);
  EXPECT_EQ(p.one_minus_cos_r, q.one_minus_cos_i);
  EXPECT_EQ(p.tan2_f, q.tan2_f_swapped);
  EXPECT_NEAR(p.s_h2, q.s_h2, 1e-15);
  EXPECT_NEAR(p.cos_h, q.cos_h, 1e-15);
}

TEST(Pair, BatchGivesBackWhatItWasGiven) {
  const std::vector<AnglePair> angles{{10, 0, 20, 180}, {0, 0, 0, 0}, {80, 5, 85, 100}};
  const PairBatch batch(angles);
  const PairBatch part = batch.subset({2, 0});
  ASSERT_EQ(batch.size(), 3U);
  ASSERT_EQ(part.size(), 2U);
  const Pair expected = make_pair(angles[2]);
  const Pair got = part[0];
  EXPECT_EQ(got.tan2_b, expected.tan2_b);
  EXPECT_EQ(got.tan2_f, expected.tan2_f);
  EXPECT_EQ(got.forward, expected.forward);
  EXPECT_EQ(got.log_one_minus_cos_r, expected.log_one_minus_cos_r);
  EXPECT_EQ(got.mirror_distance2, expected.mirror_distance2);
}

}  // namespace
}  // namespace goniofit
