#include "peers/rational_fraction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/angles.h"
#include "peers/approximation_quality.h"
#include "support/error.h"
#include "terms/fresnel.h"

namespace goniofit {
namespace {

void expect_coefficients(const std::vector<double>& ours, const std::vector<double>& expected) {
  ASSERT_EQ(ours.size(), expected.size());
  for (std::size_t i = 0; i < ours.size(); ++i)
    EXPECT_NEAR(ours[i], expected[i], 1e-12 * (1.0 + std::fabs(expected[i])));
}

void print(const char* what, const ApproximationError& e, double gain) {
  std::printf("%-34s epsilon %.2f %% (mean relative %.2f %%, max %.1f %%), gamma %.1f\n", what, 100.0 * e.mean_absolute,
              100.0 * e.mean_relative, 100.0 * e.max_relative, gain);
}

// (12), and what his epsilon means: 1.4 % is the mean absolute error, the relative one is 2.3 %.
TEST(RationalFraction, Sine) {
  const RationalApproximation f = schlick_sine();
  expect_coefficients(f.fraction.numerator, {0.0, 1.0, -4.0 / (pi * pi)});
  expect_coefficients(f.fraction.denominator, {1.0, 1.0 - 4.0 / pi});
  const auto exact = [](double x) { return std::sin(x); };
  const ApproximationError e = approximation_error(exact, f, 0.0, pi / 2);
  EXPECT_NEAR(e.mean_absolute, 0.0136, 0.0001);
  EXPECT_NEAR(e.mean_relative, 0.0228, 0.0001);
  const auto as_printed = [](double x) { return x * (pi * pi - 4.0 * x) / (pi * pi + (pi * pi - 4.0 * pi) * x); };
  EXPECT_NEAR(f(0.7), as_printed(0.7), 1e-14);
  print("(12) sine", e, speed_gain(exact, as_printed, 0.0, pi / 2));
}

// (15): the coefficients are those of (1 - u)⁵.
TEST(RationalFraction, FresnelShape) {
  const RationalApproximation f = schlick_fresnel_shape();
  expect_coefficients(f.fraction.numerator, {1.0, -5.0, 10.0, -10.0, 5.0, -1.0});
  const double n = 1.5;
  const double f0 = normal_reflectance(n, 0.0);
  const auto exact = [n](double u) { return fresnel_exact(n, 0.0, u, 1.0 - u); };
  const auto schlick = [f0](double u) { return fresnel_schlick(f0, 1.0 - u); };
  const ApproximationError e = approximation_error(exact, schlick, 0.0, 1.0);
  EXPECT_NEAR(e.mean_relative, 0.099, 0.002);    // not "under 1 %"
  EXPECT_NEAR(e.mean_absolute, 0.0129, 0.0003);  // what his measure makes of it
  const double gain = speed_gain(exact, schlick, 0.0, 1.0);
  EXPECT_GT(gain, 1.0);  // 10 where this was written; how much more is the machine's affair
  print("(15) Fresnel, n 1.5", e, gain);
}

// Smith's G as (18) prints it, without e^h, and as it is.
double smith(double v, double m, bool with_exponential) {
  const double h = v * v / (2.0 * m * m * (1.0 - v * v));
  const double g = std::sqrt(pi * h) * (2.0 - std::erfc(std::sqrt(h))) * (with_exponential ? std::exp(h) : 1.0);
  return std::isinf(g) ? 1.0 : g / (1.0 + g);
}

// (19) was tuned to the misprint.
TEST(RationalFraction, Attenuation) {
  const double slope = 0.4;
  const double k = std::sqrt(2.0 * slope * slope / pi);
  const RationalApproximation f = schlick_attenuation(slope);
  expect_coefficients(f.fraction.numerator, {0.0, 1.0 / k});
  expect_coefficients(f.fraction.denominator, {1.0, 1.0 / k - 1.0});
  for (const double m : {0.2, 0.4, 0.6, 1.0}) {
    const double k_m = std::sqrt(2.0 * m * m / pi);
    const auto as_printed = [k_m](double v) { return v / (v - k_m * v + k_m); };
    const auto misprint = [m](double v) { return smith(v, m, false); };
    const auto truth = [m](double v) { return smith(v, m, true); };
    EXPECT_NEAR(schlick_attenuation(m)(0.3), as_printed(0.3), 1e-14);
    const ApproximationError to_misprint = approximation_error(misprint, as_printed, 0.0, 1.0);
    const ApproximationError to_truth = approximation_error(truth, as_printed, 0.0, 1.0);
    std::printf("m %.1f: ", m);
    print("(19) G against (18) as printed", to_misprint, speed_gain(misprint, as_printed, 0.0, 1.0));
    std::printf("       ");
    print("(19) G against Smith's", to_truth, speed_gain(truth, as_printed, 0.0, 1.0));
    EXPECT_LT(to_truth.mean_relative, 0.13);
  }
}

// (21): the coefficients, the normalisation that was asked for, and the error against Beckmann's D.
TEST(RationalFraction, SlopeDistribution) {
  for (const double m : {0.05, 0.2, 0.5, 1.0}) {
    const SchlickSlopes d(m);
    expect_coefficients(d.by_square().fraction.numerator, {0.0, 0.5 / m});
    expect_coefficients(d.by_square().fraction.denominator, {1.0, (m - 1.0) / (m * m)});
    const auto as_printed = [m](double t) {
      const double x = t + m - 1.0;
      return x > 0.0 ? m * m * m * x / (t * std::pow(m * x * x - x * x + m * m, 2)) : 0.0;
    };
    double energy = 0.0;
    constexpr int n = 20000;
    for (int i = 0; i < n; ++i) {
      const double t = 1.0 - m + m * (i + 0.5) / n;
      EXPECT_NEAR(d(t), as_printed(t), 1e-11 * (1.0 + as_printed(t)));
      energy += 2.0 * t * d(t) * m / n;
    }
    EXPECT_NEAR(energy, 1.0, 1e-6) << m;
    EXPECT_NEAR(d(1.0), 1.0 / (m * m), 1e-9 / (m * m));
    EXPECT_EQ(d(1.0 - m), 0.0);
    EXPECT_EQ(d(std::max(0.0, 1.0 - 1.5 * m)), 0.0);
    const auto beckmann = [m](double t) { return std::exp((t * t - 1.0) / (m * m * t * t)) / (m * m * t * t * t * t); };
    ApproximationError e = approximation_error(beckmann, as_printed, 1.0 - m, 1.0);
    std::printf("m %.2f: (21) D against Beckmann, epsilon %.2f %% of the peak, gamma %.1f\n", m,
                100.0 * e.mean_absolute * m * m, speed_gain(beckmann, as_printed, 1.0 - m, 1.0));
    if (m <= 0.5) {
      EXPECT_LT(e.mean_absolute * m * m, 0.08) << m;
    }
  }
}

TEST(RationalFraction, RefusesConditionsThatDoNotDetermineIt) {
  const std::vector<KernelCondition> too_few{{0.0, 0, 1.0}, {1.0, 0, 2.0}};
  EXPECT_THROW(static_cast<void>(rational_approximation(too_few, 1, 1)), Error);
  const std::vector<KernelCondition> derivative_alone{{0.0, 1, 1.0}, {1.0, 0, 2.0}};
  EXPECT_THROW(static_cast<void>(rational_approximation(derivative_alone, 1, 0)), Error);
  const std::vector<KernelCondition> repeated{{0.5, 0, 1.0}, {0.5, 0, 1.0}};
  EXPECT_THROW(static_cast<void>(rational_approximation(repeated, 1, 0)), Error);
  EXPECT_THROW(SchlickSlopes(0.0), Error);
  EXPECT_THROW(SchlickSlopes(1.5), Error);
}

}  // namespace
}  // namespace goniofit
