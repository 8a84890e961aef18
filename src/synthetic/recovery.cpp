#include "synthetic/recovery.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/angles.h"

namespace goniofit {
namespace {

constexpr double z_68 = 1.0;
constexpr double z_95 = 1.959963984540054;

// A stated interval knows of bounds and of few degrees of freedom; where there is none, a reader takes value ± z u.
void count(Proportion& coverage, double truth, const std::optional<Interval>& stated, const Estimate& e, double z) {
  if (!stated && !e.u) return;
  const Interval interval = stated.value_or(Interval{e.value - z * e.u.value_or(0.0), e.value + z * e.u.value_or(0.0)});
  ++coverage.of;
  if (interval.lower <= truth && truth <= interval.upper) ++coverage.count;
}

}  // namespace

Estimate estimate_of(const FittedParameter& p) { return {p.value.value(), p.u, p.interval_68, p.interval_95}; }

RecoveryTally::RecoveryTally(std::string parameter, double truth, bool truth_on_bound) {
  recovery_.parameter = std::move(parameter);
  recovery_.truth = truth;
  recovery_.truth_on_bound = truth_on_bound;
}

void RecoveryTally::add(const Estimate& e) {
  Recovery& r = recovery_;
  ++r.determined;
  const double before = e.value - r.mean;
  r.mean += before / static_cast<double>(r.determined);
  squares_ += before * (e.value - r.mean);
  if (e.u) {
    ++r.stated_u;
    r.mean_u += (*e.u - r.mean_u) / static_cast<double>(r.stated_u);
  }
  count(r.coverage_68, r.truth, e.interval_68, e, z_68);
  count(r.coverage_95, r.truth, e.interval_95, e, z_95);
}

Recovery RecoveryTally::result() const {
  Recovery r = recovery_;
  const auto n = static_cast<double>(r.determined);
  r.bias = r.mean - r.truth;
  if (r.determined > 1) {
    r.spread = std::sqrt(squares_ / (n - 1.0));
    r.bias_error = r.spread / std::sqrt(n);
  }
  return r;
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
