#pragma once
// The spread of a linearised problem's parameters, by whatever the problem's settings ask: sums over its rows, all at
// once or part by part. Private to uncertainty.

#include <Eigen/Core>
#include <vector>

#include "joint_jacobian.h"
#include "linear_parts.h"
#include "settings.h"
#include "spread.h"

namespace goniofit {

/// A linearised problem over the parameters that have a place in `j`, these moved by a step; an empty one is none.
struct Linear {
  const LinearParts& parts;
  const JointJacobian& j;
  Eigen::VectorXd step{};
};

/// Intervals only of the parameters asked for; `source` becomes what it is by.
[[nodiscard]] Spread stated_spread(const Linear& linear, const std::vector<Eigen::Index>& parameters,
                                   UncertaintySource& source);
/// By the readings' own uncertainties, whatever is asked for.
[[nodiscard]] Spread spread_by_stated_u(const Linear& linear);
/// g of uncertainty.h: what a relative change of the instrument's scale does; 0 where its uncertainty is.
[[nodiscard]] Eigen::VectorXd change_by_scale(const Linear& linear);

}  // namespace goniofit
