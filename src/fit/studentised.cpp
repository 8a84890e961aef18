#include "fit/studentised.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

#include "fit/unified_interval.h"

namespace goniofit {

namespace {

constexpr double full_leverage = 1.0 - 1e-9;
// From so many effective readings on Student's t will do.
constexpr double many = 200.0;
constexpr double of_account = 3e-3;
constexpr std::size_t most_readings = 16;

double normal_tail(double x) { return 0.5 * std::erfc(x * 0.7071067811865476); }

}  // namespace

SignedForm::SignedForm(const Eigen::MatrixXd& g, double rest, double rest_freedom)
    : rest_(rest), rest_freedom_(rest_freedom) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(g);
  eigenvalues_ = eigen.eigenvalues().array().max(0.0);
  weights_ = eigen.eigenvectors().row(0).transpose().array().square();
}

// K(s) = -½ ln det(1 - 2 s M) with M = e_0 e_0ᵀ - κ G: by the determinant of a matrix changed in rank one.
SignedForm::Cumulants SignedForm::cumulants(double s, double kappa) const {
  const Eigen::ArrayXd l = 2.0 * kappa * eigenvalues_;
  const Eigen::ArrayXd a = 1.0 + s * l;
  const double m = 2.0 * kappa * rest_ / rest_freedom_;
  const double b = 1.0 + s * m;
  if (!(a.minCoeff() > 0.0) || !(b > 0.0)) return {0.0, 0.0, 0.0, false};
  const Eigen::ArrayXd q = l / a;
  const Eigen::ArrayXd w = weights_ / a;
  const double g = w.sum();
  const double g1 = -(w * q).sum();
  const double g2 = 2.0 * (w * q * q).sum();
  const double d = 1.0 - 2.0 * s * g;
  if (!(d > 0.0)) return {0.0, 0.0, 0.0, false};
  const double d1 = (-2.0 * g - 2.0 * s * g1) / d;
  const double d2 = (-4.0 * g1 - 2.0 * s * g2) / d;
  return {-0.5 * (a.log().sum() + std::log(d) + rest_freedom_ * std::log(b)),
          -0.5 * (q.sum() + d1 + rest_freedom_ * m / b),
          0.5 * (q.square().sum() - d2 + d1 * d1 + rest_freedom_ * m * m / (b * b)), true};
}

// Where the first cumulant is 0; infinity where it never is: the form is negative throughout.
double SignedForm::saddlepoint(double kappa) const {
  const double direction = cumulants(0.0, kappa).first < 0.0 ? 1.0 : -1.0;
  double inner = 0.0;
  double outer = 0.25 * direction;
  for (int i = 0;; ++i) {
    const Cumulants at = cumulants(outer, kappa);
    if (!at.inside || at.first * direction >= 0.0) break;
    if (i == 60) return direction * std::numeric_limits<double>::infinity();
    inner = outer;
    outer *= 2.0;
  }
  double s = 0.5 * (inner + outer);
  for (int i = 0; i < 100; ++i) {
    const Cumulants at = cumulants(s, kappa);
    if (!at.inside || at.first * direction >= 0.0) {
      outer = s;
    } else {
      inner = s;
    }
    const double newton = at.inside ? s - at.first / at.second : outer;
    const bool between = (newton - inner) * (newton - outer) < 0.0;
    const double next = between ? newton : 0.5 * (inner + outer);
    if (at.inside && std::fabs(next - s) <= 1e-9 * std::fabs(s)) break;
    s = next;
  }
  return cumulants(s, kappa).inside ? s : inner;
}

double SignedForm::positive(double kappa) const {
  // Where the mean is 0 the formula is 0/0; a step aside it is good to as many digits as are wanted.
  for (int aside = 0; aside < 3; ++aside, kappa *= 1.001) {
    const double s = saddlepoint(kappa);
    if (std::isinf(s)) return s > 0.0 ? 0.0 : 1.0;
    const Cumulants at = cumulants(s, kappa);
    const double w = std::copysign(std::sqrt(std::max(-2.0 * at.value, 0.0)), s);
    if (std::fabs(w) < 1e-4) continue;
    const double v = s * std::sqrt(at.second);
    return v / w > 0.0 ? normal_tail(w + std::log(v / w) / w) : normal_tail(w);
  }
  return 0.5;
}

double SignedForm::factor(double probability) const {
  const auto excess = [&](double log_kappa) { return 1.0 - probability - positive(std::exp(log_kappa)); };
  double low = -4.0;
  double high = 2.0;
  while (excess(high) < 0.0 && high < 20.0) high += 2.0;
  if (excess(low) >= 0.0 || excess(high) <= 0.0) return std::exp(0.5 * high);
  std::uintmax_t iterations = 40;
  const auto [a, b] =
      boost::math::tools::toms748_solve(excess, low, high, boost::math::tools::eps_tolerance<double>(14), iterations);
  return std::exp(0.25 * (a + b));
}

// K by JᵀΩJ, not by triangles as the covariances: of a probability three digits are enough.
Studentised::Studentised(const JointJacobian& j, const std::vector<Eigen::VectorXd>& variance,
                         const Eigen::ArrayXd& count, const std::vector<Eigen::Index>& parameters)
    : j_(j),
      variance_(variance),
      count_(count),
      parameters_(parameters),
      meat_(j.rough_meat(times_counts(variance, count))) {
  const Eigen::MatrixXd rows = j.root()(parameters, Eigen::all);
  truth_ = (rows * meat_).cwiseProduct(rows).rowwise().sum();
  mean_ = squares_ = Eigen::VectorXd::Zero(rows.rows());
  for (std::size_t c = 0; c < variance.size(); ++c) add(c);
}

// In a channel the estimates of other channels' parameters enter through the shape alone: nearly all are the multiples
// of one, and share what it takes the readings' time to sum.
void Studentised::add(std::size_t c) {
  const JacobianBlock& block = j_.blocks()[c];
  const Eigen::VectorXd leverage = j_.leverages(c);
  const Eigen::MatrixXd own = j_.own_root(c);
  const Eigen::MatrixXd in_own = own * meat_ * own.transpose();
  Eigen::ArrayXd in_fit = Eigen::ArrayXd::Zero(block.rows());
  for (Eigen::Index p = 0; p < block.cols(); ++p)
    in_fit += block.times(in_own.col(p)).array() * block.column(p).array();
  const Eigen::ArrayXd& s = s_.emplace_back(variance_[c].array() * (1.0 - 2.0 * leverage.array()) + in_fit);
  const Eigen::ArrayXd factor =
      (leverage.array() < full_leverage).select((1.0 - leverage.array()).inverse().square() * s, 0.0);
  std::vector<Direction>& directions = directions_.emplace_back();
  std::vector<Share>& shares = shares_.emplace_back();
  for (Eigen::Index k = 0; k < mean_.size(); ++k) {
    const Eigen::VectorXd by = own * j_.root().row(parameters_[static_cast<std::size_t>(k)]).transpose();
    const Share share = share_of(by, directions);
    if (share.direction == directions.size()) directions.push_back(direction_of(c, by, factor));
    mean_[k] += share.square * directions[share.direction].mean;
    squares_[k] += share.square * share.square * directions[share.direction].squares;
    shares.push_back(share);
  }
}

Studentised::Share Studentised::share_of(const Eigen::VectorXd& by, const std::vector<Direction>& directions) {
  constexpr double alike = 1e-9;
  for (std::size_t d = 0; d < directions.size(); ++d) {
    const Eigen::VectorXd& other = directions[d].by;
    const double multiple = other.squaredNorm() > 0.0 ? by.dot(other) / other.squaredNorm() : 0.0;
    if ((by - multiple * other).norm() <= alike * by.norm()) return {d, multiple * multiple};
  }
  return {directions.size(), 1.0};
}

Studentised::Direction Studentised::direction_of(std::size_t c, const Eigen::VectorXd& by,
                                                 const Eigen::ArrayXd& factor) const {
  const Eigen::ArrayXd parts = j_.blocks()[c].times(by).array().square() * factor;
  Direction out{by, parts.sum(), parts.matrix().squaredNorm(), {}};
  if (count_.size() > 0) {
    out.mean = (count_ * parts).sum();
    out.squares = (count_ * parts.square()).sum();
  }
  const auto more = [](const Reading& a, const Reading& b) { return a.part > b.part; };
  // The largest, in a heap whose front is the least of them; of equal ones the first stay.
  for (Eigen::Index i = 0; i < parts.size(); ++i) {
    const bool full = out.largest.size() == most_readings;
    if (full && !(parts[i] > out.largest.front().part)) continue;
    if (full) {
      std::pop_heap(out.largest.begin(), out.largest.end(), more);
      out.largest.pop_back();
    }
    out.largest.push_back({c, i, parts[i]});
    std::push_heap(out.largest.begin(), out.largest.end(), more);
  }
  std::sort(out.largest.begin(), out.largest.end(), [](const Reading& a, const Reading& b) { return a.row < b.row; });
  return out;
}

std::vector<Studentised::Reading> Studentised::of_most_account(Eigen::Index column) const {
  std::vector<Reading> out;
  for (std::size_t c = 0; c < shares_.size(); ++c) {
    const Share& share = shares_[c][static_cast<std::size_t>(column)];
    for (const Reading& r : directions_[c][share.direction].largest) {
      const double part = share.square * r.part;
      if (part > of_account * mean_[column]) out.push_back({c, r.row, part});
    }
  }
  std::stable_sort(out.begin(), out.end(), [](const Reading& a, const Reading& b) { return a.part > b.part; });
  if (out.size() > most_readings) out.resize(most_readings);
  return out;
}

// G of η: z = η_0, and r = Cov(r, z) η_0 plus what is not in z, by a root of its covariance.
Eigen::MatrixXd Studentised::form(Eigen::Index column, const std::vector<Reading>& readings) const {
  const auto m = static_cast<Eigen::Index>(readings.size());
  Eigen::MatrixXd u(m, j_.size());
  Eigen::VectorXd omega(m);
  Eigen::VectorXd x(m);
  for (Eigen::Index i = 0; i < m; ++i) {
    const Reading& r = readings[static_cast<std::size_t>(i)];
    u.row(i) = j_.blocks()[r.channel].row(r.row) * j_.own_root(r.channel);
    omega[i] = variance_[r.channel][r.row];
    x[i] = r.part / s_[r.channel][r.row];
  }
  const Eigen::VectorXd own = j_.root().row(parameters_[static_cast<std::size_t>(column)]).transpose();
  const double v = truth_[column];
  const Eigen::VectorXd with_z = (omega.asDiagonal() * (u * own) - u * (meat_ * own)) / std::sqrt(v);
  const Eigen::MatrixXd h = u * u.transpose();
  Eigen::MatrixXd apart = u * meat_ * u.transpose() - omega.asDiagonal() * h - h * omega.asDiagonal();
  apart.diagonal() += omega;
  apart -= with_z * with_z.transpose();
  // Residuals may depend on each other linearly: no Cholesky.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(apart);
  Eigen::MatrixXd root(m, m + 1);
  root.col(0) = with_z;
  root.rightCols(m) = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  return root.transpose() * (x / v).asDiagonal() * root;
}

Studentised::Factors Studentised::factors(std::size_t position) const {
  const auto column = static_cast<Eigen::Index>(position);
  const double v = truth_[column];
  const double mean = mean_[column];
  const double freedom = mean * mean / squares_[column];
  const double bias = v > 0.0 && mean > 0.0 ? std::sqrt(v / mean) : 1.0;
  const Factors simple{bias * coverage_factor(probability_68, freedom),
                       bias * coverage_factor(probability_95, freedom)};
  if (!(freedom < many) || !(v > 0.0)) return simple;
  const std::vector<Reading> readings = of_most_account(column);
  double rest = mean;
  double rest_squares = squares_[column];
  for (const Reading& r : readings) {
    rest -= r.part;
    rest_squares -= r.part * r.part;
  }
  rest = std::max(rest, 1e-9 * mean);
  const double rest_freedom = std::clamp(rest * rest / std::max(rest_squares, 1e-300), 1.0, 1e6);
  const SignedForm signed_form(form(column, readings), rest / v, rest_freedom);
  const Factors exact{signed_form.factor(probability_68), signed_form.factor(probability_95)};
  return std::isfinite(exact.at_68) && std::isfinite(exact.at_95) ? exact : simple;
}

}  // namespace goniofit
