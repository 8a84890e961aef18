#pragma once
// The step of Gauss and Newton from a point, within the bounds of all parameters, for any subset of the readings: from
// one linearisation every fit that leaves readings out is a small quadratic problem.

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "model.h"
#include "problem.h"
#include "search.h"

namespace goniofit {

/// min over lower <= x <= upper of xᵀ H x / 2 + gᵀ x, with 0 inside the bounds. H symmetric, positive semidefinite, of
/// any size; a column of zeros stays at 0. Active-set method; bounds may be equal or infinite.
[[nodiscard]] Eigen::VectorXd bounded_newton_step(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient,
                                                  const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);

/// JᵀJ, Jᵀr and rᵀr of each group of readings, over all parameters: shape, then each channel's coefficients and, where
/// free, optics.
class GroupedEquations {
 public:
  /// `of` is each reading's group, 0 to groups - 1.
  GroupedEquations(const Problem& problem, const FitPoint& point, const std::vector<std::size_t>& of,
                   std::size_t groups);

  /// `at` moved by the step of all readings but those of `group`; with the loss of these readings that the quadratic
  /// promises.
  struct Step {
    FitPoint point;
    double promised = 0.0;
  };
  [[nodiscard]] Step without(std::size_t group) const;

 private:
  [[nodiscard]] Eigen::Index first_of(std::size_t channel) const noexcept {
    return shape_ + static_cast<Eigen::Index>(channel) * own_;
  }
  void add(std::size_t channel, const Linearisation& l, const std::vector<std::vector<Eigen::Index>>& rows);
  void set_bounds();

  const Problem& problem_;
  FitPoint at_;
  Eigen::Index shape_, own_;  ///< parameters shared, and of one channel
  struct Equations {
    Eigen::MatrixXd hessian;
    Eigen::VectorXd gradient;
    double loss = 0.0;
  };
  std::vector<Equations> groups_;
  Eigen::VectorXd lower_, upper_;
};

}  // namespace goniofit
