// Pairs made from unit vectors against pairs made from angles.

#include "geometry/direction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "geometry/angles.h"

namespace goniofit {
namespace {

Pair by_directions(const AnglePair& a) {
  return make_pair(direction_of(a.theta_i_deg, a.phi_i_deg), direction_of(a.theta_r_deg, a.phi_r_deg));
}

// tolerance: of lengths, 1 unless their squares are small.
void expect_same(const Pair& p, const Pair& q, double tolerance) {
  EXPECT_NEAR(p.cos_i, q.cos_i, tolerance);
  EXPECT_NEAR(p.cos_r, q.cos_r, tolerance);
  EXPECT_NEAR(p.one_minus_cos_i, q.one_minus_cos_i, tolerance * std::sqrt(q.one_minus_cos_i));
  EXPECT_NEAR(p.one_minus_cos_r, q.one_minus_cos_r, tolerance * std::sqrt(q.one_minus_cos_r));
  EXPECT_NEAR(p.s_z, q.s_z, tolerance);
  EXPECT_NEAR(p.s_h2, q.s_h2, tolerance * std::sqrt(q.s_h2) + tolerance * tolerance);
  EXPECT_NEAR(p.s_x2, q.s_x2, tolerance * std::sqrt(q.s_h2) + tolerance * tolerance);
  EXPECT_NEAR(p.s_y2, q.s_y2, tolerance * std::sqrt(q.s_h2) + tolerance * tolerance);
  EXPECT_NEAR(p.mirror_distance2, q.mirror_distance2,
              tolerance * std::sqrt(q.mirror_distance2) + tolerance * tolerance);
  EXPECT_NEAR(p.cos_h, q.cos_h, tolerance);
  EXPECT_NEAR(p.one_minus_cos_h, q.one_minus_cos_h, tolerance * std::sqrt(q.one_minus_cos_h) + tolerance * tolerance);
  EXPECT_NEAR(p.dot_h, q.dot_h, tolerance);
}

class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}
  AnglePair angles() { return {theta_(random_), phi_(random_), theta_(random_), phi_(random_)}; }

 private:
  std::mt19937_64 random_;
  std::uniform_real_distribution<double> theta_{1.0, 89.0}, phi_{-180.0, 180.0};
};

TEST(Direction, PairIsThatOfTheAngles) {
  Draw draw(3);
  for (int i = 0; i < 2000; ++i) {
    const AnglePair a = draw.angles();
    const Pair p = by_directions(a);
    const Pair q = make_pair(a);
    expect_same(p, q, 3e-15);
    EXPECT_NEAR(p.tan2_b, q.tan2_b, 1e-12 * (1.0 + q.tan2_b));
    EXPECT_NEAR(p.log_one_minus_cos_i, q.log_one_minus_cos_i, 1e-12);
    EXPECT_NEAR(p.log_one_minus_cos_r, q.log_one_minus_cos_r, 1e-12);
    EXPECT_NEAR(p.cos2_phi_i, q.cos2_phi_i, 1e-14);
    EXPECT_NEAR(p.sin2_phi_r, q.sin2_phi_r, 1e-14);
    EXPECT_EQ(p.forward, q.forward);
    if (!p.forward) continue;
    EXPECT_NEAR(p.tan2_f / q.tan2_f, 1.0, 1e-13 * (2.0 + std::sqrt(q.tan2_f)));
    EXPECT_NEAR(p.tan2_f_swapped / q.tan2_f_swapped, 1.0, 1e-13 * (2.0 + std::sqrt(q.tan2_f)));
  }
}

// The errors are those of the components, 1e-16 of a length, and no cancellation comes on top.
TEST(Direction, PairIsAccurateNearMirrorAndRetro) {
  for (const double theta : {0.5, 20.0, 60.0, 89.0}) {
    for (const double off : {0.0, 1e-12, 1e-8, 1e-4, 1e-2}) {
      for (const double turn : {0.0, 180.0}) {
        const AnglePair a{theta, 40.0, theta + off, 40.0 + turn + off};
        expect_same(by_directions(a), make_pair(a), 5e-16);
      }
    }
  }
}

TEST(Direction, AnglesThereAndBack) {
  for (const double theta : {0.0, 1e-9, 30.0, 89.999999, 90.0, 120.0}) {
    for (const double phi : {-179.0, 0.0, 90.0, 180.0}) {
      const AnglePair a = angles_of(direction_of(theta, phi), direction_of(45.0, -30.0));
      EXPECT_NEAR(a.theta_i_deg, theta, 1e-13);
      EXPECT_NEAR(a.phi_i_deg, theta > 0.0 ? phi : 0.0, 1e-13);
      EXPECT_NEAR(a.theta_r_deg, 45.0, 1e-13);
      EXPECT_NEAR(a.phi_r_deg, -30.0, 1e-13);
    }
  }
}

TEST(Direction, MirrorLiesOpposite) {
  const Direction l = direction_of(50.0, 20.0);
  const Pair p = make_pair(l, mirrored(l));
  EXPECT_EQ(p.s_h2, 0.0);
  EXPECT_EQ(p.mirror_distance2, 0.0);
  EXPECT_EQ(p.tan2_b, 0.0);
  EXPECT_TRUE(p.forward);
  EXPECT_EQ(make_pair(l, l).one_minus_cos_h, 0.0);
}

TEST(Direction, NormalHasNoForwardSide) {
  const Pair p = make_pair(Direction{}, direction_of(70.0, 130.0));
  EXPECT_FALSE(p.forward);
  EXPECT_EQ(p.log_one_minus_cos_i, log_of_zero);
  EXPECT_EQ(p.cos2_phi_i, 1.0);
  // So near the normal that squares underflow: still no forward side, and nothing that is not finite.
  const Pair q = make_pair({1e-200, 0.0, 1.0}, direction_of(70.0, 180.0));
  EXPECT_FALSE(q.forward);
  EXPECT_TRUE(std::isfinite(q.tan2_f) && std::isfinite(q.tan2_f_swapped));
}

}  // namespace
}  // namespace goniofit
