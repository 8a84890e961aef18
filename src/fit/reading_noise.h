#pragma once
// How the noise of readings appears in a problem's residuals.

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "joint_jacobian.h"
#include "model.h"
#include "problem.h"

namespace goniofit {

/// d residual / d value of a channel, one a row; 0 where the value is left out. All that depends on the loss.
[[nodiscard]] Eigen::VectorXd residual_by_value(const Problem& problem, const Linearisation& l, std::size_t channel);
/// Standard deviation of the residuals by the values' own uncertainties; the scan has to state these.
[[nodiscard]] Eigen::VectorXd reading_sd(const Problem& problem, const Linearisation& l, std::size_t channel);
/// Change of the residuals by a relative change of all readings of the scan: what an error of the instrument's scale
/// does. Reflectances are another instrument's.
[[nodiscard]] Eigen::VectorXd residual_by_scale(const Problem& problem, const Linearisation& l, std::size_t channel);
/// Whether every channel has uncertainties of its readings.
[[nodiscard]] bool states_uncertainties(const Problem& problem) noexcept;

/// The noise that residuals show, as relative and additive parts of the readings: of all channels together where a
/// channel does not contradict that, else its own. Readings count by their leverages: hundreds of them tell the noise
/// of the few that decide a lobe.
struct ResidualNoise {
  std::vector<Noise> noise;  ///< one a channel
  double freedom = 1.0;      ///< (sum of the leverages)² over the sum of their squares
  /// Whether residuals are no other than such noise: the mean of their squares over what that noise leaves of it,
  /// weighted by leverage, is 1 within four standard deviations and a tenth, in every channel.
  bool holds = true;
};
/// From the rows that `j` has, l's; each stands for `count` of them, where there are counts.
[[nodiscard]] ResidualNoise residual_noise(const Problem& problem, const Linearisation& l,
                                           const std::vector<Eigen::VectorXd>& residuals, const JointJacobian& j,
                                           const Eigen::ArrayXd& count);
/// Of a channel's residuals.
[[nodiscard]] Eigen::VectorXd variance_by(const Noise& noise, const Problem& problem, const Linearisation& l,
                                          const Eigen::VectorXd& residuals, std::size_t channel);

}  // namespace goniofit
