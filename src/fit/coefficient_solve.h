#pragma once
// The coefficients of one channel at given shape and optics, from the normal equations of the basis columns.

#include "../basis/basis.h"
#include "bounded_least_squares.h"

namespace goniofit {

class CoefficientSolver {
 public:
  explicit CoefficientSolver(const Basis& basis);

  struct Solution {
    SmallVector k;       ///< by coefficient
    double value = 0.0;  ///< what the loss exceeds the squared norm of the target by; at most 0 where 0 is feasible
  };
  /// gram and rhs by column; bounds by coefficient. Coefficients that enter linearly are solved exactly; the one that
  /// also enters squared (a basis has at most one) is searched over its interval, the others solved inside.
  [[nodiscard]] Solution solve(const SmallMatrix& gram, const SmallVector& rhs, const SmallVector& lower,
                               const SmallVector& upper) const;
  /// What each column is multiplied by.
  [[nodiscard]] SmallVector amplitudes(const SmallVector& k) const;

 private:
  struct Equations {
    SmallMatrix gram;
    SmallVector rhs, lower, upper;
  };
  [[nodiscard]] Solution solve_squared(Equations& e) const;

  const Basis& basis_;
  /// Unknown of each column: coefficients first, then the square of the one that has one.
  std::vector<Eigen::Index> unknown_;
  Eigen::Index coefficients_, unknowns_;
  Eigen::Index squared_ = -1;  ///< the coefficient that enters squared too
};

}  // namespace goniofit
