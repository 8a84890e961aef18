#include "fit/spread.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace goniofit {

namespace {

// A reading that alone determines a parameter has no residual to speak of, and the parameter no uncertainty to state.
constexpr double full_leverage = 1.0 - 1e-9;
// Above it Student's t is the normal distribution to 2 %: what readings have in common is then of no account.
constexpr double few = 60.0;
// Readings with less than this part of a variance have no say in its degrees of freedom together with others.
constexpr double of_account = 2e-3;

// The moments of HC3's variances where the noise has the variances given. Of one parameter, a_i = [(JᵀJ)⁻¹ Jᵀ]_i, it is
// Σ x_i r_i², x_i = a_i² / (1 - h_i)², of residuals with covariance S = (1 - H) Ω (1 - H):
//
//   mean  Σ x_i S_ii,   variance  2 Σ_ij x_i x_j S_ij²,   S_ij = δ_ij ω_i - H_ij (ω_i + ω_j) + U_i K U_jᵀ
//
// with U = J B and K = Uᵀ Ω U.
class Moments {
 public:
  Moments(const JointJacobian& j, const std::vector<Eigen::VectorXd>& leverage,
          const std::vector<Eigen::VectorXd>& variance)
      : j_(j), variance_(variance) {
    std::vector<Eigen::VectorXd> sd;
    for (const Eigen::VectorXd& v : variance) sd.emplace_back(v.cwiseSqrt());
    meat_ = j.meat(sd);
    truth_ = (j.root() * meat_).cwiseProduct(j.root()).rowwise().sum();
    mean_ = squares_ = Eigen::VectorXd::Zero(j.size());
    for (std::size_t c = 0; c < variance.size(); ++c) add(c, leverage[c]);
  }
  [[nodiscard]] CoverageFactors factors(Eigen::Index parameter) const {
    const double mean = mean_[parameter];
    if (!(mean > 0.0) || !(truth_[parameter] > 0.0)) return {};
    double squares = squares_[parameter];
    if (mean * mean < few * squares) squares += common_squares(parameter);
    const double bias = std::sqrt(truth_[parameter] / mean);
    const CoverageFactors k = coverage_factors(mean * mean / squares);
    return {bias * k.at_68, bias * k.at_95};
  }

 private:
  struct Reading {
    Eigen::VectorXd u;  ///< row of U
    double variance, x;
  };

  void add(std::size_t c, const Eigen::VectorXd& leverage) {
    const JacobianBlock& b = j_.blocks()[c];
    const Eigen::MatrixXd own = j_.own_root(c);
    const Eigen::MatrixXd quadratic = own * meat_ * own.transpose();
    Eigen::ArrayXd in_fit = (b.jacobian * quadratic).cwiseProduct(b.jacobian).rowwise().sum();
    const Eigen::ArrayXd s = variance_[c].array() * (1.0 - 2.0 * leverage.array()) + in_fit;
    Eigen::ArrayXd factor = (1.0 - leverage.array()).inverse().square();
    factor = (leverage.array() < full_leverage).select(factor, 0.0);
    factor_.emplace_back(factor);
    part_.emplace_back(factor * s);
    weight_.emplace_back(own * j_.root().transpose());
    const Eigen::MatrixXd parts = ((b.jacobian * weight_.back()).array().square().colwise() * part_.back()).matrix();
    mean_ += parts.colwise().sum().transpose();
    squares_ += parts.colwise().squaredNorm().transpose();
  }

  [[nodiscard]] std::vector<Reading> readings_of_account(Eigen::Index parameter) const {
    std::vector<Reading> out;
    for (std::size_t c = 0; c < part_.size(); ++c) {
      const JacobianBlock& b = j_.blocks()[c];
      const Eigen::ArrayXd a2 = (b.jacobian * weight_[c].col(parameter)).array().square();
      const Eigen::MatrixXd own = j_.own_root(c);
      for (Eigen::Index i = 0; i < a2.size(); ++i) {
        if (a2[i] * part_[c][i] < of_account * mean_[parameter]) continue;
        out.push_back({own.transpose() * b.jacobian.row(i).transpose(), variance_[c][i], a2[i] * factor_[c][i]});
      }
    }
    return out;
  }

  [[nodiscard]] double common_squares(Eigen::Index parameter) const {
    const std::vector<Reading> readings = readings_of_account(parameter);
    double sum = 0.0;
    for (std::size_t a = 0; a < readings.size(); ++a) {
      const Eigen::VectorXd in_fit = meat_ * readings[a].u;
      for (std::size_t b = 0; b < a; ++b) {
        const double s = in_fit.dot(readings[b].u) -
                         readings[a].u.dot(readings[b].u) * (readings[a].variance + readings[b].variance);
        sum += 2.0 * readings[a].x * readings[b].x * s * s;
      }
    }
    return sum;
  }

  const JointJacobian& j_;
  const std::vector<Eigen::VectorXd>& variance_;
  Eigen::MatrixXd meat_;
  Eigen::VectorXd truth_, mean_, squares_;
  std::vector<Eigen::ArrayXd> factor_, part_;  ///< [channel]
  std::vector<Eigen::MatrixXd> weight_;        ///< [channel]: rows of (JᵀJ)⁻¹
};

}  // namespace

CoverageFactors coverage_factors(double freedom) {
  return {coverage_factor(probability_68, freedom), coverage_factor(probability_95, freedom)};
}

Spread spread_by_readings(const JointJacobian& j, const std::vector<Eigen::VectorXd>& sd) {
  const auto size = static_cast<std::size_t>(j.size());
  return {j.root() * j.meat(sd) * j.root().transpose(), std::vector<CoverageFactors>(size),
          std::vector<bool>(size, false)};
}

Spread spread_by_residuals(const JointJacobian& j, const std::vector<Eigen::VectorXd>& residuals,
                           const std::vector<Eigen::VectorXd>& variance) {
  Spread out;
  out.single.assign(static_cast<std::size_t>(j.size()), false);
  std::vector<Eigen::VectorXd> e;
  std::vector<Eigen::VectorXd> leverages;
  for (std::size_t c = 0; c < residuals.size(); ++c) {
    const JacobianBlock& b = j.blocks()[c];
    const Eigen::VectorXd& leverage = leverages.emplace_back(j.leverages(c));
    Eigen::VectorXd& own_e = e.emplace_back(leverage.size());
    for (Eigen::Index i = 0; i < leverage.size(); ++i) {
      const bool decides = leverage[i] >= full_leverage;
      own_e[i] = decides ? 0.0 : residuals[c][i] / (1.0 - leverage[i]);
      for (Eigen::Index p = 0; decides && p < b.jacobian.cols(); ++p) {
        const Eigen::Index place = b.index[static_cast<std::size_t>(p)];
        if (b.jacobian(i, p) * b.jacobian(i, p) * j.root().row(place).squaredNorm() > 0.25)
          out.single[static_cast<std::size_t>(place)] = true;
      }
    }
  }
  out.covariance = j.root() * j.meat(e) * j.root().transpose();
  const Moments moments(j, leverages, variance);
  for (Eigen::Index p = 0; p < j.size(); ++p) out.k.push_back(moments.factors(p));
  return out;
}

}  // namespace goniofit
