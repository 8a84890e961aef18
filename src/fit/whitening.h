#pragma once
// The noise of every reading: what the rows of a Jacobian are to be divided by before it says what is known.

#include <Eigen/Core>
#include <vector>

#include "model.h"
#include "problem.h"

namespace goniofit {

/// As a part of the value and an additive one; where the scan states uncertainties, by these.
struct NoiseModel {
  std::vector<Noise> model{};  ///< one a channel
  /// What the residuals exceed the stated uncertainties by (the median's Birge ratio); 0 where none are stated.
  std::vector<double> birge_ratio{};
  double least = 0.0;  ///< 1/sr, of any reading
};

/// Of each reading of one channel.
struct RowNoise {
  Eigen::VectorXd sd;        ///< 1/sr
  Eigen::VectorXd whitener;  ///< 1 / sd in the unit of the residuals: weight and emphasis divided out
};

/// Of all readings, one vector a channel.
struct ReadingNoise : NoiseModel {
  std::vector<Eigen::VectorXd> sd{}, whitener{};
};

/// The readings, at most a thousand and evenly along the scan, that the noise is told from.
[[nodiscard]] std::vector<std::size_t> rows_that_tell_noise(const Problem& problem);
/// The scan's own uncertainties where it states them, enlarged by their Birge ratio; else estimate_noise() of the
/// residuals. `l` is of `some`, a part of the problem or all of it.
[[nodiscard]] NoiseModel noise_model(const Problem& problem, const Problem& some, const Linearisation& l);
[[nodiscard]] RowNoise noise_of_rows(const Problem& part, const Linearisation& l, const NoiseModel& noise,
                                     std::size_t channel);
/// Of a problem in one piece.
[[nodiscard]] ReadingNoise reading_noise(const Problem& problem, const Linearisation& l);

/// Derivatives of one channel's whitened residuals by all shape parameters, its coefficients and, where it is free, its
/// optics: one column each, in that order.
[[nodiscard]] Eigen::MatrixXd whitened_columns(const Linearisation& l, const ReadingNoise& noise, std::size_t channel);

}  // namespace goniofit
