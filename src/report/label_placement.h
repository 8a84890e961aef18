#pragma once
// Labels beside the points of a plot, none over another or over a point.

#include <optional>
#include <vector>

namespace goniofit {

/// In pixels; y grows downwards.
struct LabelBox {
  double left, top, right, bottom;
  [[nodiscard]] bool overlaps(const LabelBox& b) const noexcept {
    return left < b.right && b.left < right && top < b.bottom && b.top < bottom;
  }
};

struct LabelledPoint {
  double x, y;
  double width, height;  ///< of its label
};

struct PlacedLabel {
  LabelBox box;
  bool led;  ///< so far from its point that a line should lead to it
};

/// One a point, clear of `obstacles`, in the order given, which is that of importance: each takes the nearest free
/// place within `panel`, and none where there is none. Greedy: short lists of labels need no better.
[[nodiscard]] std::vector<std::optional<PlacedLabel>> place_labels(const std::vector<LabelledPoint>& points,
                                                                   const LabelBox& panel,
                                                                   std::vector<LabelBox> obstacles = {});

}  // namespace goniofit
