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

// How HC3's variances are distributed together with the estimates where the noise is normal with the variances given.
// Of one parameter let a = J (JᵀJ)⁻¹'s column, so that the estimate is off by aᵀε, of variance V, and HC3's is
//
//   Σ x_i r_i²,  x_i = a_i² / (1 - h_i)²,  r = (1 - H) ε of covariance S, S_ij = δ_ij ω_i - H_ij (ω_i + ω_j) + U_i K
//   U_jᵀ
//
// with U = J B and K = Uᵀ Ω U. The readings that decide the estimate decide its variance too, so the two are not
// independent as in Student's t. With z = aᵀε / √V and b_i = Cov(r_i, aᵀε), what of r is not in z apart,
//
//   Σ x_i r_i² / V = B z² + 2 C z + W,   B = Σ x_i b_i² / V²,
//
// W is independent of z, of mean m = Σ x_i S_ii / V - B, and C has mean 0 and variance
// c² = (yᵀSy - (bᵀy)²/V) / V³, y_i = x_i b_i. With C's share added to the variance of W at the edge of the interval and
// W taken as a chi-square of as many degrees of freedom as match, z² <= k² (B z² + W) has the probability wanted at
//
//   k² = q / (1 + q B),  q = t² / m.
class Studentised {
 public:
  Studentised(const JointJacobian& j, const std::vector<Eigen::VectorXd>& leverage,
              const std::vector<Eigen::VectorXd>& variance)
      : j_(j), variance_(variance) {
    std::vector<Eigen::VectorXd> sd;
    for (const Eigen::VectorXd& v : variance) sd.emplace_back(v.cwiseSqrt());
    meat_ = j.meat(sd);
    truth_ = (j.root() * meat_).cwiseProduct(j.root()).rowwise().sum();
    mean_ = squares_ = with_z_ = in_c_ = common_ = Eigen::VectorXd::Zero(j.size());
    for (std::size_t c = 0; c < variance.size(); ++c) add(c, leverage[c]);
    add_common();
  }
  [[nodiscard]] CoverageFactors factors(Eigen::Index parameter) const {
    const double v = truth_[parameter];
    if (!(mean_[parameter] > 0.0) || !(v > 0.0)) return {};
    double squares = squares_[parameter];
    if (mean_[parameter] * mean_[parameter] < few * squares) squares += common_squares(parameter);
    const double by_z = with_z_[parameter] / (v * v);
    const double mean = std::max(mean_[parameter] / v - by_z, 1e-6);
    const double c2 = std::max(in_c_[parameter] - common_[parameter] * common_[parameter] / v, 0.0) / (v * v * v);
    const double of_w = std::max(2.0 * squares / (v * v) - 2.0 * by_z * by_z - 4.0 * c2, 0.0);
    const auto factor = [&](double probability) {
      const double edge = coverage_factor(probability, std::numeric_limits<double>::infinity());
      const double t = coverage_factor(probability, 2.0 * mean * mean / (of_w + 4.0 * edge * edge * c2));
      const double q = t * t / mean;
      return std::sqrt(q / (1.0 + q * by_z));
    };
    return {factor(probability_68), factor(probability_95)};
  }

 private:
  struct Reading {
    Eigen::VectorXd u;  ///< row of U
    double variance, x;
  };

  // Arrays are readings x parameters.
  void add(std::size_t c, const Eigen::VectorXd& leverage) {
    const JacobianBlock& block = j_.blocks()[c];
    const Eigen::MatrixXd own = j_.own_root(c);
    const Eigen::ArrayXd in_fit =
        (block.jacobian * (own * meat_ * own.transpose())).cwiseProduct(block.jacobian).rowwise().sum();
    const Eigen::ArrayXd s = variance_[c].array() * (1.0 - 2.0 * leverage.array()) + in_fit;
    const Eigen::ArrayXd factor =
        (leverage.array() < full_leverage).select((1.0 - leverage.array()).inverse().square(), 0.0);
    weight_.emplace_back(own * j_.root().transpose());
    const Eigen::ArrayXXd a = block.jacobian * weight_.back();
    const Eigen::ArrayXXd b =
        a.colwise() * variance_[c].array() - (block.jacobian * (own * meat_ * j_.root().transpose())).array();
    const Eigen::ArrayXXd x = a.square().colwise() * factor;
    const Eigen::ArrayXXd parts = x.colwise() * s;
    mean_ += parts.colwise().sum().matrix().transpose();
    squares_ += parts.square().colwise().sum().matrix().transpose();
    const Eigen::MatrixXd& y = y_.emplace_back(x * b);
    with_z_ += (y.array() * b).colwise().sum().matrix().transpose();
    factor_.push_back(factor);
    part_.emplace_back(factor * s);
  }

  // yᵀSy as |Ω^½ (1 - H) y|², and bᵀy.
  void add_common() {
    common_ = with_z_;
    Eigen::MatrixXd projected = Eigen::MatrixXd::Zero(j_.size(), j_.size());
    for (std::size_t c = 0; c < y_.size(); ++c)
      projected += j_.own_root(c).transpose() * (j_.blocks()[c].jacobian.transpose() * y_[c]);
    for (std::size_t c = 0; c < y_.size(); ++c) {
      const Eigen::MatrixXd left = y_[c] - j_.blocks()[c].jacobian * (j_.own_root(c) * projected);
      in_c_ += (left.array().square().colwise() * variance_[c].array()).colwise().sum().matrix().transpose();
    }
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

  // The part of Σ x_i x_j S_ij² with i other than j.
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
  Eigen::VectorXd truth_, mean_, squares_, with_z_, in_c_, common_;  ///< V, Σ x S, Σ x² S², Σ x b², yᵀSy, bᵀy
  std::vector<Eigen::ArrayXd> factor_, part_;                        ///< [channel]
  std::vector<Eigen::MatrixXd> weight_, y_;                          ///< [channel]: rows of (JᵀJ)⁻¹; y
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
  const Studentised studentised(j, leverages, variance);
  for (Eigen::Index p = 0; p < j.size(); ++p) out.k.push_back(studentised.factors(p));
  return out;
}

}  // namespace goniofit
