#pragma once
// The coefficients of one channel under a loss that is not quadratic in them.

#include <Eigen/Core>

#include "coefficient_solve.h"
#include "problem.h"

namespace goniofit {

/// The coefficients of least loss within the channel's bounds, from `start` on, by Gauss and Newton's steps: each
/// solves the equations linearised where it stands, and is halved until the loss falls. `columns` are weight * optics
/// factor * shape factor by row and basis column. Returns the loss, not what it exceeds the target's by.
[[nodiscard]] CoefficientSolver::Solution refine_coefficients(const Problem& problem, std::size_t channel,
                                                              const CoefficientSolver& solver,
                                                              const Eigen::MatrixXd& columns, const SmallVector& start);

}  // namespace goniofit
