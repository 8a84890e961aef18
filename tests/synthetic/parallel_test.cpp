#include "synthetic/parallel.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace goniofit {
namespace {

TEST(ParallelFor, RunsEachTaskOnceOnAnyNumberOfThreads) {
  for (const std::size_t threads : {0U, 1U, 2U, 7U}) {
    std::vector<int> runs(1000, 0);
    parallel_for(
        runs.size(), [&](std::size_t i) { ++runs[i]; }, {}, threads);
    EXPECT_EQ(runs, std::vector<int>(1000, 1)) << threads << " threads";
  }
  parallel_for(0, [](std::size_t) { FAIL() << "there is no task"; });
}

TEST(ParallelFor, ReportsProgressOneCallAtATime) {
  std::vector<std::size_t> reported;
  parallel_for(
      50, [](std::size_t) {}, [&](std::size_t done, std::size_t total) { reported.push_back(total - done); }, 4);
  ASSERT_EQ(reported.size(), 50U);
  for (std::size_t i = 0; i < 50; ++i) EXPECT_EQ(reported[i], 49 - i);
}

TEST(ParallelFor, PassesOnTheFirstExceptionAfterAllTasks) {
  std::vector<int> runs(100, 0);
  const auto task = [&](std::size_t i) {
    ++runs[i];
    if (i >= 40 && i % 10 == 0) throw std::runtime_error(std::to_string(i));
  };
  try {
    parallel_for(runs.size(), task, {}, 4);
    FAIL() << "no exception passed on";
  } catch (const std::runtime_error& e) {
    EXPECT_STREQ(e.what(), "40");
  }
  EXPECT_EQ(runs, std::vector<int>(100, 1));
}

}  // namespace
}  // namespace goniofit
