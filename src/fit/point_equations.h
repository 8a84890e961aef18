#pragma once
// What a step reads of a whole problem at a point: the products of its residuals and their derivatives.

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

  /// Nothing is computed again for the point asked for last: an optimiser goes on from nearly all that it tries, and
  /// ends at the last.
  const PointEquations& at(const FitPoint& point);
  [[nodiscard]] const PointEquations& last() const noexcept { return equations_; }

 private:
  const Problem& problem_;
  Model& model_;
  FitPoint point_;
  PointEquations equations_;
};

}  // namespace goniofit
