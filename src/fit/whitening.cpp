#include "fit/whitening.h"

#include <algorithm>
#include <cmath>

#include "fit/noise_model.h"
#include "fit/residual_tests.h"

namespace goniofit {

namespace {

constexpr Eigen::Index most_readings = 1000;
// Standard deviation of a normal distribution over the median of its absolute value.
constexpr double sigma_of_median = 1.4826022185056018;

Eigen::VectorXd thinned(const Eigen::VectorXd& all) {
  const Eigen::Index step = (all.size() + most_readings - 1) / most_readings;
  if (step <= 1) return all;
  Eigen::VectorXd some((all.size() + step - 1) / step);
  for (Eigen::Index i = 0; i < some.size(); ++i) some[i] = all[i * step];
  return some;
}

double birge_ratio(const Eigen::VectorXd& residual, const Eigen::VectorXd& u) {
  std::vector<double> sizes;
  for (Eigen::Index i = 0; i < u.size(); ++i) {
    if (u[i] > 0.0) sizes.push_back(std::fabs(residual[i]) / u[i]);
  }
  return sizes.empty() ? 1.0 : std::max(1.0, sigma_of_median * median_of(sizes));
}

}  // namespace

ReadingNoise reading_noise(const Problem& problem, const Linearisation& l) {
  ReadingNoise out;
  for (std::size_t c = 0; c < problem.channels.size(); ++c) {
    const ProblemChannel& channel = problem.channels[c];
    const Eigen::VectorXd& residual = l.deviations[c];
    const Eigen::VectorXd f = residual + channel.value;
    const bool stated = channel.u.size() > 0 && channel.u.minCoeff() > 0.0;
    // Where uncertainties are stated the model is theirs, as if they were residuals of that size.
    Noise noise = estimate_noise(thinned(f), thinned(stated ? Eigen::VectorXd(channel.u / sigma_of_median) : residual));
    if (!std::isfinite(noise.relative)) noise.relative = 0.0;  // of nothing but zeros
    // A dark channel has no noise to speak of; its square still has to be a number.
    const double least = std::max(1e-30, 1e-9 * std::sqrt(problem.total / static_cast<double>(problem.samples())));
    Eigen::VectorXd sd = f.unaryExpr([noise](double value) { return noise.sd(value); });
    if (stated) sd = birge_ratio(thinned(residual), thinned(channel.u)) * channel.u;
    for (double& value : sd) value = value > least ? value : least;
    const Eigen::VectorXd scaled = l.slopes[c].cwiseProduct(sd);
    out.whitener.push_back((scaled.array() > 0.0).select(scaled.cwiseInverse(), 0.0));
    out.model.push_back(noise);
    out.sd.push_back(std::move(sd));
  }
  return out;
}

Eigen::MatrixXd whitened_columns(const Linearisation& l, const ReadingNoise& noise, std::size_t channel) {
  const Eigen::MatrixXd& shape = l.by_shape[channel];
  const Eigen::MatrixXd& coefficients = l.by_coefficient[channel];
  const Eigen::VectorXd& optics = l.by_optics[channel];
  Eigen::MatrixXd all(shape.rows(), shape.cols() + coefficients.cols() + (optics.size() > 0 ? 1 : 0));
  all.leftCols(shape.cols()) = shape;
  all.middleCols(shape.cols(), coefficients.cols()) = coefficients;
  if (optics.size() > 0) all.rightCols(1) = optics;
  return noise.whitener[channel].asDiagonal() * all;
}

}  // namespace goniofit
