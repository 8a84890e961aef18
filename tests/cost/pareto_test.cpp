#include "cost/pareto.h"

#include <gtest/gtest.h>

#include "synthetic/random.h"

namespace goniofit::test {
namespace {

TEST(Pareto, MarksWhatNothingBeats) {
  const std::vector<CostAndError> points{{1, 9}, {2, 5}, {3, 5}, {3, 4}, {4, 6}, {9, 0}};
  EXPECT_EQ(pareto_front(points), (std::vector<bool>{true, true, false, true, false, true}));
}

TEST(Pareto, EqualPointsShareTheirFate) {
  EXPECT_EQ(pareto_front(std::vector<CostAndError>{{1, 1}, {1, 1}}), (std::vector<bool>{true, true}));
  EXPECT_EQ(pareto_front(std::vector<CostAndError>{{2, 1}, {1, 1}, {2, 1}}), (std::vector<bool>{false, true, false}));
  EXPECT_TRUE(pareto_front({}).empty());
}

// Sorted by cost the front falls strictly, and each point off it lies above the front at its cost.
TEST(Pareto, IsTheLowerLeftStaircaseOfRandomPoints) {
  RandomStream random(3);
  std::vector<CostAndError> points;
  for (int i = 0; i < 200; ++i) points.push_back({random.uniform(), random.uniform()});
  const std::vector<bool> front = pareto_front(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    double least_error = 2.0;  // of the points at most as dear
    for (const CostAndError& p : points) {
      if (p.cost <= points[i].cost) least_error = std::min(least_error, p.error);
    }
    EXPECT_EQ(front[i], points[i].error == least_error) << i;
  }
}

}  // namespace
}  // namespace goniofit::test
