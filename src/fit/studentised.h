#pragma once
// How far estimates lie from the truth in units of their own HC3 uncertainty.
//
// Of one parameter let a = J (JᵀJ)⁻¹'s column, so that the estimate is off by z √V = aᵀε, and HC3's variance is
//
//   V̂ = Σ x_i r_i²,  x_i = a_i² / (1 - h_i)²,  r = (1 - H) ε.
//
// The readings that decide the estimate decide V̂ too: where they are few neither the normal distribution nor Student's
// t, which has the two independent, says how large z² V / V̂ is. For normal noise of known variances ω all of it is
// jointly normal,
//
//   Cov(r_i, r_j) = δ_ij ω_i - H_ij (ω_i + ω_j) + U_i K U_jᵀ,  Cov(r_i, aᵀε) = ω_i a_i - U_i K Bᵀ_p,
//   U = J B,  K = Uᵀ Ω U,
//
// so z² <= k² V̂ / V asks for the sign of a quadratic form, whose distribution its saddlepoint gives to about a percent
// of the probability left (Lugannani & Rice 1980; Kuonen 1999). The readings of most account enter one by one, all
// others as one chi-square of their mean and variance.

#include <Eigen/Core>
#include <vector>

#include "joint_jacobian.h"

namespace goniofit {

/// The quadratic form η_0² - κ (ηᵀGη + c), η standard normal and c a chi-square over its degrees of freedom, times
/// `rest`.
class SignedForm {
 public:
  /// G positive semidefinite.
  SignedForm(const Eigen::MatrixXd& g, double rest, double rest_freedom);
  /// Probability that it is positive, at κ > 0.
  [[nodiscard]] double positive(double kappa) const;
  /// √κ at which that is 1 - probability.
  [[nodiscard]] double factor(double probability) const;

 private:
  struct Cumulants {
    double value, first, second;
    bool inside;
  };
  [[nodiscard]] Cumulants cumulants(double s, double kappa) const;
  [[nodiscard]] double saddlepoint(double kappa) const;

  Eigen::ArrayXd eigenvalues_, weights_;
  double rest_, rest_freedom_;
};

class Studentised {
 public:
  /// Variances of the noise of the residuals, one vector a channel, of the rows that `j` has; of the parameters asked
  /// for. Each row stands for `count` of them, where there are counts.
  Studentised(const JointJacobian& j, const std::vector<Eigen::VectorXd>& variance, const Eigen::ArrayXd& count,
              const std::vector<Eigen::Index>& parameters);
  /// k at which value ± k u has the probability.
  struct Factors {
    double at_68, at_95;
  };
  /// Of the parameter at that position among them.
  [[nodiscard]] Factors factors(std::size_t position) const;

 private:
  struct Reading {
    std::size_t channel;
    Eigen::Index row;
    double part;  ///< of the mean of V̂
  };
  /// What estimates of one direction a = J `by` in a channel, or of its multiples, draw from the channel's readings.
  struct Direction {
    Eigen::VectorXd by;
    double mean, squares;          ///< Σ x_i S_ii; Σ (x_i S_ii)²
    std::vector<Reading> largest;  ///< x_i S_ii, by row
  };
  /// Of a parameter: the direction, and the square of the multiple.
  struct Share {
    std::size_t direction;
    double square;
  };
  void add(std::size_t channel);
  [[nodiscard]] static Share share_of(const Eigen::VectorXd& by, const std::vector<Direction>& directions);
  [[nodiscard]] Direction direction_of(std::size_t channel, const Eigen::VectorXd& by,
                                       const Eigen::ArrayXd& factor) const;
  [[nodiscard]] std::vector<Reading> of_most_account(Eigen::Index column) const;
  [[nodiscard]] Eigen::MatrixXd form(Eigen::Index column, const std::vector<Reading>& readings) const;

  const JointJacobian& j_;
  const std::vector<Eigen::VectorXd>& variance_;
  const Eigen::ArrayXd& count_;
  const std::vector<Eigen::Index>& parameters_;
  Eigen::MatrixXd meat_;                            ///< K
  Eigen::VectorXd truth_, mean_, squares_;          ///< V; Σ x_i S_ii; Σ (x_i S_ii)²
  std::vector<Eigen::ArrayXd> s_;                   ///< [channel]: S_ii
  std::vector<std::vector<Direction>> directions_;  ///< [channel]
  std::vector<std::vector<Share>> shares_;          ///< [channel][parameter]
};

}  // namespace goniofit
