#pragma once
// The noise of every reading: what the rows of a Jacobian are to be divided by before it says what is known.

#include <Eigen/Core>
#include <vector>

#include "model.h"
#include "problem.h"

namespace goniofit {

struct ReadingNoise {
  std::vector<Eigen::VectorXd> sd;  ///< of each reading, 1/sr; one vector a channel
  std::vector<Noise> model;         ///< the same as a part of the value and an additive one
  /// 1 / sd in the unit of the residuals: weight and emphasis divided out. One vector a channel.
  std::vector<Eigen::VectorXd> whitener;
};

/// The scan's own uncertainties where it states them, enlarged by what the residuals exceed them by (the median's
/// Birge ratio); else estimate_noise() of the residuals, from at most a thousand readings a channel.
[[nodiscard]] ReadingNoise reading_noise(const Problem& problem, const Linearisation& l);

/// Derivatives of one channel's whitened residuals by all shape parameters, its coefficients and, where it is free, its
/// optics: one column each, in that order.
[[nodiscard]] Eigen::MatrixXd whitened_columns(const Linearisation& l, const ReadingNoise& noise, std::size_t channel);

}  // namespace goniofit
