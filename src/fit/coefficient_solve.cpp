#include "fit/coefficient_solve.h"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cstdint>

namespace goniofit {

CoefficientSolver::CoefficientSolver(const Basis& basis)
    : basis_(basis), coefficients_(static_cast<Eigen::Index>(basis.coefficients().size())), unknowns_(coefficients_) {
  for (const BasisColumn& column : basis.columns()) {
    const auto k = static_cast<Eigen::Index>(column.coefficient);
    if (column.power == 1) {
      unknown_.push_back(k);
      continue;
    }
    squared_ = k;
    unknowns_ = coefficients_ + 1;
    unknown_.push_back(coefficients_);
  }
}

SmallVector CoefficientSolver::amplitudes(const SmallVector& k) const {
  SmallVector a(static_cast<Eigen::Index>(unknown_.size()));
  for (std::size_t j = 0; j < unknown_.size(); ++j) {
    const bool square = unknown_[j] == coefficients_;
    const double value = k[square ? squared_ : unknown_[j]];
    a[static_cast<Eigen::Index>(j)] = square ? value * value : value;
  }
  return a;
}

CoefficientSolver::Solution CoefficientSolver::solve(const SmallMatrix& gram, const SmallVector& rhs,
                                                     const SmallVector& lower, const SmallVector& upper) const {
  Equations e{SmallMatrix::Zero(unknowns_, unknowns_), SmallVector::Zero(unknowns_), SmallVector(unknowns_),
              SmallVector(unknowns_)};
  for (Eigen::Index i = 0; i < gram.rows(); ++i) {
    const Eigen::Index u = unknown_[static_cast<std::size_t>(i)];
    e.rhs[u] += rhs[i];
    for (Eigen::Index j = 0; j < gram.cols(); ++j) e.gram(u, unknown_[static_cast<std::size_t>(j)]) += gram(i, j);
  }
  e.lower.head(coefficients_) = lower;
  e.upper.head(coefficients_) = upper;
  if (squared_ >= 0) return solve_squared(e);
  const BoundedSolution s = solve_bounded(e.gram, e.rhs, e.lower, e.upper);
  return {s.x, s.value};
}

// The loss over the squared coefficient alone is the lower envelope of quartics, and has few dips: a coarse scan and
// Brent's method about its best point.
CoefficientSolver::Solution CoefficientSolver::solve_squared(Equations& e) const {
  const double lower = e.lower[squared_];
  const double upper = e.upper[squared_];
  BoundedSolution at_best;
  const auto value_at = [&](double k) {
    e.lower[squared_] = e.upper[squared_] = k;
    e.lower[coefficients_] = e.upper[coefficients_] = k * k;
    at_best = solve_bounded(e.gram, e.rhs, e.lower, e.upper);
    return at_best.value;
  };
  constexpr int intervals = 8;
  const double step = (upper - lower) / intervals;
  double best = lower;
  double best_value = value_at(lower);
  for (int i = 1; i <= intervals && step > 0.0; ++i) {
    const double k = lower + i * step;
    if (const double value = value_at(k); value < best_value) {
      best = k;
      best_value = value;
    }
  }
  if (step > 0.0) {
    std::uintmax_t most = 30;
    const auto [k, value] = boost::math::tools::brent_find_minima(value_at, std::max(lower, best - step),
                                                                  std::min(upper, best + step), 26, most);
    if (value < best_value) best = k;
  }
  const double value = value_at(best);
  return {at_best.x.head(coefficients_), value};
}

}  // namespace goniofit
