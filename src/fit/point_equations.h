#pragma once
// What a step reads of a whole problem at a point: the products of its residuals and their derivatives.

#include <array>
#include <cstddef>
#include <vector>

#include "model.h"
#include "problem.h"
#include "search.h"

namespace goniofit {

struct PointEquations {
  std::vector<ChannelEquations> channels{};
  double loss = 0.0;

  /// Where the residuals stand in the products.
  [[nodiscard]] Eigen::Index residuals() const noexcept { return channels.front().products.cols() - 1; }
};

/// Of one problem at the points asked for. Of a problem by parts the parts' are summed up.
class EquationsAt {
 public:
  /// `model` is of that problem; one by parts does without.
  EquationsAt(const Problem& problem, Model& model) : problem_(problem), model_(model) {}

  /// Nothing is computed again for the last two points asked for: an optimiser goes on from nearly all that it tries,
  /// and ends at one of these.
  const PointEquations& at(const FitPoint& point);
  [[nodiscard]] const PointEquations& last() const noexcept { return known_[last_].equations; }

 private:
  const Problem& problem_;
  Model& model_;
  struct Known {
    FitPoint point{};
    PointEquations equations{};
  };
  std::array<Known, 2> known_;
  std::size_t last_ = 0;
};

}  // namespace goniofit
