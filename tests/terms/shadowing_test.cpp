#include "terms/shadowing.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include "terms/term_errors.h"

namespace goniofit {
namespace {

using namespace term_errors;
using Dual = ceres::Jet<double, 1>;

// HT (24), (25) as they stand (with the e^(-a²)), at 50 digits.
Big smith_over_cosine(const Big& slope, const Zenith& z) {
  const Big c(z.c);
  const Big s = sqrt(Big(z.one_minus_c) * (1 + c));
  if (s == 0) return 1 / c;
  const Big a = c / (2 * slope * s);
  if (a > 1000) return 1 / c;  // e^(-a²) is beyond 400 000 digits
  const Big root_pi = sqrt(4 * atan(Big(1)));
  const Big lambda = (exp(-a * a) / (a * root_pi) - erfc(a)) / 2;
  return (1 - erfc(a) / 2) / (1 + lambda) / c;
}

// The same in double, the cotangent from the angle: what a reader of the paper would type.
template <class T>
T naive_smith_over_cosine(const T& slope, const Zenith& z) {
  using std::erfc, std::exp;
  const T a = 1.0 / (2.0 * slope * std::tan(std::acos(z.c)));
  const T lambda = 0.5 * (exp(-a * a) / (a * std::sqrt(std::acos(-1.0))) - erfc(a));
  return (1.0 - 0.5 * erfc(a)) / (1.0 + lambda) / z.c;
}

TEST(SmithShadowing, IsItsDefinitionFromTheNormalToGrazing) {
  Errors ordinary, hard;
  for (const Zenith& z : zeniths(48)) {
    for (const double slope : slopes) {
      const Big truth = smith_over_cosine(Big(slope), z);
      Errors& errors = z.hard ? hard : ordinary;
      const std::string where = place("cos %.3g, slope %g", z.c, slope);
      errors.add(relative_error(shadowing_smith_over_cosine(slope, z.c, z.s()), truth), where);
      errors.add_naive(relative_error(naive_smith_over_cosine(slope, z), truth), where);
    }
  }
  ordinary.print("S1/c, smith, ordinary");
  hard.print("S1/c, smith, hard corners");
  EXPECT_LT(ordinary.worst(), 2e-15);
  EXPECT_LT(hard.worst(), 2e-15);
  EXPECT_GT(hard.naive(), 1e-3);  // tan(acos(c)) has no digits at grazing: why S1/c takes sine and cosine
}

TEST(SmithShadowing, DerivativeIsRightAndFiniteEverywhere) {
  Errors ordinary, hard;
  bool naive_fails_at_the_normal = false;
  for (const Zenith& z : zeniths(48)) {
    for (const double slope : slopes) {
      const double got = shadowing_smith_over_cosine(Dual(slope, 0), z.c, z.s()).v[0];
      ASSERT_TRUE(std::isfinite(got)) << z.c << " " << slope;
      const Big truth = derivative([&](const Big& m) { return smith_over_cosine(m, z); }, slope);
      // A derivative below 1e-30 of S1/c itself is as good as 0.
      const Big scale = std::max(Big(abs(truth)), Big(1e-30 / z.c / slope));
      const double error = std::fabs(static_cast<double>((got - truth) / scale));
      (z.hard ? hard : ordinary).add(error, place("cos %.3g, slope %g", z.c, slope));
      if (z.c == 1.0) naive_fails_at_the_normal |= !std::isfinite(naive_smith_over_cosine(Dual(slope, 0), z).v[0]);
    }
  }
  ordinary.print("d(S1/c)/d slope, smith, ordinary");
  hard.print("d(S1/c)/d slope, smith, hard corners");
  EXPECT_LT(ordinary.worst(), 1e-9);
  EXPECT_LT(hard.worst(), 1e-6);
  EXPECT_TRUE(naive_fails_at_the_normal);
}

TEST(SmithShadowing, HasItsLimits) {
  // S1 = √π a at grazing, so S1/c -> √π/(2 m).
  for (const double slope : slopes)
    EXPECT_NEAR(shadowing_smith_over_cosine(slope, 1e-300, 1.0) * 2.0 * slope / math::root_pi_of<double>(), 1.0, 1e-15);
  EXPECT_EQ(shadowing_smith_over_cosine(0.3, 1.0, 0.0), 1.0);
}

TEST(SmithShadowing, TheWideInstanceIsAsWideAsItsType) {
  const Zenith z{0.25, 0.75, false};
  const Big s = sqrt(Big(0.75) * Big(1.25));
  const Big error = shadowing_smith_over_cosine(Big(0.3), Big(0.25), s) / smith_over_cosine(Big(0.3), z) - 1;
  EXPECT_LT(static_cast<double>(abs(error)), 1e-47);
}

struct Spread {
  double mean, largest;
};

// Relative error against tier smith over uniform cosines.
template <class F>
Spread against_smith(double slope, const F& over_cosine) {
  constexpr int steps = 20000;
  Spread out{0.0, 0.0};
  for (int i = 0; i < steps; ++i) {
    const double c = (i + 0.5) / steps;
    const double error =
        std::fabs(over_cosine(slope, c) / shadowing_smith_over_cosine(slope, c, sine(c, 1.0 - c)) - 1.0);
    out.mean += error / steps;
    out.largest = std::max(out.largest, error);
  }
  return out;
}

TEST(ShadowingTiers, AreAsFarFromSmithAsTheHeaderSays) {
  double schlick_low = 1.0, schlick_high = 0.0, schlick_least = 1.0, schlick_most = 0.0;
  double lt_low = 1.0, lt_high = 0.0, lt_most = 0.0;
  for (const double rms_slope : {0.05, 0.1, 0.2, 0.3, 0.4, 0.5}) {
    const double slope = rms_slope / std::sqrt(2.0);
    const Spread schlick = against_smith(slope, [](double m, double c) { return shadowing_schlick_over_cosine(m, c); });
    const Spread lt =
        against_smith(slope, [](double m, double c) { return shadowing_li_torrance(1.0 / m, std::log1p(-c)) / c; });
    std::printf("  RMS slope %4.2f: schlick mean %4.1f %%, max %4.1f %%; li-torrance mean %4.1f %%, max %4.1f %%\n",
                rms_slope, 100 * schlick.mean, 100 * schlick.largest, 100 * lt.mean, 100 * lt.largest);
    schlick_low = std::min(schlick_low, schlick.mean);
    schlick_high = std::max(schlick_high, schlick.mean);
    schlick_least = std::min(schlick_least, schlick.largest);
    schlick_most = std::max(schlick_most, schlick.largest);
    lt_low = std::min(lt_low, lt.mean);
    lt_high = std::max(lt_high, lt.mean);
    lt_most = std::max(lt_most, lt.largest);
  }
  EXPECT_NEAR(schlick_low, 0.07, 0.005);
  EXPECT_NEAR(schlick_high, 0.12, 0.005);
  EXPECT_NEAR(schlick_least, 0.14, 0.005);
  EXPECT_NEAR(schlick_most, 0.27, 0.005);
  EXPECT_NEAR(lt_low, 0.005, 0.0005);
  EXPECT_NEAR(lt_high, 0.05, 0.003);
  EXPECT_NEAR(lt_most, 0.128, 0.001);
  const Spread rough =
      against_smith(1.0, [](double m, double c) { return shadowing_li_torrance(1.0 / m, std::log1p(-c)) / c; });
  EXPECT_NEAR(rough.mean, 0.13, 0.005);
  EXPECT_NEAR(rough.largest, 0.195, 0.002);
}

TEST(SchlickShadowing, IsEquationNineteenWithTheConvertedSlope) {
  for (const Zenith& z : zeniths(16)) {
    for (const double slope : slopes) {
      const Big v(z.c);
      const Big m = sqrt(Big(2)) * slope;  // his m is the RMS slope
      const Big k = sqrt(2 * m * m / (4 * atan(Big(1))));
      const Big truth = 1 / (v - k * v + k);
      EXPECT_LT(relative_error(shadowing_schlick_over_cosine(slope, z.c), truth), 1e-15) << z.c << " " << slope;
      const Big slope_derivative = -(1 - v) * k / slope * truth * truth;
      const double got = shadowing_schlick_over_cosine(Dual(slope, 0), z.c).v[0];
      EXPECT_LT(std::fabs(static_cast<double>(got - slope_derivative)),
                1e-12 * static_cast<double>(abs(slope_derivative)) + 1e-300);
    }
  }
}

}  // namespace
}  // namespace goniofit
