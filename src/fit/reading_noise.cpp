#include "fit/reading_noise.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "fit/noise_model.h"
#include "fit/residual_tests.h"

namespace goniofit {

namespace {

// -2 ln of the likelihood of normal residuals.
double misfit(const Noise& noise, const Eigen::VectorXd& f, const Eigen::VectorXd& residual) {
  const Eigen::ArrayXd variance =
      noise.relative * noise.relative * f.array().square() + noise.additive * noise.additive;
  return (variance.log() + residual.array().square() / variance).sum();
}

// Readings of a channel, or of all.
struct Sample {
  Eigen::VectorXd f, residual;
};

Noise additive_noise(const Sample& s) {
  std::vector<double> sizes(s.residual.data(), s.residual.data() + s.residual.size());
  for (double& size : sizes) size = std::fabs(size);
  constexpr double sigma_of_median = 1.4826022185056018;
  return {0.0, sizes.empty() ? 0.0 : sigma_of_median * median_of(sizes)};
}

// The noise that explains the residuals best by BIC: that of all channels together, which costs this one nothing;
// additive noise alone; both parts. Dark readings let the few bright ones of their channel have much relative noise
// that there need not be.
Noise simplest_noise(const Sample& own, const std::optional<Noise>& common) {
  const double price = std::log(static_cast<double>(own.f.size()));
  Noise best = estimate_noise(own.f, own.residual);
  double least = misfit(best, own.f, own.residual) + 2.0 * price;
  const auto consider = [&](const Noise& noise, double parameters) {
    if (!(noise.additive > 0.0)) return;
    const double value = misfit(noise, own.f, own.residual) + parameters * price;
    if (!(value <= least)) return;
    least = value;
    best = noise;
  };
  consider(additive_noise(own), 1.0);
  if (common) consider(*common, 0.0);
  return best;
}

Sample joined(const std::vector<Sample>& samples) {
  Eigen::Index size = 0;
  for (const Sample& s : samples) size += s.f.size();
  Sample all{Eigen::VectorXd(size), Eigen::VectorXd(size)};
  size = 0;
  for (const Sample& s : samples) {
    all.f.segment(size, s.f.size()) = s.f;
    all.residual.segment(size, s.f.size()) = s.residual;
    size += s.f.size();
  }
  return all;
}

}  // namespace

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

std::vector<Eigen::VectorXd> estimated_variances(const Problem& problem, const Linearisation& l,
                                                 const std::vector<Eigen::VectorXd>& residuals) {
  constexpr Eigen::Index enough = 1500;  // of many readings a part tells the noise as well
  std::vector<Eigen::VectorXd> by_reading;
  std::vector<Eigen::VectorXd> model;
  std::vector<Sample> samples;
  for (std::size_t c = 0; c < residuals.size(); ++c) {
    const Eigen::VectorXd& by = by_reading.emplace_back(residual_by_value(problem, l, c));
    const Eigen::VectorXd& value = problem.channels[c].value;
    const Eigen::VectorXd off = (by.array() != 0.0).select(residuals[c].cwiseQuotient(by), 0.0);
    model.emplace_back(value - off);
    std::vector<Eigen::Index> kept;
    for (Eigen::Index i = 0; i < by.size(); i += std::max<Eigen::Index>(1, by.size() / enough)) {
      if (by[i] != 0.0) kept.push_back(i);
    }
    samples.push_back({model.back()(kept), off(kept)});
  }
  std::optional<Noise> common;
  if (samples.size() > 1) common = simplest_noise(joined(samples), std::nullopt);
  std::vector<Eigen::VectorXd> out;
  for (std::size_t c = 0; c < residuals.size(); ++c) {
    const Noise noise = simplest_noise(samples[c], common);
    out.emplace_back(by_reading[c].array().square() *
                     (noise.relative * noise.relative * model[c].array().square() + noise.additive * noise.additive));
  }
  return out;
}

}  // namespace goniofit
