#pragma once
// min over lower <= x <= upper of xᵀ G x - 2 bᵀ x: the coefficients of a model at given shape, from its normal
// equations.

#include <Eigen/Core>
#include <cstdint>

namespace goniofit {

inline constexpr int max_columns = 8;
/// No allocation: at most max_columns wide.
using SmallMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, max_columns, max_columns>;
using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, max_columns, 1>;

enum class BoundState : std::uint8_t { free, at_lower, at_upper };

struct BoundedSolution {
  SmallVector x;
  double value = 0.0;  ///< xᵀ G x - 2 bᵀ x, at most 0 where 0 is feasible
  Eigen::Array<BoundState, Eigen::Dynamic, 1, Eigen::ColMajor, max_columns, 1> state;
};

/// G symmetric positive semidefinite. Bounds may be infinite or equal. A column of zeros leaves its x at the bound
/// nearest to 0; among columns that are dependent to 1e-13, the first keep what the others could take as well.
/// Active-set method on the equilibrated equations; every case ends.
[[nodiscard]] BoundedSolution solve_bounded(const SmallMatrix& gram, const SmallVector& rhs, const SmallVector& lower,
                                            const SmallVector& upper);

}  // namespace goniofit
