#pragma once
// How the noise of readings appears in a problem's residuals.

#include <Eigen/Core>
#include <cstddef>

#include "problem.h"

namespace goniofit {

/// d residual / d reading of a channel, one a reading: all that depends on the loss.
[[nodiscard]] Eigen::VectorXd residual_by_reading(const Problem& problem, std::size_t channel);
/// Standard deviation of the residuals by the readings' own uncertainties; the scan has to state these.
[[nodiscard]] Eigen::VectorXd reading_sd(const Problem& problem, std::size_t channel);
/// Change of the residuals by a relative change of all readings: what an error of the instrument's scale does.
[[nodiscard]] Eigen::VectorXd residual_by_scale(const Problem& problem, std::size_t channel);
/// Whether every channel has uncertainties of its readings.
[[nodiscard]] bool states_uncertainties(const Problem& problem) noexcept;

/// Variance of the residuals by the noise that the residuals themselves show, relative and additive (noise_model.h).
[[nodiscard]] Eigen::VectorXd estimated_variance(const Problem& problem, std::size_t channel,
                                                 const Eigen::VectorXd& residuals);

}  // namespace goniofit
