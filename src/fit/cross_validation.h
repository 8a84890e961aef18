#pragma once
// Leaving whole incidence angles out of a fit and predicting them.

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "problem.h"
#include "search.h"

namespace goniofit {

/// A group of neighbouring incidence angles for each reading of a problem: one group an angle (to 0.1 degree), and of
/// more than eight angles eight groups of about as many readings each.
struct AngleGroups {
  std::vector<std::size_t> of;  ///< one a reading
  std::vector<double> readings;
  [[nodiscard]] std::size_t count() const noexcept { return readings.size(); }
};
[[nodiscard]] AngleGroups angle_groups(const Problem& problem);

/// Scores are sums over readings and channels of
///
///   c ln(1 + r²/4),   r: deviation in units of the noise (the problem's weight and emphasis),
///
/// the logarithmic score of a prediction by Student's t of four degrees of freedom, with c such that normal noise alone
/// costs 1 a reading. It grows so slowly that one mirror reading, extrapolated from other angles, does not outweigh all
/// the rest. By group; `point` predicts.
[[nodiscard]] Eigen::VectorXd group_scores(const Problem& problem, const FitPoint& point, const AngleGroups& groups);

/// The scores of each group's readings where the fit to all other groups predicts them. `start` is the fit to all of
/// them: each fit is one step from there within the bounds, and where the quadratic that gave the step does not hold, a
/// polish. The problem's emphasis is as before afterwards.
[[nodiscard]] Eigen::VectorXd left_out_scores(Problem& problem, const FitPoint& start, const AngleGroups& groups);

/// Standard error of the sum of paired differences, one a group, each of them a draw.
[[nodiscard]] double paired_error(const Eigen::VectorXd& differences);

}  // namespace goniofit
