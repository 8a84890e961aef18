#pragma once
// The noise that sets of effects, and models, are compared by: one for all of them.

#include <Eigen/Core>
#include <limits>
#include <optional>

#include "selection_candidate.h"

namespace goniofit {

struct NoiseModel {
  std::optional<Noise> noise{};  ///< estimated; empty: the scan's own uncertainties
  double u_scale = 1.0;          ///< of these: above 1 where the residuals are larger (Birge ratio, by their median)
  Eigen::VectorXd variance{};    ///< one a reading, channel after channel, 1/sr²
  double deviance = std::numeric_limits<double>::infinity();  ///< -2 ln likelihood, less a constant
};

/// As one candidate sees it, whose inverse-variance fit it moves: the least deviance tells whose view to take.
[[nodiscard]] NoiseModel noise_of(Candidate& candidate);

/// The variance of that noise at the candidate's values.
[[nodiscard]] Eigen::VectorXd variance_at(const Candidate& candidate, const std::optional<Noise>& noise,
                                          double u_scale);

}  // namespace goniofit
