#include "synthetic/judgement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "synthetic/random.h"

namespace goniofit {
namespace {

/// A fitter whose estimates are normal about the truth, `shift` deviations off, and state `u_scale` times their
/// deviation.
struct Fitter {
  double u_scale = 1.0, shift = 0.0;
};

Recovery recovery(const std::string& name, double truth, double deviation, std::size_t trials, Fitter fitter = {},
                  std::uint64_t seed = 20260101) {
  RandomStream random(subkey(seed, name));
  RecoveryTally tally(name, truth);
  for (std::size_t i = 0; i < trials; ++i) {
    tally.add({truth + deviation * (random.gaussian() + fitter.shift), fitter.u_scale * deviation});
  }
  return tally.result();
}

VerifyReport report(std::vector<Recovery> parameters, std::size_t trials = 400) {
  VerifyReport report;
  report.trials = trials;
  report.parameters = std::move(parameters);
  report.settings.bias = 0.25;
  report.settings.coverage_68 = {0.64, 0.73};
  report.settings.coverage_95 = {0.93, 0.97};
  return report;
}

std::vector<std::string> missed(VerifyReport r, double level = default_level) {
  judge({&r, 1}, level);
  return r.missed;
}

TEST(Judge, APerfectFitterMissesNone) {
  EXPECT_TRUE(missed(report({recovery("slope", 0.1, 0.0005, 400), recovery("R.k_dd", 0.5, 0.01, 400)})).empty());
}

TEST(Judge, UncertaintiesTooSmallByTwoAreCaught) {
  VerifyReport r = report({recovery("slope", 0.1, 0.0005, 400), recovery("R.k_dd", 0.5, 0.01, 400, {.u_scale = 0.5})});
  judge({&r, 1});
  ASSERT_EQ(r.missed.size(), 2U);
  EXPECT_EQ(r.missed[0].rfind("R.k_dd: the 68 % intervals contain the truth in 3", 0), 0U) << r.missed[0];
  EXPECT_EQ(r.missed[1].rfind("R.k_dd: the 95 % intervals contain the truth in 6", 0), 0U) << r.missed[1];
  EXPECT_NE(r.missed[1].find("of 400 cases, expected 93 to 97 % (p "), std::string::npos) << r.missed[1];
  EXPECT_TRUE(r.is_missed("R.k_dd", Bound::coverage_95));
  EXPECT_FALSE(r.is_missed("slope", Bound::coverage_95));
}

TEST(Judge, UncertaintiesTooLargeByTwoAreCaught) {
  EXPECT_EQ(missed(report({recovery("R.k_dd", 0.5, 0.01, 400, {.u_scale = 2.0})})).size(), 2U);
}

TEST(Judge, ABiasedParameterIsCaughtByItsOwnUncertainty) {
  VerifyReport r = report({recovery("R.k_dd", 0.5, 0.01, 400, {.shift = 0.6})});
  r.settings.coverage_68 = r.settings.coverage_95 = std::nullopt;
  const std::vector<std::string> words = missed(r);
  ASSERT_EQ(words.size(), 1U);
  EXPECT_NEAR(r.parameters[0].bias / r.parameters[0].mean_u, 0.6, 0.15);
  EXPECT_EQ(words[0].rfind("R.k_dd: the mean is +0.", 0), 0U) << words[0];
  EXPECT_NE(words[0].find(" standard uncertainties off the truth, at most 0.25 allowed (p "), std::string::npos);
  r.parameters[0].truth_on_bound = true;
  EXPECT_TRUE(missed(r).empty());
}

// A coverage of 91 % of 400 has p = 2 P(X <= 364 | 0.93) = 0.15: a single test does not refute 93 %.
TEST(Judge, WhatChanceExplainsIsNotMissed) {
  VerifyReport r = report({recovery("R.k_dd", 0.5, 0.01, 400)});
  r.parameters[0].coverage_95 = {364, 400};
  EXPECT_TRUE(missed(r).empty());
  r.parameters[0].coverage_95 = {340, 400};
  EXPECT_EQ(missed(r).size(), 1U);
}

// The same count is missed among few tests and not among many.
TEST(Judge, TheLevelIsSharedByAllTestsOfTheRun) {
  std::vector<VerifyReport> run(1, report({recovery("R.k_dd", 0.5, 0.01, 400)}));
  run[0].parameters[0].coverage_95 = {357, 400};  // p = 0.0073
  judge(run);
  ASSERT_EQ(run[0].missed.size(), 1U);
  EXPECT_EQ(run[0].checks.size(), 4U);  // bias, both coverages, failures
  for (int i = 0; i < 5; ++i) run.push_back(report({recovery("R.k_dd", 0.5, 0.01, 400)}));
  judge(run);
  EXPECT_TRUE(run[0].missed.empty());
}

// The share of runs that blame a perfect fitter stays below the level. 20 parameters, so that without
// Holm's correction nearly all would.
TEST(Judge, APerfectFitterIsBlamedNoMoreOftenThanTheLevel) {
  std::size_t blamed = 0;
  for (std::uint64_t run = 0; run < 200; ++run) {
    std::vector<Recovery> parameters;
    for (int p = 0; p < 20; ++p) {
      parameters.push_back(recovery("k" + std::to_string(p), 0.5, 0.01, 100, {}, run));
    }
    VerifyReport r = report(std::move(parameters), 100);
    r.settings.coverage_68 = {0.6826, 0.6828};  // hardly more than the truth: the hardest bounds to meet
    r.settings.coverage_95 = {0.9499, 0.9501};
    r.settings.bias = 1e-6;
    blamed += missed(r).empty() ? 0 : 1;
  }
  EXPECT_LE(blamed, 20U);  // of 200 at 5 %: more than 20 has a probability of 1e-3, were all p uniform
}

TEST(Judge, ABiasedSlopeIsNamedWithItsBias) {
  RecoveryTally tally("slope", 0.1);
  tally.add({0.1021, 0.01});
  tally.add({0.1019, 0.01});
  VerifyReport r;
  r.parameters = {tally.result()};
  r.trials = 2;
  r.settings.slope_bias = 0.01;
  const auto words = missed(r);
  ASSERT_EQ(words.size(), 1U);
  EXPECT_EQ(words[0], "slope: the mean is +2 % off the truth, at most 1 % allowed");
  r.settings.slope_bias = 0.03;
  EXPECT_TRUE(missed(r).empty());
}

TEST(Judge, ASlopeThatIsNotANumberIsMissed) {
  RecoveryTally tally("slope", 0.1);
  tally.add({std::nan("")});
  VerifyReport r;
  r.parameters = {tally.result()};
  r.trials = 1;
  EXPECT_EQ(missed(r).size(), 1U);
}

TEST(Judge, ASingleFailureIsMissedUnlessARateIsAllowed) {
  VerifyReport r = report({recovery("R.k_dd", 0.5, 0.01, 400)});
  r.failures = 1;
  const auto words = missed(r);
  ASSERT_EQ(words.size(), 1U);
  EXPECT_EQ(words[0],
            "1 of 400 fits did not converge or ended in a wrong minimum, at most 0 % allowed (p 0 after Holm's "
            "correction)");
  r.settings.failure_rate = 0.01;
  r.failures = 7;  // 4 expected, P(X >= 7) = 0.11
  EXPECT_TRUE(missed(r).empty());
  r.failures = 15;
  EXPECT_EQ(missed(r).size(), 1U);
}

TEST(Judge, AParameterThatStatesNothingIsNotHeldToCoverage) {
  RecoveryTally tally("R.k_uds", 0.0);
  for (int i = 0; i < 100; ++i) tally.add({0.5});
  const VerifyReport r = report({tally.result()}, 100);
  EXPECT_TRUE(missed(r).empty());
}

}  // namespace
}  // namespace goniofit
