#include "synthetic/recovery.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "synthetic/random.h"

namespace goniofit {
namespace {

Recovery recovered(double truth, const std::vector<Estimate>& estimates) {
  RecoveryTally tally("k", truth);
  for (const Estimate& e : estimates) tally.add(e);
  return tally.result();
}

// Five estimates of 2: mean 2.2, squared deviations 0.49 + 0.09 + 0.01 + 0.09 + 0.64 = 1.32 over four.
TEST(Recovery, OfAHandMadeSample) {
  const Recovery r = recovered(2.0, {{1.5, 0.3}, {1.9, 0.2}, {2.125, 0.1}, {2.475}, {3.0, 0.4}});
  EXPECT_EQ(r.parameter, "k");
  EXPECT_EQ(r.determined, 5U);
  EXPECT_DOUBLE_EQ(r.mean, 2.2);
  EXPECT_NEAR(r.bias, 0.2, 1e-15);
  const double variance = (0.49 + 0.09 + 0.005625 + 0.075625 + 0.64) / 4.0;
  EXPECT_NEAR(r.spread, std::sqrt(variance), 1e-15);
  EXPECT_NEAR(r.bias_error, std::sqrt(variance / 5.0), 1e-15);
  EXPECT_EQ(r.stated_u, 4U);
  EXPECT_NEAR(r.mean_u, 0.25, 1e-15);
  // Distances in u: 1.67, 0.5, 1.25, 2.5.
  EXPECT_EQ(r.coverage_68.of, 4U);
  EXPECT_EQ(r.coverage_68.count, 1U);
  EXPECT_EQ(r.coverage_95.count, 3U);
}

TEST(Recovery, AStatedIntervalGoesBeforeTheUncertainty) {
  Estimate wide{1.0, 0.1};  // ± 0.1 and ± 0.196 do not reach 1.5
  wide.interval_68 = Interval{0.9, 1.5};
  EXPECT_EQ(recovered(1.5, {wide}).coverage_68.count, 1U);
  EXPECT_EQ(recovered(1.5, {wide}).coverage_95.count, 0U);
  wide.interval_95 = Interval{0.9, 1.6};
  EXPECT_EQ(recovered(1.5, {wide}).coverage_95.count, 1U);
  EXPECT_EQ(recovered(0.85, {wide}).coverage_95.count, 0U);  // within ± 0.196, outside of what was stated
}

// At a bound there is an interval and no standard uncertainty.
TEST(Recovery, AOneSidedIntervalCounts) {
  Estimate at_bound{0.0};
  at_bound.interval_95 = Interval{0.0, 0.02};
  const Recovery r = recovered(0.0, {at_bound, {0.01, 0.001}, {0.0}});
  EXPECT_EQ(r.determined, 3U);
  EXPECT_EQ(r.stated_u, 1U);
  EXPECT_EQ(r.coverage_68.of, 1U);
  EXPECT_EQ(r.coverage_95.of, 2U);
  EXPECT_EQ(r.coverage_95.count, 1U);
}

TEST(Recovery, OfOneEstimateWithoutUncertainty) {
  const Recovery r = recovered(1.0, {{1.25}});
  EXPECT_EQ(r.bias, 0.25);
  EXPECT_EQ(r.spread, 0.0);
  EXPECT_EQ(r.coverage_95.of, 0U);
  EXPECT_EQ(r.coverage_95.fraction(), 0.0);
}

TEST(Recovery, OfAPerfectFitterCoversAsStated) {
  RandomStream random(5);
  RecoveryTally tally("k", 0.5);
  for (int i = 0; i < 20000; ++i) tally.add({0.5 + 0.01 * random.gaussian(), 0.01});
  const Recovery r = tally.result();
  EXPECT_NEAR(r.coverage_68.fraction(), 0.6827, 0.01);
  EXPECT_NEAR(r.coverage_95.fraction(), 0.95, 0.005);
  EXPECT_NEAR(r.spread, 0.01, 0.0002);
}

// The recurrence keeps its digits where a sum of squares has none: a spread of 1e-9 about 1.
TEST(Recovery, OfAlmostEqualEstimatesKeepsItsDigits) {
  const Recovery r = recovered(1.0, {{1.0 - 1e-9}, {1.0}, {1.0 + 1e-9}});
  EXPECT_NEAR(r.spread, 1e-9, 1e-15);
}

TEST(LossRatio, ComparesLossesAndIgnoresRoundOff) {
  Scan scan;
  scan.theta_i_deg = {0.0, 60.0};
  scan.channels.push_back({"R", {}, {}, {}, {3.0, 2.0}, {}});  // 1 * 9 + 0.5 * 4 = 11
  EXPECT_DOUBLE_EQ(loss_ratio(scan, 3.0, 2.0), 1.5);
  EXPECT_DOUBLE_EQ(loss_ratio(scan, 1.0, 2.0), 0.5);
  EXPECT_EQ(loss_ratio(scan, 1.0e-11, 0.0), 1.0);
  EXPECT_EQ(loss_ratio(scan, 1e-30, 1e-33), 1.0);
  EXPECT_GT(loss_ratio(scan, 1e-6, 1e-33), 1e4);
}

}  // namespace
}  // namespace goniofit
