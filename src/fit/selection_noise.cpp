#include "fit/selection_noise.h"

#include <algorithm>

#include "fit/noise_model.h"

namespace goniofit {

namespace {

Eigen::VectorXd variance_of(const Noise& noise, const Eigen::VectorXd& f) {
  return (noise.additive * noise.additive + (noise.relative * f.array()).square()).matrix();
}

double deviance_of(const Prediction& p, const Eigen::VectorXd& variance) {
  return (p.residual.array().square() / variance.array() + variance.array().log()).sum();
}

// Stated uncertainties are taken at their word where the residuals are no larger. Where they are, what lies between is
// misfit, which shall not count for evidence either: the Birge ratio, of the residuals' median.
NoiseModel stated_noise_of(Candidate& candidate, const Eigen::VectorXd& variance) {
  NoiseModel own;
  own.variance = variance;
  for (int round = 0;; ++round) {
    fit_weighted(candidate, own.variance);
    const Prediction p = predict(candidate);
    own.u_scale = std::max(1.0, robust_spread(p.residual.cwiseQuotient(variance.cwiseSqrt())));
    own.variance = own.u_scale * own.u_scale * variance;
    own.deviance = deviance_of(p, own.variance);
    if (round == 1 || own.u_scale == 1.0) return own;
  }
}

}  // namespace

// A fit by the bright readings alone leaves the dim ones with more than their noise, hence the rounds.
NoiseModel noise_of(Candidate& candidate) {
  if (const Eigen::VectorXd stated = stated_variance(*candidate.problem); stated.size() > 0) {
    return stated_noise_of(candidate, stated);
  }
  NoiseModel own;
  for (int round = 0;; ++round) {
    const Prediction p = predict(candidate);
    own.noise = estimate_noise(p.f, p.residual);
    own.variance = variance_of(*own.noise, p.f);
    own.deviance = deviance_of(p, own.variance);
    if (round == 2) return own;
    fit_weighted(candidate, own.variance);
  }
}

Eigen::VectorXd variance_at(const Candidate& candidate, const std::optional<Noise>& noise, double u_scale) {
  if (noise) return variance_of(*noise, predict(candidate).f);
  return u_scale * u_scale * stated_variance(*candidate.problem);
}

}  // namespace goniofit
