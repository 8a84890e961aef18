#include "fit/linear_spread.h"

#include <utility>

#include "fit/cross_validation.h"
#include "fit/reading_noise.h"
#include "fit/studentised.h"

namespace goniofit {

namespace {

template <class F>
std::vector<Eigen::VectorXd> by_channel(const Problem& problem, const F& f) {
  std::vector<Eigen::VectorXd> out;
  for (std::size_t c = 0; c < problem.channels.size(); ++c) out.emplace_back(f(c));
  return out;
}

// All of a linearised problem's rows, a part of them, or those drawn.
struct Rows {
  const Problem& problem;
  const Linearisation& l;
  const JointJacobian& j;
  const std::vector<Eigen::VectorXd>& residuals;  // after the step
};

// Calls f(Rows).
template <class F>
void with_rows(const Linear& linear, const Problem& problem, const Linearisation& l, const F& f) {
  const JointJacobian own = linear.j.with_rows(l);
  if (linear.step.size() == 0) return f(Rows{problem, l, own, l.residuals});
  std::vector<Eigen::VectorXd> residuals = l.residuals;
  for (std::size_t c = 0; c < residuals.size(); ++c)
    residuals[c] += own.blocks()[c].times(linear.step(own.blocks()[c].index()));
  f(Rows{problem, l, own, residuals});
}

template <class F>
void for_each(const Linear& linear, const F& f) {
  linear.parts.for_each([&](const Problem& part, const Linearisation& l) { with_rows(linear, part, l, f); });
}

// Calls f(Rows, how many readings each stands for).
template <class F>
void visit_drawn(const Linear& linear, const F& f) {
  linear.parts.visit_drawn([&](const Problem& part, const Linearisation& l, const std::vector<double>& factor) {
    const Eigen::ArrayXd counts =
        Eigen::Map<const Eigen::ArrayXd>(factor.data(), static_cast<Eigen::Index>(factor.size())).square();
    with_rows(linear, part, l, [&](const Rows& rows) { f(rows, counts); });
  });
}

// The Meat of e(Rows, channel).
template <class E>
Meat meat_of(const Linear& linear, const E& e) {
  Meat out(linear.parts.problem().channels.size());
  for_each(linear, [&](const Rows& rows) {
    out.add(rows.j, by_channel(rows.problem, [&](std::size_t c) { return e(rows, c); }));
  });
  return out;
}

// A robust kernel's reweighting overstates what the readings say by the share of the kernel's curvature.
Spread without_reweighting(Spread spread, double kernel_share) {
  spread.covariance /= kernel_share * kernel_share;
  return spread;
}

Spread spread_of_readings(const Linear& linear) {
  const Meat meat =
      meat_of(linear, [](const Rows& rows, std::size_t c) { return reading_sd(rows.problem, rows.l, c); });
  return spread_by_meat(linear.j, meat);
}

Spread spread_of_angles(const Linear& linear) {
  Spread out;
  for_each(linear,
           [&](const Rows& rows) { out = spread_by_angles(rows.j, rows.residuals, angle_groups(rows.problem)); });
  return out;
}

Eigen::VectorXd variance_of(const Rows& rows, const ResidualNoise& noise, std::size_t c) {
  return variance_by(noise.noise[c], rows.problem, rows.l, rows.residuals[c], c);
}

Spread noise_spread(const Linear& linear, const ResidualNoise& noise) {
  const Meat meat =
      meat_of(linear, [&](const Rows& rows, std::size_t c) { return variance_of(rows, noise, c).cwiseSqrt().eval(); });
  return spread_by_noise(linear.j, meat, noise.freedom);
}

void add_factors(const Linear& linear, const ResidualNoise& noise, const std::vector<Eigen::Index>& parameters,
                 Spread& out) {
  visit_drawn(linear, [&](const Rows& rows, const Eigen::ArrayXd& counts) {
    const std::vector<Eigen::VectorXd> variance =
        by_channel(rows.problem, [&](std::size_t c) { return variance_of(rows, noise, c); });
    const Studentised studentised(rows.j, variance, counts, parameters);
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      const Studentised::Factors k = studentised.factors(i);
      out.k[static_cast<std::size_t>(parameters[i])] = {k.at_68, k.at_95};
    }
  });
}

Spread hc3_spread(const Linear& linear, const ResidualNoise& noise, const std::vector<Eigen::Index>& parameters) {
  std::vector<bool> single(static_cast<std::size_t>(linear.j.size()), false);
  Meat meat(linear.parts.problem().channels.size());
  for_each(linear, [&](const Rows& rows) {
    const LeftOut out = left_out_residuals(rows.j, rows.residuals);
    meat.add(rows.j, out.e);
    for (std::size_t i = 0; i < single.size(); ++i) single[i] = single[i] || out.single[i];
  });
  Spread out = spread_by_meat(linear.j, meat);
  out.single = std::move(single);
  add_factors(linear, noise, parameters, out);
  return out;
}

Spread spread_of(const Linear& linear, const std::vector<Eigen::Index>& parameters, UncertaintySource& source) {
  const UncertaintySource asked = linear.parts.problem().uncertainty;
  if (asked == UncertaintySource::readings) return spread_of_readings(linear);
  if (asked == UncertaintySource::angles) return spread_of_angles(linear);
  ResidualNoise noise;
  visit_drawn(linear, [&](const Rows& rows, const Eigen::ArrayXd& counts) {
    noise = residual_noise(rows.problem, rows.l, rows.residuals, rows.j, counts);
  });
  if (asked == UncertaintySource::residuals && noise.holds) return noise_spread(linear, noise);
  source = UncertaintySource::hc3;
  return hc3_spread(linear, noise, parameters);
}

}  // namespace

Spread stated_spread(const Linear& linear, const std::vector<Eigen::Index>& parameters, UncertaintySource& source) {
  return without_reweighting(spread_of(linear, parameters, source), linear.parts.kernel_share());
}

Spread spread_by_stated_u(const Linear& linear) {
  return without_reweighting(spread_of_readings(linear), linear.parts.kernel_share());
}

Eigen::VectorXd change_by_scale(const Linear& linear) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(linear.j.size());
  if (linear.parts.problem().scale_u == 0.0) return sum;
  for_each(linear, [&](const Rows& rows) {
    sum += rows.j.transposed_times(
        by_channel(rows.problem, [&](std::size_t c) { return residual_by_scale(rows.problem, rows.l, c); }));
  });
  return -linear.j.solve(sum);
}

}  // namespace goniofit
