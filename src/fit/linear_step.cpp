#include "fit/linear_step.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace goniofit {

namespace {

// So long a step in the logarithm of a shape parameter is none that a linearisation can vouch for.
constexpr double longest_shape_step = 0.5;

// Minimum over the free ones, the others where they are. Equilibrated, and with a ridge far below what counts:
// dependent columns share what they could take.
Eigen::VectorXd free_minimum(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient, const Eigen::VectorXd& x,
                             const std::vector<Eigen::Index>& free) {
  constexpr double ridge = 1e-11;
  const auto n = static_cast<Eigen::Index>(free.size());
  Eigen::MatrixXd a(n, n);
  Eigen::VectorXd b(n);
  Eigen::VectorXd scale(n);
  const Eigen::VectorXd slope = gradient + hessian * x;
  for (Eigen::Index i = 0; i < n; ++i)
    scale[i] = 1.0 / std::sqrt(hessian(free[static_cast<std::size_t>(i)], free[static_cast<std::size_t>(i)]));
  for (Eigen::Index i = 0; i < n; ++i) {
    b[i] = -scale[i] * slope[free[static_cast<std::size_t>(i)]];
    for (Eigen::Index j = 0; j < n; ++j) {
      a(i, j) = scale[i] * scale[j] * hessian(free[static_cast<std::size_t>(i)], free[static_cast<std::size_t>(j)]);
    }
    a(i, i) += ridge;
  }
  Eigen::VectorXd y = x;
  const Eigen::VectorXd d = a.ldlt().solve(b);
  for (Eigen::Index i = 0; i < n; ++i) y[free[static_cast<std::size_t>(i)]] += scale[i] * d[i];
  return y;
}

}  // namespace

Eigen::VectorXd bounded_newton_step(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient,
                                    const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  const Eigen::Index n = gradient.size();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  std::vector<bool> held(static_cast<std::size_t>(n));
  const auto movable = [&](Eigen::Index i) { return hessian(i, i) > 0.0 && lower[i] < upper[i]; };
  for (Eigen::Index i = 0; i < n; ++i) {
    held[static_cast<std::size_t>(i)] =
        !movable(i) || (lower[i] >= 0.0 && gradient[i] >= 0.0) || (upper[i] <= 0.0 && gradient[i] <= 0.0);
  }
  for (Eigen::Index pass = 0; pass < 4 * n; ++pass) {
    std::vector<Eigen::Index> free;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (!held[static_cast<std::size_t>(i)]) free.push_back(i);
    }
    const Eigen::VectorXd y = free_minimum(hessian, gradient, x, free);
    double reach = 1.0;
    Eigen::Index blocking = -1;
    for (const Eigen::Index i : free) {
      const double bound = y[i] < lower[i] ? lower[i] : upper[i];
      if (y[i] >= lower[i] && y[i] <= upper[i]) continue;
      const double own = std::clamp((bound - x[i]) / (y[i] - x[i]), 0.0, 1.0);
      if (blocking >= 0 && own >= reach) continue;
      reach = own;
      blocking = i;
    }
    x += reach * (y - x);
    if (blocking >= 0) {
      x[blocking] = y[blocking] < lower[blocking] ? lower[blocking] : upper[blocking];
      held[static_cast<std::size_t>(blocking)] = true;
      continue;
    }
    const Eigen::VectorXd slope = gradient + hessian * x;
    Eigen::Index release = -1;
    double most = 1e-12;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (!held[static_cast<std::size_t>(i)] || !movable(i)) continue;
      const double gain = (x[i] <= lower[i] ? -slope[i] : slope[i]) / std::sqrt(hessian(i, i));
      if (gain <= most) continue;
      most = gain;
      release = i;
    }
    if (release < 0) break;
    held[static_cast<std::size_t>(release)] = false;
  }
  return x;
}

GroupedEquations::GroupedEquations(const Problem& problem, const FitPoint& point, const std::vector<std::size_t>& of,
                                   std::size_t groups)
    : problem_(problem),
      at_(point),
      shape_(problem.shape.free),
      own_(static_cast<Eigen::Index>(problem.basis->coefficients().size()) + (point.optics.empty() ? 0 : 1)) {
  const Eigen::Index n = first_of(problem.channels.size());
  groups_.assign(groups, {Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), 0.0});
  std::vector<std::vector<Eigen::Index>> rows(groups);
  for (std::size_t i = 0; i < of.size(); ++i) rows[of[i]].push_back(static_cast<Eigen::Index>(i));
  const Linearisation l = linearise(problem, point);
  for (std::size_t c = 0; c < problem.channels.size(); ++c) add(c, l, rows);
  set_bounds();
}

void GroupedEquations::add(std::size_t channel, const Linearisation& l,
                           const std::vector<std::vector<Eigen::Index>>& rows) {
  const Eigen::Index first = first_of(channel);
  const Eigen::Index width = shape_ + own_;
  const Eigen::Index coefficients = l.by_coefficient[channel].cols();
  for (std::size_t g = 0; g < rows.size(); ++g) {
    Eigen::MatrixXd j(static_cast<Eigen::Index>(rows[g].size()), width + 1);
    j.leftCols(shape_) = l.by_shape[channel](rows[g], Eigen::all);
    j.middleCols(shape_, coefficients) = l.by_coefficient[channel](rows[g], Eigen::all);
    if (own_ > coefficients) j.col(width - 1) = l.by_optics[channel](rows[g]);
    j.col(width) = l.residuals[channel](rows[g]);
    const Eigen::MatrixXd product = j.transpose() * j;
    Equations& e = groups_[g];
    e.hessian.topLeftCorner(shape_, shape_) += product.topLeftCorner(shape_, shape_);
    e.hessian.block(0, first, shape_, own_) = product.block(0, shape_, shape_, own_);
    e.hessian.block(first, 0, own_, shape_) = product.block(shape_, 0, own_, shape_);
    e.hessian.block(first, first, own_, own_) = product.block(shape_, shape_, own_, own_);
    e.gradient.head(shape_) += product.col(width).head(shape_);
    e.gradient.segment(first, own_) = product.col(width).segment(shape_, own_);
    e.loss += product(width, width);
  }
}

void GroupedEquations::set_bounds() {
  const Eigen::Index n = first_of(problem_.channels.size());
  lower_.resize(n);
  upper_.resize(n);
  for (Eigen::Index i = 0; i < shape_; ++i) {
    const auto z = static_cast<std::size_t>(i);
    lower_[i] = std::max(problem_.shape.lower[z] - at_.z[z], -longest_shape_step);
    upper_[i] = std::min(problem_.shape.upper[z] - at_.z[z], longest_shape_step);
  }
  for (std::size_t c = 0; c < problem_.channels.size(); ++c) {
    const ProblemChannel& channel = problem_.channels[c];
    const Eigen::Index first = first_of(c);
    const Eigen::Index count = channel.lower.size();
    lower_.segment(first, count) = channel.lower - at_.coefficients[c];
    upper_.segment(first, count) = channel.upper - at_.coefficients[c];
    if (own_ == count) continue;
    lower_[first + count] = channel.optics_lower - at_.optics[c];
    upper_[first + count] = channel.optics_upper - at_.optics[c];
  }
}

GroupedEquations::Step GroupedEquations::without(std::size_t group) const {
  const Eigen::Index n = lower_.size();
  Equations sum{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), 0.0};
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    if (g == group) continue;
    sum.hessian += groups_[g].hessian;
    sum.gradient += groups_[g].gradient;
    sum.loss += groups_[g].loss;
  }
  // Round-off may leave the point beyond a bound by its last digit.
  const Eigen::VectorXd x = bounded_newton_step(sum.hessian, sum.gradient, lower_.cwiseMin(0.0), upper_.cwiseMax(0.0));
  Step step{at_, sum.loss + 2.0 * sum.gradient.dot(x) + x.dot(sum.hessian * x)};
  for (Eigen::Index i = 0; i < shape_; ++i) step.point.z[static_cast<std::size_t>(i)] += x[i];
  for (std::size_t c = 0; c < problem_.channels.size(); ++c) {
    const Eigen::Index first = first_of(c);
    SmallVector& k = step.point.coefficients[c];
    k += x.segment(first, k.size());
    k = k.cwiseMax(problem_.channels[c].lower).cwiseMin(problem_.channels[c].upper);
    if (own_ > k.size()) step.point.optics[c] += x[first + k.size()];
  }
  return step;
}

}  // namespace goniofit
