#include "cost/timing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/error.h"

namespace goniofit::test {
namespace {

// A chain of dependent operations: its time is the number of its links.
TimedTask chain(int links) {
  return {[links] {
            double x = 0.5;
            for (int i = 0; i < links; ++i) x = x * 1.0000001 + 1e-9;
            keep(&x);
          },
          static_cast<double>(links)};
}

constexpr TimingSettings quick{.rounds = 9, .least_seconds = 1e-4};

TEST(Timing, ThreeTimesTheWorkTakesThreeTimesAsLong) {
  std::vector<TimedTask> tasks{chain(20000), chain(60000)};
  for (TimedTask& task : tasks) task.evaluations = 1.0;
  const std::vector<Timing> times = time_interleaved(tasks, 0, quick);
  EXPECT_DOUBLE_EQ(times[0].ratio, 1.0) << "the baseline's over itself";
  EXPECT_NEAR(times[1].ratio, 3.0, 0.6);
  for (const Timing& t : times) {
    EXPECT_LE(t.min_ns, t.median_ns);
    EXPECT_LE(t.median_ns, t.max_ns);
  }
}

TEST(Timing, IsOfOneEvaluation) {
  const std::vector<TimedTask> tasks{chain(20000), chain(60000)};
  const std::vector<Timing> times = time_interleaved(tasks, 1, quick);
  EXPECT_NEAR(times[0].ratio, 1.0, 0.25) << "links cost the same, however many there are";
}

// 0.05 ns would be 16 multiplications and additions a cycle in a row, each waiting for the one before.
TEST(Timing, KeptWorkIsDone) {
  const std::vector<TimedTask> tasks{chain(100000)};
  EXPECT_GT(time_interleaved(tasks, 0, quick)[0].min_ns, 0.05);
}

TEST(Timing, EveryTaskRunsInEveryRound) {
  std::vector<std::size_t> runs(3);
  std::vector<TimedTask> tasks;
  for (std::size_t& n : runs) tasks.push_back({[&n] { ++n; }, 1.0});
  std::vector<std::size_t> rounds;
  (void)time_interleaved(tasks, 0, {.rounds = 5, .least_seconds = 0.0}, [&](std::size_t done, std::size_t total) {
    EXPECT_EQ(total, 5U);
    rounds.push_back(done);
  });
  // Two runs before, and in each round one that warms and one that is timed.
  for (const std::size_t n : runs) EXPECT_EQ(n, 2U + 2U * 5U);
  EXPECT_EQ(rounds, (std::vector<std::size_t>{1, 2, 3, 4, 5}));
}

TEST(Timing, NeedsARound) {
  const std::vector<TimedTask> tasks{chain(10)};
  EXPECT_THROW((void)time_interleaved(tasks, 0, {.rounds = 0}), Error);
}

TEST(Timing, Medians) {
  EXPECT_EQ(median_of({}), 0.0);
  EXPECT_EQ(median_of({3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(median_of({4.0, 1.0, 3.0, 2.0}), 2.5);
}

}  // namespace
}  // namespace goniofit::test
