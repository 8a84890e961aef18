#include "fit/reading_noise.h"

#include <algorithm>

#include "fit/noise_model.h"

namespace goniofit {

Eigen::VectorXd residual_by_value(const Problem& problem, const Linearisation& l, std::size_t channel) {
  Eigen::VectorXd out = -l.slopes[channel];
  if (!is_transformed(problem.loss)) return out;
  const Eigen::VectorXd& values = problem.channels[channel].value;
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    const double f = values[i] + l.deviations[channel][i];
    out[i] *= transformed(problem.loss, values[i]).slope / transformed(problem.loss, f).slope;
  }
  return out;
}

Eigen::VectorXd reading_sd(const Problem& problem, const Linearisation& l, std::size_t channel) {
  return residual_by_value(problem, l, channel).cwiseAbs().cwiseProduct(problem.channels[channel].u);
}

Eigen::VectorXd residual_by_scale(const Problem& problem, const Linearisation& l, std::size_t channel) {
  Eigen::VectorXd out = residual_by_value(problem, l, channel).cwiseProduct(problem.channels[channel].value);
  out.tail(out.size() - static_cast<Eigen::Index>(problem.readings())).setZero();
  return out;
}

bool states_uncertainties(const Problem& problem) noexcept {
  return std::all_of(problem.channels.begin(), problem.channels.end(),
                     [](const ProblemChannel& c) { return c.u.size() > 0; });
}

Eigen::VectorXd estimated_variance(const Problem& problem, const Linearisation& l, std::size_t channel,
                                   const Eigen::VectorXd& residuals) {
  const Eigen::VectorXd by_reading = residual_by_value(problem, l, channel);
  // Of many readings a part tells the noise as well.
  constexpr Eigen::Index enough = 600;
  const Eigen::Index step = std::max<Eigen::Index>(1, residuals.size() / enough);
  Eigen::VectorXd model(residuals.size());
  for (Eigen::Index i = 0; i < model.size(); ++i) {
    const double off = by_reading[i] != 0.0 ? residuals[i] / by_reading[i] : 0.0;
    model[i] = problem.channels[channel].value[i] - off;
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
