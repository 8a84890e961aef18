// A batch is made of the same numbers as its pairs, and both of sines and cosines right to 1 eps.

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "geometry/angles.h"
#include "geometry/lane_angles.h"
#include "geometry/pair.h"

namespace goniofit {
namespace {

using Wide = boost::multiprecision::cpp_bin_float_50;

constexpr double eps = std::numeric_limits<double>::epsilon();

std::vector<double> hard_angles() {
  std::vector<double> all{0.0,       1e-300,        1e-160, 1e-12, 30.0, 45.0, 60.0, 89.99999999999999,
                          1e6 + 0.1, 123456789.123, 9e14};
  for (double d = 0.0; d <= 720.0; d += 7.5) {
    for (const double near : {d, std::nextafter(d, 1e9), std::nextafter(d, -1e9), d + 1e-9}) all.push_back(near);
  }
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> angle(0.0, 360.0);
  for (int k = 0; k < 2000; ++k) all.push_back(angle(random));
  const std::size_t n = all.size();
  for (std::size_t k = 0; k < n; ++k) all.push_back(-all[k]);
  return all;
}

TEST(LaneAngles, SineAndCosineAreRightToTheLastDigit) {
  const Wide turn = boost::math::constants::two_pi<Wide>();
  for (const double d : hard_angles()) {
    const auto [sine, cosine] = sine_cosine_deg(Lane<double>(d));
    const Wide x = Wide(std::remainder(d, 360.0)) / 360 * turn;
    const double true_sine = static_cast<double>(Wide(sin(x)));
    const double true_cosine = static_cast<double>(Wide(cos(x)));
    if (std::fabs(true_sine) > 1e-30) {
      EXPECT_LE(std::fabs(sine.v - true_sine), eps * std::fabs(true_sine)) << d;
    }
    if (std::fabs(true_cosine) > 1e-30) {
      EXPECT_LE(std::fabs(cosine.v - true_cosine), eps * std::fabs(true_cosine)) << d;
    }
    EXPECT_NEAR(sine.v, sin_deg(d), eps * std::fabs(sine.v)) << d;
    EXPECT_NEAR(cosine.v, cos_deg(d), eps * std::fabs(cosine.v)) << d;
  }
}

TEST(LaneAngles, ExactWhereTheValueIs) {
  const auto at = [](double d) { return sine_cosine_deg(Lane<double>(d)); };
  for (const double turns : {-720.0, 0.0, 360.0, 3.6e14}) {
    EXPECT_EQ(at(turns).sine.v, 0.0);
    EXPECT_EQ(at(turns).cosine.v, 1.0);
    EXPECT_EQ(at(turns + 30.0).sine.v, 0.5);
    EXPECT_EQ(at(turns + 60.0).cosine.v, 0.5);
    EXPECT_EQ(at(turns + 90.0).sine.v, 1.0);
    EXPECT_EQ(at(turns + 90.0).cosine.v, 0.0);
    EXPECT_FALSE(std::signbit(at(turns + 90.0).cosine.v));
    EXPECT_EQ(at(turns + 150.0).sine.v, 0.5);
    EXPECT_EQ(at(turns + 180.0).cosine.v, -1.0);
    EXPECT_EQ(at(turns + 240.0).cosine.v, -0.5);
    EXPECT_EQ(at(turns + 270.0).sine.v, -1.0);
  }
}

std::vector<AnglePair> hard_pairs() {
  std::vector<AnglePair> all;
  const std::vector<double> zeniths{0.0, 1e-160, 1e-154, 1e-7, 20.0, 30.0, 60.0, 89.0, 89.99999999, 90.0, 95.0};
  const std::vector<double> azimuths{0.0, -0.0, 1e-13, 30.0, 90.0, 180.0, 359.9999999, -725.25, 1e7, 3e15, 1e17};
  for (const double ti : zeniths) {
    for (const double tr : zeniths) {
      for (const double pi : azimuths) {
        for (const double pr : azimuths) all.push_back({ti, pi, tr, pr});
      }
    }
  }
  return all;
}

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

// Of any length and from any place, so that vectors and what is left over meet all of them.
TEST(PairBatch, HasTheBitsOfItsPairs) {
  const std::vector<AnglePair> all = hard_pairs();
  for (std::size_t first = 0; first < 40; ++first) {
    const std::vector<AnglePair> some(all.begin() + static_cast<std::ptrdiff_t>(first),
                                      first == 0 ? all.end() : all.begin() + static_cast<std::ptrdiff_t>(2 * first));
    const PairBatch batch(some);
    ASSERT_EQ(batch.size(), some.size());
    for (std::size_t j = 0; j < some.size(); ++j) {
      const Pair a = batch[j];
      const Pair b = make_pair(some[j]);
      for (const auto member : {&Pair::cos_i,
                                &Pair::cos_r,
                                &Pair::one_minus_cos_i,
                                &Pair::one_minus_cos_r,
                                &Pair::log_one_minus_cos_i,
                                &Pair::log_one_minus_cos_r,
                                &Pair::s_z,
                                &Pair::s_h2,
                                &Pair::cos_h,
                                &Pair::one_minus_cos_h,
                                &Pair::tan2_b,
                                &Pair::mirror_distance2,
                                &Pair::tan2_f,
                                &Pair::tan2_f_swapped,
                                &Pair::dot_h,
                                &Pair::s_x2,
                                &Pair::s_y2,
                                &Pair::cos2_phi_i,
                                &Pair::sin2_phi_i,
                                &Pair::cos2_phi_r,
                                &Pair::sin2_phi_r}) {
        ASSERT_TRUE(same_bits(a.*member, b.*member) || (std::isnan(a.*member) && std::isnan(b.*member)))
            << some[j].theta_i_deg << " " << some[j].phi_i_deg << " " << some[j].theta_r_deg << " " << some[j].phi_r_deg
            << ": " << a.*member << " " << b.*member;
      }
      ASSERT_EQ(a.forward, b.forward);
    }
  }
}

TEST(Pair, LogarithmNextToTheNormal) {
  for (const double theta : {1e-7, 1e-100, 1e-153, 2e-153, 1e-154}) {
    const Pair p = make_pair({theta, 0.0, 10.0, 0.0});
    const Wide half = sin(Wide(theta) * boost::math::constants::pi<Wide>() / 360);
    // 1 - cos may be a denormal number, rounded to the spacing of those.
    const double denormal = std::numeric_limits<double>::denorm_min() / p.one_minus_cos_i;
    EXPECT_NEAR(p.log_one_minus_cos_i, static_cast<double>(Wide(log(2 * half * half))), 2e-13 + denormal) << theta;
  }
}

}  // namespace
}  // namespace goniofit
