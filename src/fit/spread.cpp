#include "fit/spread.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace goniofit {

namespace {

// A reading that alone determines a parameter has no residual to speak of, and the parameter no uncertainty to state.
constexpr double full_leverage = 1.0 - 1e-9;

}  // namespace

Spread spread_by_meat(const JointJacobian& j, const Meat& meat) {
  const auto size = static_cast<std::size_t>(j.size());
  return {j.root() * meat.of(j) * j.root().transpose(), std::vector<CoverageFactors>(size),
          std::vector<bool>(size, false)};
}

Spread spread_by_noise(const JointJacobian& j, const Meat& meat, double freedom) {
  Spread out = spread_by_meat(j, meat);
  const boost::math::students_t student(std::max(1.0, freedom));
  const CoverageFactors k{boost::math::quantile(student, 0.841344746068543), boost::math::quantile(student, 0.975)};
  out.k.assign(out.k.size(), k);
  return out;
}

LeftOut left_out_residuals(const JointJacobian& j, const std::vector<Eigen::VectorXd>& residuals) {
  LeftOut out{{}, std::vector<bool>(static_cast<std::size_t>(j.size()), false)};
  for (std::size_t c = 0; c < residuals.size(); ++c) {
    const JacobianBlock& b = j.blocks()[c];
    const Eigen::VectorXd leverage = j.leverages(c);
    Eigen::VectorXd& own_e = out.e.emplace_back(leverage.size());
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
  return out;
}

}  // namespace goniofit
