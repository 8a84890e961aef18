#pragma once
// The optics factors of a basis' columns at many pairs.

#include <Eigen/Core>
#include <span>

#include "problem.h"

namespace goniofit {

/// weight * optics factor, a column a basis column, at the problem's points of evaluation; one row each of `points`, as
/// long as `weight`.
[[nodiscard]] Eigen::MatrixXd optics_columns(const Problem& problem, const ChannelOptics& optics,
                                             std::span<const std::size_t> points, const Eigen::VectorXd& weight);
/// At all of them, by the problem's weights.
[[nodiscard]] Eigen::MatrixXd optics_columns(const Problem& problem, const ChannelOptics& optics);

}  // namespace goniofit
