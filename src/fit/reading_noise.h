#pragma once
// How the noise of readings appears in a problem's residuals.

#include <Eigen/Core>
#include <cstddef>
#include <vector>

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

/// Variances of the residuals, one vector a channel, by the noise that the residuals themselves show: relative and
/// additive (noise_model.h), of all channels together where that describes a channel's as well as its own would (BIC),
/// and without a relative part where that does.
[[nodiscard]] std::vector<Eigen::VectorXd> estimated_variances(const Problem& problem, const Linearisation& l,
                                                               const std::vector<Eigen::VectorXd>& residuals);

}  // namespace goniofit
