#include "terms/effective_roughness.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <boost/math/tools/roots.hpp>

#include "geometry/angles.h"
#include "terms/lambert_w.h"
#include "terms/term_errors.h"

namespace goniofit {
namespace {

using namespace term_errors;
using Dual = ceres::Jet<double, 1>;

template <class F>
Big root_of(const F& f, const Big& low, const Big& high) {
  std::uintmax_t most = 500;
  const auto [a, b] =
      boost::math::tools::toms748_solve(f, low, high, boost::math::tools::eps_tolerance<Big>(160), most);
  return (a + b) / 2;
}

// W0 from its definition w e^w = z, as the root of w + ln w = ln z between bounds that hold for every z > 0.
Big lambert_of_log(const Big& log_z) {
  const Big above = log_z < 0 ? Big(exp(log_z)) : Big(1 + log_z);
  return root_of([&](const Big& w) { return Big(w + log(w) - log_z); }, Big(above / (4 + 4 * abs(log_z))),
                 Big(above * 2));
}

TEST(LambertW, IsTheRootFromTinyToHuge) {
  Errors plain, squared, slope;
  for (double exponent = -300.0; exponent <= 300.0; exponent += std::fabs(exponent) < 20.0 ? 0.37 : 7.3) {
    const double z = std::pow(10.0, exponent);
    const Big truth = lambert_of_log(log(Big(z)));
    plain.add(relative_error(lambert_w0(z), truth), place("z = %.3g", z));
    const Big derivative_truth = truth / (z * (1 + truth));
    slope.add(relative_error(lambert_w0(Dual(z, 0)).v[0], derivative_truth), place("z = %.3g", z));
    if (z < 1e-140) continue;  // k² underflows by itself
    squared.add(relative_error(lambert_w0_of_square(z), lambert_of_log(2 * log(Big(z)))), place("k = %.3g", z));
  }
  plain.print("W0(z)");
  squared.print("W0(k²)");
  slope.print("W0'(z)");
  EXPECT_LT(plain.worst(), 2e-15);
  EXPECT_LT(squared.worst(), 2e-15);
  EXPECT_LT(slope.worst(), 1e-14);
  EXPECT_EQ(lambert_w0(0.0), 0.0);
  EXPECT_EQ(lambert_w0(Dual(0.0, 0)).v[0], 1.0);
  EXPECT_EQ(lambert_w0_of_square(Dual(0.0, 0)).v[0], 0.0);
  // At 50 digits: the wide instance converges as far as its type.
  const Big w = lambert_w0(Big(3));
  EXPECT_LT(static_cast<double>(abs(w * exp(w) / 3 - 1)), 1e-48);
}

Big tangent(const Zenith& z) { return sqrt(Big(z.one_minus_c) * (1 + Big(z.c))) / Big(z.c); }

Big hidden_depth(const Big& slope, const Zenith& z) {
  const Big t = tangent(z);
  if (t == 0 || 1 / (2 * slope * t) > 1000) return 0;  // e^(-1e6)
  return t * erfc(1 / (2 * slope * t));
}

// HT (80) from its definition: zeta = z0/sigma is the root of √(π/2) zeta = (K_i + K_r)/4 e^(-zeta²/2).
Big log_effective_roughness_by_root(const Big& slope, const Zenith& i, const Zenith& r) {
  const Big k = (hidden_depth(slope, i) + hidden_depth(slope, r)) / 4;
  if (k == 0) return 0;
  const Big scale = sqrt(2 * atan(Big(1)));
  const Big high = std::min(Big(k / scale), Big(60));
  const Big zeta = root_of([&](const Big& x) { return Big(log(scale * x / k) + x * x / 2); },
                           std::min(Big(high / 4), Big("1e-3")), high);
  return -log1p(zeta * zeta) / 2;
}

// What a reader types: z0 by K² and W0 in double, the tangent from the angle.
double naive(double slope, const Zenith& i, const Zenith& r) {
  const auto depth = [slope](const Zenith& z) {
    const double t = std::tan(std::acos(z.c));
    return t * std::erfc(1.0 / (2.0 * slope * t));
  };
  const double k = depth(i) + depth(r);
  double w = std::log1p(k * k / (8.0 * pi));
  for (int n = 0; n < 100; ++n) w -= (w * std::exp(w) - k * k / (8.0 * pi)) / (std::exp(w) * (1.0 + w));
  return -0.5 * std::log1p(w);
}

TEST(HeEffectiveRoughness, IsTheRootOfItsDefinition) {
  Errors ordinary, hard, roughness;
  const std::vector<Zenith> all = zeniths(12);
  for (const Zenith& i : all) {
    for (const Zenith& r : all) {
      if (r.c > i.c) continue;
      for (const double slope : {1e-6, 1e-3, 0.05, 0.17, 1.0, 10.0}) {
        const std::string where = place("cos %.3g and %.3g, slope %g", i.c, r.c, slope);
        const double got = log_effective_roughness_he(slope, pair_of(i, r));
        ASSERT_TRUE(std::isfinite(got)) << where;
        const Big truth = log_effective_roughness_by_root(Big(slope), i, r);
        roughness.add(std::fabs(static_cast<double>(exp(got - truth) - 1)), where);
        roughness.add_naive(std::fabs(static_cast<double>(exp(Big(naive(slope, i, r)) - truth) - 1)), where);
        if (truth > -1e-280) continue;  // W0 of it underflows: 0
        (i.hard || r.hard ? hard : ordinary).add(relative_error(got, truth), where);
      }
    }
  }
  roughness.print("sigma_e/sigma, he");
  ordinary.print("ln(sigma_e/sigma), he, ordinary");
  hard.print("ln(sigma_e/sigma), he, hard corners");
  EXPECT_LT(roughness.worst(), 2e-15);
  EXPECT_LT(ordinary.worst(), 1e-12);
  EXPECT_LT(hard.worst(), 1e-12);
  EXPECT_FALSE(roughness.naive() < 1e-3);  // K² overflows at grazing
}

TEST(HeEffectiveRoughness, DerivativeIsRightAndFiniteEverywhere) {
  Errors ordinary, hard;
  const std::vector<Zenith> all = zeniths(8);
  for (const Zenith& i : all) {
    for (const Zenith& r : all) {
      if (r.c > i.c) continue;
      for (const double slope : {1e-6, 1e-3, 0.05, 0.17, 1.0, 10.0}) {
        const std::string where = place("cos %.3g and %.3g, slope %g", i.c, r.c, slope);
        const double got = log_effective_roughness_he(Dual(slope, 0), pair_of(i, r)).v[0];
        ASSERT_TRUE(std::isfinite(got)) << where;
        const Big truth = derivative([&](const Big& m) { return log_effective_roughness_by_root(m, i, r); }, slope);
        const Big scale = std::max(Big(abs(truth)), Big(1e-30 / slope));
        (i.hard || r.hard ? hard : ordinary).add(std::fabs(static_cast<double>((got - truth) / scale)), where);
      }
    }
  }
  ordinary.print("d ln(sigma_e/sigma)/d slope, ordinary");
  hard.print("d ln(sigma_e/sigma)/d slope, hard corners");
  EXPECT_LT(ordinary.worst(), 1e-9);
  EXPECT_LT(hard.worst(), 1e-6);
}

TEST(HeEffectiveRoughness, IsSigmaNearTheNormalAndTakesASlopeForEachDirection) {
  EXPECT_EQ(log_effective_roughness_he(0.1, make_pair(in_plane(0.0, 0.0))), 0.0);
  EXPECT_EQ(log_effective_roughness_he(1e-3, make_pair(in_plane(30.0, 30.0))), 0.0);
  const Pair p = make_pair(in_plane(80.0, 60.0));
  EXPECT_EQ(log_effective_roughness_he(0.2, 0.2, p), log_effective_roughness_he(0.2, p));
  const Pair q = make_pair(in_plane(60.0, 80.0));
  EXPECT_EQ(log_effective_roughness_he(0.1, 0.4, p), log_effective_roughness_he(0.4, 0.1, q));
}

TEST(HeEffectiveRoughness, TheWideInstanceIsAsWideAsItsType) {
  const Zenith z{0.25, 0.75, false};
  BasicPair<Big> p{};
  p.cos_i = p.cos_r = Big(z.c);
  p.one_minus_cos_i = p.one_minus_cos_r = Big(z.one_minus_c);
  const Big error = log_effective_roughness_he(Big(0.3), p) / log_effective_roughness_by_root(Big(0.3), z, z) - 1;
  EXPECT_LT(static_cast<double>(abs(error)), 1e-44);
}

TEST(LiTorranceEffectiveRoughness, IsAsFarFromHesAsTheHeaderSays) {
  const double slope = 0.5 / 3.0;
  const auto difference = [slope](double theta_i, double theta_r) {
    const Pair p = make_pair(in_plane(theta_i, theta_r));
    const double log_ratio =
        log_visible_part(1.0 / slope, p.log_one_minus_cos_i) + log_visible_part(1.0 / slope, p.log_one_minus_cos_r);
    return std::fabs(std::exp(log_ratio) - std::exp(log_effective_roughness_he(slope, p)));
  };
  double worst = 0.0;
  for (double i = 0.0; i <= 82.0; i += 1.0)
    for (double r = 0.0; r <= 82.0; r += 1.0) worst = std::max(worst, difference(i, r));
  std::printf("  sigma_e/sigma, li-torrance against he: %.4f up to 82°, %.4f at 85°/85°\n", worst, difference(85, 85));
  EXPECT_NEAR(worst, 0.018, 0.0005);
  EXPECT_NEAR(difference(85.0, 85.0), 0.076, 0.0005);
}

}  // namespace
}  // namespace goniofit
