#include "fit/coefficient_refine.h"

#include <cmath>

#include "fit/dot.h"

namespace goniofit {

namespace {

constexpr int most_steps = 40, most_halvings = 12;
constexpr double good_enough = 1e-7;  // of the loss: the search compares, the polish finishes

class Refiner {
 public:
  Refiner(const Problem& problem, std::size_t channel, const CoefficientSolver& solver, const Eigen::MatrixXd& columns)
      : problem_(problem), channel_(problem.channels[channel]), solver_(solver), columns_(columns) {}

  CoefficientSolver::Solution from(SmallVector k) {
    double loss = evaluate(k);
    for (int step = 0; step < most_steps; ++step) {
      const double before = loss;
      const SmallVector target = linear_solution(k);
      for (int halving = 0; halving < most_halvings; ++halving) {
        const SmallVector there = k + std::ldexp(1.0, -halving) * (target - k);
        const double value = evaluate(there);
        if (!(value < loss)) continue;
        k = there;
        loss = value;
        break;
      }
      if (!(loss < before * (1.0 - good_enough))) break;
    }
    return {k, loss};
  }

 private:
  [[nodiscard]] double evaluate(const SmallVector& k) {
    weighted_ = Eigen::VectorXd::Zero(columns_.rows());
    const SmallVector a = solver_.amplitudes(k);
    for (Eigen::Index j = 0; j < columns_.cols(); ++j) {
      if (a[j] != 0.0) add_scaled(a[j], columns_.col(j).data(), weighted_.data(), rows());
    }
    double loss = 0.0;
    residual_.resize(weighted_.size());
    slope_.resize(weighted_.size());
    for (Eigen::Index i = 0; i < weighted_.size(); ++i) {
      const BentResidual r = bent_residual(problem_, channel_, i, weighted_[i] / problem_.weight[i]);
      residual_[i] = r.residual;
      slope_[i] = r.slope / problem_.weight[i];
      loss += r.loss;
    }
    return loss;
  }

  // Of |slope (columns a - weighted) + residual|².
  [[nodiscard]] SmallVector linear_solution(const SmallVector& k) {
    (void)evaluate(k);
    const Eigen::Index n = columns_.cols();
    Eigen::MatrixXd sloped(columns_.rows(), n);
    const Eigen::VectorXd target = slope_.cwiseProduct(weighted_) - residual_;
    SmallMatrix gram(n, n);
    SmallVector rhs(n);
    for (Eigen::Index j = 0; j < n; ++j) {
      multiply(slope_.data(), columns_.col(j).data(), sloped.col(j).data(), rows());
      rhs[j] = dot(sloped.col(j).data(), target.data(), rows());
      for (Eigen::Index i = 0; i <= j; ++i) {
        gram(i, j) = gram(j, i) = dot(sloped.col(i).data(), sloped.col(j).data(), rows());
      }
    }
    return solver_.solve(gram, rhs, channel_.lower, channel_.upper).k;
  }

  [[nodiscard]] std::size_t rows() const noexcept { return static_cast<std::size_t>(columns_.rows()); }

  const Problem& problem_;
  const ProblemChannel& channel_;
  const CoefficientSolver& solver_;
  const Eigen::MatrixXd& columns_;
  Eigen::VectorXd weighted_, residual_, slope_;
};

}  // namespace

CoefficientSolver::Solution refine_coefficients(const Problem& problem, std::size_t channel,
                                                const CoefficientSolver& solver, const Eigen::MatrixXd& columns,
                                                const SmallVector& start) {
  return Refiner(problem, channel, solver, columns).from(start);
}

}  // namespace goniofit
