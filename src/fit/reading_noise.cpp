#include "fit/reading_noise.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace goniofit {

namespace {

// A variance's share in what the parameters are uncertain by: below this part of the mean, weighted by leverages, it
// has none to speak of, and whether a residual there is as small as it should be does not matter.
constexpr double negligible = 1e-4;

// Squares of residuals to be explained by additive² * first + relative² * second, with the readings' leverages.
struct Sample {
  Eigen::ArrayXd first, second, square, leverage;

  void append(const Sample& other) {
    const auto join = [](Eigen::ArrayXd& to, const Eigen::ArrayXd& from) {
      const Eigen::Index before = to.size();
      to.conservativeResize(before + from.size());
      to.tail(from.size()) = from;
    };
    join(first, other.first);
    join(second, other.second);
    join(square, other.square);
    join(leverage, other.leverage);
  }
  [[nodiscard]] Eigen::ArrayXd variance(const Noise& n) const {
    return n.additive * n.additive * first + n.relative * n.relative * second;
  }
};

double negligible_variance(const Eigen::ArrayXd& variance, const Eigen::ArrayXd& leverage) {
  const double sum = leverage.sum();
  return sum > 0.0 ? negligible * (leverage * variance).sum() / sum : 0.0;
}

// Least squares of the squares, each by its leverage over its variance squared: the readings that decide the parameters
// decide the noise, so that what misfit the loss leaves in dark readings is no noise of bright ones.
Noise noise_of(const Sample& s) {
  double a2 = 0.0;
  double r2 = 0.0;
  Eigen::ArrayXd variance = s.square;
  for (int round = 0; round < 30; ++round) {
    const double before_a2 = a2;
    const double before_r2 = r2;
    const double floor = negligible_variance(variance, s.leverage);
    double ff = 0.0, fs = 0.0, ss = 0.0, fy = 0.0, sy = 0.0;
    for (Eigen::Index i = 0; i < variance.size(); ++i) {
      const double error = variance[i] + floor;
      if (!(error > 0.0)) continue;
      const double g = s.leverage[i] / (error * error);
      const double gf = g * s.first[i];
      const double gs = g * s.second[i];
      ff += gf * s.first[i];
      fs += gf * s.second[i];
      ss += gs * s.second[i];
      fy += gf * s.square[i];
      sy += gs * s.square[i];
    }
    const double determinant = ff * ss - fs * fs;
    const bool both = determinant > 1e-12 * ff * ss;
    a2 = both ? (fy * ss - sy * fs) / determinant : 0.0;
    r2 = both ? (sy * ff - fy * fs) / determinant : 0.0;
    if (!(a2 > 0.0) || !(r2 > 0.0)) {
      const bool relative = r2 > a2 || ff <= 0.0;
      a2 = relative || ff <= 0.0 ? 0.0 : fy / ff;
      r2 = relative && ss > 0.0 ? sy / ss : 0.0;
    }
    variance = a2 * s.first + r2 * s.second;
    constexpr double settled = 1e-3;  // far below what so many readings leave open
    if (std::fabs(a2 - before_a2) <= settled * a2 && std::fabs(r2 - before_r2) <= settled * r2) break;
  }
  return {std::sqrt(r2), std::sqrt(a2)};
}

Sample sample_of(const Eigen::VectorXd& by_value, const Eigen::VectorXd& value, const Eigen::VectorXd& residual,
                 const Eigen::VectorXd& leverage) {
  Sample s;
  s.first = by_value.array().square();
  const Eigen::ArrayXd off = (by_value.array() != 0.0).select(residual.array() / by_value.array(), 0.0);
  s.second = s.first * (value.array() - off).square();
  s.leverage = (s.first > 0.0).select(leverage.array(), 0.0);
  return s;
}

// What the residuals' squares are to be divided by so that their mean is the noise's variance, by the noise supposed: a
// fit takes up its readings' noise,
//
//   E r_i² = v_i (1 - 2 h_i) + J_i V J_iᵀ,   V the parameters' covariance.
//
// Where little is left, as of a reading that alone decides a parameter, the residual tells no noise.
void set_squares(const JointJacobian& j, const std::vector<Eigen::VectorXd>& residuals,
                 const std::vector<Eigen::VectorXd>& variance, std::vector<Sample>& samples) {
  constexpr double least_left = 0.1;
  std::vector<Eigen::VectorXd> sd;
  for (const Eigen::VectorXd& v : variance) sd.emplace_back(v.cwiseSqrt());
  const Eigen::MatrixXd covariance = j.root() * j.meat(sd) * j.root().transpose();
  for (std::size_t c = 0; c < samples.size(); ++c) {
    const JacobianBlock& b = j.blocks()[c];
    const Eigen::MatrixXd own = covariance(b.index, b.index);
    const Eigen::ArrayXd taken = (b.jacobian * own).cwiseProduct(b.jacobian).rowwise().sum();
    const Eigen::ArrayXd v = variance[c];
    Sample& s = samples[c];
    const Eigen::ArrayXd left = (v > 0.0).select(1.0 - 2.0 * s.leverage + taken / v, 1.0);
    s.square = residuals[c].array().square() / left.max(least_left);
    s.leverage = (left >= least_left).select(s.leverage, 0.0);
  }
}

struct Agreement {
  double mean = 1.0, sd = 0.0;  ///< of the squares over their variances, by what both matter

  [[nodiscard]] bool holds(double deviations, double tolerance) const {
    return std::fabs(mean - 1.0) <= deviations * sd + tolerance;
  }
};

Agreement agreement(const Sample& s, const Noise& noise) {
  const Eigen::ArrayXd variance = s.variance(noise);
  const Eigen::ArrayXd floored = variance + negligible_variance(variance, s.leverage);
  const Eigen::ArrayXd weight = (floored > 0.0).select(s.leverage / floored, 0.0);
  const double expected = (weight * variance).sum();
  if (!(expected > 0.0)) return {};
  return {(weight * s.square).sum() / expected, std::sqrt(2.0 * (weight * variance).square().sum()) / expected};
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

ResidualNoise residual_noise(const Problem& problem, const Linearisation& l,
                             const std::vector<Eigen::VectorXd>& residuals, const JointJacobian& j) {
  std::vector<Sample> samples;
  ResidualNoise out;
  for (std::size_t c = 0; c < residuals.size(); ++c) {
    samples.push_back(
        sample_of(residual_by_value(problem, l, c), problem.channels[c].value, residuals[c], j.leverages(c)));
    out.variance.emplace_back(residuals[c].cwiseAbs2());
  }
  constexpr int rounds = 3;  // the first supposes the residuals' own squares
  for (int round = 0; round < rounds; ++round) {
    set_squares(j, residuals, out.variance, samples);
    Sample all;
    for (const Sample& own : samples) all.append(own);
    const Noise common = noise_of(all);
    out.holds = true;
    for (std::size_t c = 0; c < samples.size(); ++c) {
      const Noise noise = agreement(samples[c], common).holds(2.5, 0.05) ? common : noise_of(samples[c]);
      out.variance[c] = samples[c].variance(noise);
      out.holds = out.holds && agreement(samples[c], noise).holds(4.0, 0.1);
    }
    const double leverage2 = all.leverage.square().sum();
    out.freedom = leverage2 > 0.0 ? all.leverage.sum() * all.leverage.sum() / leverage2 : 1.0;
  }
  return out;
}

}  // namespace goniofit
