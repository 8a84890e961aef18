#include "report/label_placement.h"

#include <algorithm>
#include <array>

namespace goniofit {

namespace {

constexpr double point_radius = 5.0;
constexpr double led_from = 12.0;

struct Side {
  double x, y;  // of the label's centre from the point's, in units of half a label plus the distance
};
constexpr std::array sides{Side{1, 0},   Side{-1, 0}, Side{1, -1}, Side{1, 1},
                           Side{-1, -1}, Side{-1, 1}, Side{0, -1}, Side{0, 1}};
constexpr std::array distances{7.0, 15.0, 24.0, 34.0, 46.0, 60.0};

LabelBox box_at(const LabelledPoint& p, const Side& side, double distance) {
  const double x = p.x + side.x * (0.5 * p.width + distance);
  const double y = p.y + side.y * (0.5 * p.height + distance);
  return {x - 0.5 * p.width, y - 0.5 * p.height, x + 0.5 * p.width, y + 0.5 * p.height};
}

bool is_within(const LabelBox& b, const LabelBox& panel) {
  return b.left >= panel.left && b.right <= panel.right && b.top >= panel.top && b.bottom <= panel.bottom;
}

}  // namespace

std::vector<std::optional<PlacedLabel>> place_labels(const std::vector<LabelledPoint>& points, const LabelBox& panel,
                                                     std::vector<LabelBox> obstacles) {
  std::vector<LabelBox>& taken = obstacles;
  for (const LabelledPoint& p : points) {
    taken.push_back({p.x - point_radius, p.y - point_radius, p.x + point_radius, p.y + point_radius});
  }
  const auto is_free = [&](const LabelBox& box) {
    return is_within(box, panel) &&
           std::none_of(taken.begin(), taken.end(), [&](const LabelBox& other) { return box.overlaps(other); });
  };
  const auto place = [&](const LabelledPoint& p) -> std::optional<PlacedLabel> {
    for (const double distance : distances) {
      for (const Side& side : sides) {
        const LabelBox box = box_at(p, side, distance);
        if (is_free(box)) return PlacedLabel{box, distance > led_from};
      }
    }
    return std::nullopt;
  };
  std::vector<std::optional<PlacedLabel>> placed;
  for (const LabelledPoint& p : points) {
    placed.push_back(place(p));
    if (placed.back()) taken.push_back(placed.back()->box);
  }
  return placed;
}

}  // namespace goniofit
