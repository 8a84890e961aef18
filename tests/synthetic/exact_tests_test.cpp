#include "synthetic/exact_tests.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace goniofit {
namespace {

// Limits as printed in tables of exact binomial limits (Documenta Geigy; Clopper & Pearson 1934, 95 %).
TEST(ExactLimits, AreThoseOfTheTables) {
  const struct {
    std::size_t count, of;
    double lower, upper;
  } rows[] = {{0, 10, 0.0000, 0.3085}, {1, 10, 0.0025, 0.4450}, {5, 10, 0.1871, 0.8129},   {10, 10, 0.6915, 1.0000},
              {2, 20, 0.0123, 0.3170}, {0, 50, 0.0000, 0.0711}, {50, 100, 0.3983, 0.6017}, {95, 100, 0.8872, 0.9836}};
  for (const auto& row : rows) {
    const Interval limits = exact_limits({row.count, row.of});
    EXPECT_NEAR(limits.lower, row.lower, 5e-5) << row.count << " of " << row.of;
    EXPECT_NEAR(limits.upper, row.upper, 5e-5) << row.count << " of " << row.of;
  }
}

// Of no case the upper limit solves (1 - p)^n = tail.
TEST(ExactLimits, OfNoCaseHaveAClosedForm) {
  EXPECT_NEAR(exact_limits({0, 2000}, 0.90).upper, 1.0 - std::pow(0.05, 1.0 / 2000.0), 1e-12);
  EXPECT_EQ(exact_limits({0, 0}), (Interval{0.0, 1.0}));
}

double choose(int n, int k) {
  double c = 1.0;
  for (int i = 1; i <= k; ++i) c *= static_cast<double>(n - k + i) / i;
  return c;
}

TEST(PWithin, IsTwiceTheBinomialTailSummedByHand) {
  double below = 0.0;  // P(X <= 15 of 20 | 0.93)
  for (int k = 0; k <= 15; ++k) below += choose(20, k) * std::pow(0.93, k) * std::pow(0.07, 20 - k);
  EXPECT_NEAR(p_within({15, 20}, {0.93, 0.97}), 2.0 * below, 1e-14);
  double above = 0.0;  // P(X >= 17 of 20 | 0.6)
  for (int k = 17; k <= 20; ++k) above += choose(20, k) * std::pow(0.6, k) * std::pow(0.4, 20 - k);
  EXPECT_NEAR(p_within({17, 20}, {0.5, 0.6}), 2.0 * above, 1e-14);
  EXPECT_EQ(p_within({19, 20}, {0.93, 0.97}), 1.0);
  EXPECT_EQ(p_within({0, 0}, {0.93, 0.97}), 1.0);
  EXPECT_NEAR(p_within({0, 20}, {0.93, 0.97}), 2.0 * std::pow(0.07, 20), 1e-30);
}

// p <= a exactly where the limits of confidence 1 - a have left the allowed interval.
TEST(PWithin, AgreesWithTheLimits) {
  for (std::size_t count = 0; count <= 400; ++count) {
    const Proportion x{count, 400};
    const Interval limits = exact_limits(x, 0.99);
    const bool outside = limits.upper < 0.93 || limits.lower > 0.97;
    EXPECT_EQ(p_within(x, {0.93, 0.97}) < 0.01, outside) << count;
  }
}

TEST(PAtMost, ToleratesNothingWhereTheRateIsZero) {
  EXPECT_EQ(p_at_most({0, 100}, 0.0), 1.0);
  EXPECT_EQ(p_at_most({1, 100}, 0.0), 0.0);
  EXPECT_NEAR(p_at_most({1, 100}, 0.01), 1.0 - std::pow(0.99, 100), 1e-13);
  EXPECT_EQ(p_at_most({0, 100}, 0.01), 1.0);
}

// Student's 97.5 % point for 9 degrees of freedom is 2.262.
TEST(PMeanWithin, IsStudentsTailBeyondTheLimit) {
  EXPECT_NEAR(p_mean_within(2.262, 1.0, 10, 0.0), 0.05, 1e-4);
  EXPECT_NEAR(p_mean_within(-0.25 - 0.2262, 0.1, 10, 0.25), 0.05, 1e-4);
  EXPECT_EQ(p_mean_within(0.2, 0.1, 10, 0.25), 1.0);
  EXPECT_EQ(p_mean_within(0.2, 0.0, 10, 0.1), 0.0);
  EXPECT_EQ(p_mean_within(std::nan(""), 0.1, 10, 0.1), 0.0);
}

// 0.01, 0.04, 0.03, 0.005: sorted 0.005 × 4 = 0.02, 0.01 × 3 = 0.03, 0.03 × 2 = 0.06, 0.04 × 1 = 0.04 -> 0.06, since an
// adjusted p never falls below that of a smaller p.
TEST(Holm, OfAnExampleByHand) {
  const std::vector<double> adjusted = holm_adjusted({0.01, 0.04, 0.03, 0.005});
  const std::vector<double> expected{0.03, 0.06, 0.06, 0.02};
  ASSERT_EQ(adjusted.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(adjusted[i], expected[i], 1e-15) << i;
  EXPECT_EQ(holm_adjusted({0.9, 0.8}), (std::vector{1.0, 1.0}));
  EXPECT_EQ(holm_adjusted({0.0, 0.7}), (std::vector{0.0, 0.7}));
  EXPECT_TRUE(holm_adjusted({}).empty());
}

}  // namespace
}  // namespace goniofit
