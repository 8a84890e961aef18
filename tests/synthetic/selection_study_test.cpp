// A short run of what `goniofit verify --selection` does at length.

#include "synthetic/selection_study.h"

#include <gtest/gtest.h>

#include <set>

namespace goniofit {
namespace {

TEST(SelectionStudy, FindsTheTrueSets) {
  const SelectionStudy study = verify_selection(32, 20261122);
  EXPECT_EQ(study.trials.size(), 32U);
  for (const SelectionTrial& t : study.trials) EXPECT_FALSE(t.left_out()) << t.material;
  EXPECT_TRUE(study.passed()) << study.right() << " of 32 right";
}

TEST(SelectionStudy, IsTheSameForTheSameSeed) {
  const SelectionStudy a = verify_selection(3, 5);
  const SelectionStudy b = verify_selection(3, 5);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(a.trials[i].material, b.trials[i].material);
  EXPECT_NE(a.trials[0].material, verify_selection(3, 6).trials[0].material);
}

TEST(SelectionStudy, CountsWhatWasMissed) {
  SelectionStudy study;
  const EffectSet truth{Effect::dd, Effect::uds};
  for (int i = 0; i < 19; ++i) study.trials.push_back({truth, truth, 1, "", {}});
  study.trials.push_back({truth, {Effect::dd, Effect::uds, Effect::fs}, 1, "", {}});
  EXPECT_EQ(study.right(), 19U);
  EXPECT_TRUE(study.passed());
  study.trials.back().chosen = {Effect::dd};
  EXPECT_EQ(study.left_out(), 1U);
  EXPECT_FALSE(study.passed());
}

}  // namespace
}  // namespace goniofit
