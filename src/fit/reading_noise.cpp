#include "fit/reading_noise.h"

#include <algorithm>

#include "fit/noise_model.h"

namespace goniofit {

Eigen::VectorXd residual_by_reading(const Problem& problem, std::size_t channel) {
  const Eigen::VectorXd& emphasis = problem.channels[channel].emphasis;
  if (emphasis.size() == 0) return -problem.weight;
  return -problem.weight.cwiseProduct(emphasis);
}

Eigen::VectorXd reading_sd(const Problem& problem, std::size_t channel) {
  return residual_by_reading(problem, channel).cwiseAbs().cwiseProduct(problem.channels[channel].u);
}

Eigen::VectorXd residual_by_scale(const Problem& problem, std::size_t channel) {
  const Eigen::VectorXd readings = problem.channels[channel].target.cwiseQuotient(problem.weight);
  return residual_by_reading(problem, channel).cwiseProduct(readings);
}

bool states_uncertainties(const Problem& problem) noexcept {
  return std::all_of(problem.channels.begin(), problem.channels.end(),
                     [](const ProblemChannel& c) { return c.u.size() > 0; });
}

Eigen::VectorXd estimated_variance(const Problem& problem, std::size_t channel, const Eigen::VectorXd& residuals) {
  const Eigen::VectorXd by_reading = residual_by_reading(problem, channel);
  const Eigen::VectorXd& target = problem.channels[channel].target;
  // Of many readings a part tells the noise as well.
  constexpr Eigen::Index enough = 600;
  const Eigen::Index step = std::max<Eigen::Index>(1, residuals.size() / enough);
  Eigen::VectorXd model(residuals.size());
  for (Eigen::Index i = 0; i < model.size(); ++i) {
    const double off = by_reading[i] != 0.0 ? residuals[i] / by_reading[i] : 0.0;
    model[i] = target[i] / problem.weight[i] - off;
  }
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < model.size(); i += step) {
    if (by_reading[i] != 0.0) kept.push_back(i);
  }
  const Eigen::VectorXd off = residuals(kept).cwiseQuotient(by_reading(kept));
  const Noise noise = estimate_noise(model(kept), off);
  return by_reading.array().square() *
         (noise.relative * noise.relative * model.array().square() + noise.additive * noise.additive);
}

}  // namespace goniofit
