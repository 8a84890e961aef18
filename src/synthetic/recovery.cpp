#include "synthetic/recovery.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "geometry/angles.h"

namespace goniofit {
namespace {

constexpr double z_68 = 1.0;
constexpr double z_95 = 1.959963984540054;
/// Standard errors that a single parameter's coverage may lie outside its bounds.
constexpr double allowed_standard_errors = 3.0;

struct Count {
  std::size_t stated = 0, inside_68 = 0, inside_95 = 0;
  [[nodiscard]] double fraction(std::size_t inside) const {
    return stated == 0 ? 0.0 : static_cast<double>(inside) / static_cast<double>(stated);
  }
};

Count count_inside(const ParameterTrials& trials) {
  Count count;
  for (const Estimate& e : trials.estimates) {
    if (!e.u) continue;
    const double distance = std::fabs(e.value - trials.truth);
    ++count.stated;
    if (distance <= z_68 * *e.u) ++count.inside_68;
    if (distance <= z_95 * *e.u) ++count.inside_95;
  }
  return count;
}

std::optional<std::string> missed_coverage(const std::string& what, const Count& count,
                                           std::pair<double, double> bounds, double standard_errors) {
  if (count.stated == 0) return std::nullopt;
  const auto n = static_cast<double>(count.stated);
  const auto allowance = [&](double p) { return standard_errors * std::sqrt(p * (1.0 - p) / n); };
  const double coverage = count.fraction(count.inside_95);
  const auto [low, high] = bounds;
  if (coverage >= low - allowance(low) && coverage <= high + allowance(high)) return std::nullopt;
  return fmt::format("{}: the 95 % intervals contain the truth in {:.1f} % of {} cases, expected {:g} to {:g} %", what,
                     100.0 * coverage, count.stated, 100.0 * low, 100.0 * high);
}

}  // namespace

Recovery recovery_of(const ParameterTrials& trials) {
  Recovery r;
  r.parameter = trials.parameter;
  r.truth = trials.truth;
  const auto n = static_cast<double>(trials.estimates.size());
  for (const Estimate& e : trials.estimates) r.mean += e.value / n;
  r.bias = r.mean - r.truth;
  double squares = 0.0;
  double sum_u = 0.0;
  for (const Estimate& e : trials.estimates) {
    squares += (e.value - r.mean) * (e.value - r.mean);
    sum_u += e.u.value_or(0.0);
  }
  r.spread = trials.estimates.size() > 1 ? std::sqrt(squares / (n - 1.0)) : 0.0;

  const Count count = count_inside(trials);
  r.stated = count.stated;
  r.mean_u = count.stated == 0 ? 0.0 : sum_u / static_cast<double>(count.stated);
  r.coverage_68 = count.fraction(count.inside_68);
  r.coverage_95 = count.fraction(count.inside_95);
  return r;
}

std::vector<std::string> missed_bounds(const std::vector<ParameterTrials>& parameters, const VerifySettings& bounds) {
  std::vector<std::string> missed;
  Count pooled;
  for (const ParameterTrials& p : parameters) {
    if (p.parameter == "slope") {
      const double bias = recovery_of(p).bias / p.truth;
      if (!(std::fabs(bias) <= bounds.slope_bias)) {
        missed.push_back(fmt::format("slope: the mean is {:+.3g} % off the truth, at most {:g} % allowed", 100.0 * bias,
                                     100.0 * bounds.slope_bias));
      }
    }
    if (!bounds.coverage_95 || p.truth_on_bound) continue;
    const Count count = count_inside(p);
    pooled.stated += count.stated;
    pooled.inside_95 += count.inside_95;
    if (auto miss = missed_coverage(p.parameter, count, *bounds.coverage_95, allowed_standard_errors)) {
      missed.push_back(*std::move(miss));
    }
  }
  if (bounds.coverage_95) {
    if (auto miss = missed_coverage("all parameters", pooled, *bounds.coverage_95, 0.0))
      missed.push_back(*std::move(miss));
  }
  return missed;
}

double loss_ratio(const Scan& scan, double loss, double reachable) {
  double readings = 0.0;
  for (const ScanChannel& channel : scan.channels) {
    for (std::size_t row = 0; row < scan.size(); ++row) {
      readings += cos_deg(scan.theta_i_deg[row]) * channel.values[row] * channel.values[row];
    }
  }
  const double round_off = 1e-12 * readings;
  if (std::max(loss, reachable) <= round_off) return 1.0;
  return loss / std::max(reachable, round_off);
}

}  // namespace goniofit
