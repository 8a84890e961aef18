#include "fit/reading_noise.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "fit/dot.h"
#include "fit/noise_sums.h"

namespace goniofit {

namespace {

// A variance's share in what the parameters are uncertain by: below this part of the mean, weighted by leverages, it
// has none to speak of, and whether a residual there is as small as it should be does not matter.
constexpr double negligible = 1e-4;

// See NoiseReadings.
struct Sample {
  Eigen::ArrayXd first, second, square;
  Eigen::ArrayXd own_leverage, leverage;  ///< the second of all readings that this one stands for

  [[nodiscard]] Eigen::ArrayXd variance(const Noise& n) const {
    return n.additive * n.additive * first + n.relative * n.relative * second;
  }
  [[nodiscard]] NoiseReadings readings() const noexcept {
    return {first.data(), second.data(), square.data(), leverage.data(), static_cast<std::size_t>(first.size())};
  }
};
using Samples = std::span<const Sample>;

// `negligible` of the mean variance; what that is made of does not depend on the noise supposed.
class NegligibleVariance {
 public:
  explicit NegligibleVariance(Samples samples) {
    for (const Sample& s : samples) {
      const auto n = static_cast<std::size_t>(s.leverage.size());
      leverage_ += s.leverage.sum();
      first_ += dot(s.leverage.data(), s.first.data(), n);
      second_ += dot(s.leverage.data(), s.second.data(), n);
      square_ += dot(s.leverage.data(), s.square.data(), n);
    }
  }
  [[nodiscard]] double of(const SupposedNoise& noise) const noexcept {
    if (!(leverage_ > 0.0)) return 0.0;
    const double sum = noise.by_squares ? square_ : noise.additive2 * first_ + noise.relative2 * second_;
    return negligible * sum / leverage_;
  }

 private:
  double leverage_ = 0.0, first_ = 0.0, second_ = 0.0, square_ = 0.0;
};

// Least squares of the squares, each by its leverage over its variance squared: the readings that decide the parameters
// decide the noise, so that what misfit the loss leaves in dark readings is no noise of bright ones.
Noise noise_of(Samples samples) {
  const NegligibleVariance negligible_variance(samples);
  SupposedNoise supposed{.by_squares = true};
  for (int round = 0; round < 30; ++round) {
    supposed.floor = negligible_variance.of(supposed);
    NoiseEquations e;
    for (const Sample& s : samples) e += noise_equations(s.readings(), supposed);
    const double determinant = e.ff * e.ss - e.fs * e.fs;
    const bool both = determinant > 1e-12 * e.ff * e.ss;
    double a2 = both ? (e.fy * e.ss - e.sy * e.fs) / determinant : 0.0;
    double r2 = both ? (e.sy * e.ff - e.fy * e.fs) / determinant : 0.0;
    if (!(a2 > 0.0) || !(r2 > 0.0)) {
      const bool relative = r2 > a2 || e.ff <= 0.0;
      a2 = relative || e.ff <= 0.0 ? 0.0 : e.fy / e.ff;
      r2 = relative && e.ss > 0.0 ? e.sy / e.ss : 0.0;
    }
    constexpr double settled = 1e-3;  // far below what so many readings leave open
    const bool done =
        std::fabs(a2 - supposed.additive2) <= settled * a2 && std::fabs(r2 - supposed.relative2) <= settled * r2;
    supposed = {a2, r2};
    if (done) break;
  }
  return {std::sqrt(supposed.relative2), std::sqrt(supposed.additive2)};
}

// What the variances of residuals are made of.
Sample sample_of(const Eigen::VectorXd& by_value, const Eigen::VectorXd& value, const Eigen::VectorXd& residual) {
  Sample s;
  s.first = by_value.array().square();
  const Eigen::ArrayXd off = (by_value.array() != 0.0).select(residual.array() / by_value.array(), 0.0);
  s.second = s.first * (value.array() - off).square();
  return s;
}

// What the residuals' squares are to be divided by so that their mean is the noise's variance, by the noise supposed: a
// fit takes up its readings' noise,
//
//   E r_i² = v_i (1 - 2 h_i) + J_i V J_iᵀ,   V the parameters' covariance.
//
// Where little is left, as of a reading that alone decides a parameter, the residual tells no noise.
void set_squares(const JointJacobian& j, const std::vector<Eigen::VectorXd>& residuals,
                 const std::vector<Eigen::VectorXd>& variance, const Eigen::ArrayXd& count,
                 std::vector<Sample>& samples) {
  constexpr double least_left = 0.1;
  const Eigen::LDLT<Eigen::MatrixXd> meat(j.rough_meat(times_counts(variance, count)));
  const Eigen::MatrixXd factor = meat.matrixL();
  const Eigen::MatrixXd root =
      j.root() * (meat.transpositionsP().transpose() * factor) * meat.vectorD().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  for (std::size_t c = 0; c < samples.size(); ++c) {
    const Eigen::VectorXd taken = j.variances_by(c, root);
    Sample& s = samples[c];
    set_squares_left({residuals[c].data(), variance[c].data(), taken.data(), static_cast<std::size_t>(taken.size())},
                     least_left, s.own_leverage.data(), s.square.data());
    s.leverage = count.size() > 0 ? (s.own_leverage * count).eval() : s.own_leverage;
  }
}

struct Agreement {
  double mean = 1.0, sd = 0.0;  ///< of the squares over their variances, by what both matter

  [[nodiscard]] bool holds(double deviations, double tolerance) const {
    return std::fabs(mean - 1.0) <= deviations * sd + tolerance;
  }
};

Agreement agreement(const Sample& s, const Noise& noise) {
  SupposedNoise supposed{noise.additive * noise.additive, noise.relative * noise.relative};
  supposed.floor = NegligibleVariance({&s, 1}).of(supposed);
  const AgreementSums sums = agreement_sums(s.readings(), supposed);
  if (!(sums.expected > 0.0)) return {};
  return {sums.found / sums.expected, std::sqrt(2.0 * sums.squares) / sums.expected};
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
                             const std::vector<Eigen::VectorXd>& residuals, const JointJacobian& j,
                             const Eigen::ArrayXd& count) {
  std::vector<Sample> samples;
  std::vector<Eigen::VectorXd> variance;
  for (std::size_t c = 0; c < residuals.size(); ++c) {
    Sample& s =
        samples.emplace_back(sample_of(residual_by_value(problem, l, c), problem.channels[c].value, residuals[c]));
    s.own_leverage = (s.first > 0.0).select(j.leverages(c).array(), 0.0);
    s.square.resize(s.first.size());
    variance.emplace_back(residuals[c].cwiseAbs2());
  }
  ResidualNoise out;
  constexpr int rounds = 3;  // the first supposes the residuals' own squares
  for (int round = 0; round < rounds; ++round) {
    set_squares(j, residuals, variance, count, samples);
    const Noise common = noise_of(samples);
    out.holds = true;
    out.noise.clear();
    for (std::size_t c = 0; c < samples.size(); ++c) {
      const Noise noise = agreement(samples[c], common).holds(2.5, 0.05) ? common : noise_of({&samples[c], 1});
      variance[c] = samples[c].variance(noise);
      out.holds = out.holds && agreement(samples[c], noise).holds(4.0, 0.1);
      out.noise.push_back(noise);
    }
  }
  double leverage = 0.0;
  double leverage2 = 0.0;
  for (const Sample& own : samples) {
    leverage += own.leverage.sum();
    leverage2 += own.leverage.square().sum();
  }
  out.freedom = leverage2 > 0.0 ? leverage * leverage / leverage2 : 1.0;
  return out;
}

Eigen::VectorXd variance_by(const Noise& noise, const Problem& problem, const Linearisation& l,
                            const Eigen::VectorXd& residuals, std::size_t channel) {
  return sample_of(residual_by_value(problem, l, channel), problem.channels[channel].value, residuals).variance(noise);
}

}  // namespace goniofit
