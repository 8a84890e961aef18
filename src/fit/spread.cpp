#include "fit/spread.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "fit/studentised.h"

namespace goniofit {

namespace {

// A reading that alone determines a parameter has no residual to speak of, and the parameter no uncertainty to state.
constexpr double full_leverage = 1.0 - 1e-9;

}  // namespace

Spread spread_by_readings(const JointJacobian& j, const std::vector<Eigen::VectorXd>& sd) {
  const auto size = static_cast<std::size_t>(j.size());
  return {j.root() * j.meat(sd) * j.root().transpose(), std::vector<CoverageFactors>(size),
          std::vector<bool>(size, false)};
}

Spread spread_by_residuals(const JointJacobian& j, const std::vector<Eigen::VectorXd>& residuals,
                           const std::vector<Eigen::VectorXd>& variance, const std::vector<Eigen::Index>& parameters) {
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
      for (Eigen::Index p = 0; decides && p < b.cols(); ++p) {
        const Eigen::Index place = b.index()[static_cast<std::size_t>(p)];
        if (b.column(p)[i] * b.column(p)[i] * j.root().row(place).squaredNorm() > 0.25)
          out.single[static_cast<std::size_t>(place)] = true;
      }
    }
  }
  out.covariance = j.root() * j.meat(e) * j.root().transpose();
  const Studentised studentised(j, leverages, variance, parameters);
  out.k.resize(static_cast<std::size_t>(j.size()));
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const Studentised::Factors k = studentised.factors(i);
    out.k[static_cast<std::size_t>(parameters[i])] = {k.at_68, k.at_95};
  }
  return out;
}

Spread spread_by_noise(const JointJacobian& j, const std::vector<Eigen::VectorXd>& variance, double freedom) {
  std::vector<Eigen::VectorXd> sd;
  for (const Eigen::VectorXd& v : variance) sd.emplace_back(v.cwiseSqrt());
  Spread out = spread_by_readings(j, sd);
  const boost::math::students_t student(std::max(1.0, freedom));
  const CoverageFactors k{boost::math::quantile(student, 0.841344746068543), boost::math::quantile(student, 0.975)};
  out.k.assign(out.k.size(), k);
  return out;
}

}  // namespace goniofit
