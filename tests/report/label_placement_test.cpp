#include "report/label_placement.h"

#include <gtest/gtest.h>

#include "synthetic/random.h"

namespace goniofit::test {
namespace {

constexpr LabelBox panel{0.0, 0.0, 600.0, 400.0};

LabelBox around(const LabelledPoint& p) { return {p.x - 2.0, p.y - 2.0, p.x + 2.0, p.y + 2.0}; }

TEST(LabelPlacement, ALonePointHasItsLabelAtItsSide) {
  const auto placed = place_labels({{300.0, 200.0, 80.0, 12.0}}, panel);
  ASSERT_TRUE(placed[0]);
  EXPECT_FALSE(placed[0]->led);
  EXPECT_GT(placed[0]->box.left, 300.0);
  EXPECT_LT(placed[0]->box.left, 312.0);
  EXPECT_NEAR(0.5 * (placed[0]->box.top + placed[0]->box.bottom), 200.0, 1e-9);
}

TEST(LabelPlacement, NothingOverlapsAndNothingLeavesThePanel) {
  goniofit::RandomStream random(1);
  std::vector<LabelledPoint> points;
  for (int i = 0; i < 30; ++i) points.push_back({random.uniform(5, 595), random.uniform(5, 200), 90.0, 12.0});
  const std::vector<LabelBox> line{{0.0, 250.0, 600.0, 252.0}};
  const auto placed = place_labels(points, panel, line);
  std::size_t count = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!placed[i]) continue;
    ++count;
    const LabelBox& box = placed[i]->box;
    EXPECT_GE(box.left, panel.left);
    EXPECT_LE(box.right, panel.right);
    EXPECT_GE(box.top, panel.top);
    EXPECT_LE(box.bottom, panel.bottom);
    EXPECT_FALSE(box.overlaps(line[0]));
    for (std::size_t k = 0; k < points.size(); ++k) {
      EXPECT_FALSE(box.overlaps(around(points[k]))) << i << " over point " << k;
      if (k == i || !placed[k]) continue;
      EXPECT_FALSE(box.overlaps(placed[k]->box)) << i << " over " << k;
    }
  }
  EXPECT_GE(count, 25U);
}

TEST(LabelPlacement, TheFirstComesFirst) {
  const LabelBox narrow{0.0, 0.0, 100.0, 20.0};
  const LabelledPoint p{10.0, 10.0, 70.0, 12.0};
  const auto placed = place_labels({p, p}, narrow);
  EXPECT_TRUE(placed[0]);
  EXPECT_FALSE(placed[1]) << "there is no room for another";
}

}  // namespace
}  // namespace goniofit::test
