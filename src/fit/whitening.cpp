#include "fit/whitening.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fit/noise_model.h"
#include "fit/residual_tests.h"

namespace goniofit {

namespace {

constexpr Eigen::Index most_readings = 1000;
// Standard deviation of a normal distribution over the median of its absolute value.
constexpr double sigma_of_median = 1.4826022185056018;

Eigen::Index step_of(Eigen::Index size) { return (size + most_readings - 1) / most_readings; }

Eigen::VectorXd thinned(const Eigen::VectorXd& all) {
  const Eigen::Index step = step_of(all.size());
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

std::vector<std::size_t> rows_that_tell_noise(const Problem& problem) {
  std::vector<std::size_t> rows;
  const auto step = static_cast<std::size_t>(step_of(static_cast<Eigen::Index>(problem.readings())));
  for (std::size_t i = 0; i < problem.readings(); i += step) rows.push_back(i);
  return rows;
}

NoiseModel noise_model(const Problem& problem, const Problem& some, const Linearisation& l) {
  NoiseModel out;
  // A dark channel has no noise to speak of; its square still has to be a number.
  out.least = std::max(1e-30, 1e-9 * std::sqrt(problem.total / static_cast<double>(problem.samples())));
  for (std::size_t c = 0; c < problem.channels.size(); ++c) {
    const ProblemChannel& channel = some.channels[c];
    const Eigen::VectorXd residual = thinned(l.deviations[c]);
    const Eigen::VectorXd f = residual + thinned(channel.value);
    const Eigen::VectorXd& all_u = problem.channels[c].u;
    const bool stated = all_u.size() > 0 && all_u.minCoeff() > 0.0;
    const Eigen::VectorXd u = stated ? thinned(channel.u) : Eigen::VectorXd();
    // Where uncertainties are stated the model is theirs, as if they were residuals of that size.
    Noise noise = estimate_noise(f, stated ? Eigen::VectorXd(u / sigma_of_median) : residual);
    if (!std::isfinite(noise.relative)) noise.relative = 0.0;  // of nothing but zeros
    out.model.push_back(noise);
    out.birge_ratio.push_back(stated ? birge_ratio(residual, u) : 0.0);
  }
  return out;
}

RowNoise noise_of_rows(const Problem& part, const Linearisation& l, const NoiseModel& noise, std::size_t c) {
  const ProblemChannel& channel = part.channels[c];
  RowNoise out;
  if (noise.birge_ratio[c] > 0.0) {
    out.sd = noise.birge_ratio[c] * channel.u;
  } else {
    out.sd = (l.deviations[c] + channel.value).unaryExpr([&](double f) { return noise.model[c].sd(f); });
  }
  for (double& value : out.sd) value = value > noise.least ? value : noise.least;
  const Eigen::VectorXd scaled = l.slopes[c].cwiseProduct(out.sd);
  out.whitener = (scaled.array() > 0.0).select(scaled.cwiseInverse(), 0.0);
  return out;
}

ReadingNoise reading_noise(const Problem& problem, const Linearisation& l) {
  ReadingNoise out;
  static_cast<NoiseModel&>(out) = noise_model(problem, problem, l);
  for (std::size_t c = 0; c < problem.channels.size(); ++c) {
    RowNoise rows = noise_of_rows(problem, l, out, c);
    out.sd.push_back(std::move(rows.sd));
    out.whitener.push_back(std::move(rows.whitener));
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
