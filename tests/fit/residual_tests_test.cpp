#include "fit/residual_tests.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace goniofit {
namespace {

std::vector<double> gaussian(std::mt19937_64& random, std::size_t n) {
  std::normal_distribution<double> normal;
  std::vector<double> out(n);
  for (double& x : out) x = normal(random);
  return out;
}

TEST(RunsTest, CountsRunsByHand) {
  RunsTest runs;
  runs.add_line({1, 2, -1, 0, -3, 4});  // ++ -- +
  runs.add_line({0, 0});                // no sign, no line
  runs.add_line({-1, -1, -1});
  EXPECT_EQ(runs.lines, 2U);
  EXPECT_EQ(runs.readings, 8U);
  EXPECT_EQ(runs.runs, 4U);
  EXPECT_EQ(runs.comparisons(), 6U);
  EXPECT_EQ(runs.expected_runs(), 5.0);
  // Two changes or fewer in six throws: (1 + 6 + 15) / 64.
  EXPECT_NEAR(runs.p(), 22.0 / 64.0, 1e-14);
  EXPECT_FALSE(runs.testable());
}

TEST(RunsTest, ExtremesHaveTheirProbabilities) {
  RunsTest alternating;
  alternating.add_line({1, -1, 1, -1});
  EXPECT_EQ(alternating.p(), 1.0);
  RunsTest constant;
  constant.add_line(std::vector<double>(31, -0.5));
  EXPECT_NEAR(constant.p(), std::ldexp(1.0, -30), 1e-22);
  EXPECT_TRUE(constant.testable());
  EXPECT_EQ(RunsTest{}.p(), 1.0);
}

TEST(RunsTest, LinesOfOneReadingSpeakForNothing) {
  RunsTest runs;
  for (int i = 0; i < 100; ++i) runs.add_line({1.0});
  runs.add_line(std::vector<double>(22, 1.0));
  EXPECT_EQ(runs.comparisons(), 21U);
  EXPECT_FALSE(runs.testable()) << "121 readings, of which 21 have a neighbour";
}

// Under noise P(p <= a) = a but for the steps of a discrete count, which only lower it. 4000 trials: standard
// deviation 0.008 at most.
TEST(RunsTest, IsUniformOnNoise) {
  std::mt19937_64 random(20260301);
  constexpr int trials = 4000;
  std::vector<double> p;
  for (int t = 0; t < trials; ++t) {
    RunsTest runs;
    for (std::size_t line = 0; line < 12; ++line) runs.add_line(gaussian(random, 5 + 20 * line));
    p.push_back(runs.p());
  }
  std::sort(p.begin(), p.end());
  for (const double a : {0.01, 0.05, 0.25, 0.5, 0.75, 0.95}) {
    const auto below = static_cast<double>(std::upper_bound(p.begin(), p.end(), a) - p.begin()) / trials;
    EXPECT_LE(below, a + 3.0 * std::sqrt(a * (1.0 - a) / trials)) << a;
    EXPECT_GE(below, a - 0.03 - 3.0 * std::sqrt(a * (1.0 - a) / trials)) << a;
  }
}

TEST(RunsTest, FindsASlowWaveUnderNoise) {
  std::mt19937_64 random(5);
  RunsTest runs;
  for (int line = 0; line < 6; ++line) {
    std::vector<double> r = gaussian(random, 60);
    for (std::size_t i = 0; i < r.size(); ++i) r[i] += 1.5 * std::sin(0.1 * static_cast<double>(i));
    runs.add_line(r);
  }
  EXPECT_LT(runs.p(), 1e-6);
}

TEST(ReducedChiSquare, HasTheTabulatedRange) {
  const ReducedChiSquare chi = reduced_chi_square(12.0, 10);
  EXPECT_DOUBLE_EQ(chi.value, 1.2);
  EXPECT_NEAR(chi.low, 0.3247, 5e-5);   // 3.247 / 10
  EXPECT_NEAR(chi.high, 2.0483, 5e-5);  // 20.483 / 10
}

TEST(Median, IsTheLowerMiddle) {
  std::vector<double> odd{3, 1, 2};
  std::vector<double> even{4, 1, 3, 2};
  EXPECT_EQ(median_of(odd), 2.0);
  EXPECT_EQ(median_of(even), 2.0);
}

}  // namespace
}  // namespace goniofit
