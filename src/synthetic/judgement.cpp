#include "synthetic/judgement.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace goniofit {
namespace {

void add_slope_bias(const Recovery& r, double limit, std::vector<BoundCheck>& checks) {
  const double bias = r.bias / r.truth;
  BoundCheck check{Bound::slope_bias, r.parameter, bias, {-limit, limit}};
  check.missed = !(std::fabs(bias) <= limit);
  checks.push_back(check);
}

void add_bias(const Recovery& r, double limit, std::vector<BoundCheck>& checks) {
  if (r.truth_on_bound || r.determined < 2 || !(r.mean_u > 0.0)) return;
  BoundCheck check{Bound::bias, r.parameter, r.bias / r.mean_u, {-limit, limit}};
  check.p = p_mean_within(r.bias, r.bias_error, r.determined, limit * r.mean_u);
  checks.push_back(check);
}

void add_coverage(Bound bound, const std::string& parameter, Proportion coverage,
                  const std::optional<std::pair<double, double>>& allowed, std::vector<BoundCheck>& checks) {
  if (!allowed || coverage.of == 0) return;
  BoundCheck check{bound, parameter, coverage.fraction(), {allowed->first, allowed->second}};
  check.observed = coverage;
  check.p = p_within(coverage, check.allowed);
  checks.push_back(check);
}

std::vector<BoundCheck> checks_of(const VerifyReport& report) {
  const VerifySettings& bounds = report.settings;
  std::vector<BoundCheck> checks;
  for (const Recovery& r : report.parameters) {
    if (r.parameter == "slope") add_slope_bias(r, bounds.slope_bias, checks);
    if (bounds.bias) add_bias(r, *bounds.bias, checks);
    add_coverage(Bound::coverage_68, r.parameter, r.coverage_68, bounds.coverage_68, checks);
    add_coverage(Bound::coverage_95, r.parameter, r.coverage_95, bounds.coverage_95, checks);
  }
  BoundCheck failures{Bound::failure_rate, "", report.failure_rate().fraction(), {0.0, bounds.failure_rate}};
  failures.observed = report.failure_rate();
  failures.p = p_at_most(failures.observed, bounds.failure_rate);
  checks.push_back(failures);
  return checks;
}

void correct_for_their_number(std::span<VerifyReport> reports, double level) {
  std::vector<double> p;
  for (const VerifyReport& report : reports) {
    for (const BoundCheck& check : report.checks) {
      if (check.p) p.push_back(*check.p);
    }
  }
  const std::vector<double> adjusted = holm_adjusted(p);
  std::size_t next = 0;
  for (VerifyReport& report : reports) {
    for (BoundCheck& check : report.checks) {
      if (!check.p) continue;
      check.adjusted_p = adjusted[next++];
      check.missed = *check.adjusted_p <= level;
    }
  }
}

std::string coverage_words(const BoundCheck& check) {
  const Interval limits = exact_limits(check.observed);
  return fmt::format(
      "the {} % intervals contain the truth in {:.1f} % ({:.1f} to {:.1f} %) of {} cases, expected {:g} "
      "to {:g} %",
      check.bound == Bound::coverage_68 ? 68 : 95, 100.0 * check.measured, 100.0 * limits.lower, 100.0 * limits.upper,
      check.observed.of, 100.0 * check.allowed.lower, 100.0 * check.allowed.upper);
}

std::string in_words(const BoundCheck& check) {
  std::string text = check.parameter.empty() ? "" : check.parameter + ": ";
  switch (check.bound) {
    case Bound::slope_bias:
      return text + fmt::format("the mean is {:+.3g} % off the truth, at most {:g} % allowed", 100.0 * check.measured,
                                100.0 * check.allowed.upper);
    case Bound::bias:
      text += fmt::format("the mean is {:+.2g} standard uncertainties off the truth, at most {:g} allowed",
                          check.measured, check.allowed.upper);
      break;
    case Bound::coverage_68:
    case Bound::coverage_95:
      text += coverage_words(check);
      break;
    case Bound::failure_rate:
      text += fmt::format("{} of {} fits did not converge or ended in a wrong minimum, at most {:g} % allowed",
                          check.observed.count, check.observed.of, 100.0 * check.allowed.upper);
      break;
  }
  return text + fmt::format(" (p {:.1g} after Holm's correction)", *check.adjusted_p);
}

}  // namespace

std::string_view name_of(Bound bound) noexcept {
  switch (bound) {
    case Bound::slope_bias:
      return "slope_bias";
    case Bound::bias:
      return "bias";
    case Bound::coverage_68:
      return "coverage_68";
    case Bound::coverage_95:
      return "coverage_95";
    case Bound::failure_rate:
      return "failure_rate";
  }
  return "";
}

bool VerifyReport::is_missed(const std::string& parameter, Bound bound) const {
  return std::any_of(checks.begin(), checks.end(), [&](const BoundCheck& check) {
    return check.missed && check.bound == bound && check.parameter == parameter;
  });
}

void judge(std::span<VerifyReport> reports, double level) {
  for (VerifyReport& report : reports) report.checks = checks_of(report);
  correct_for_their_number(reports, level);
  for (VerifyReport& report : reports) {
    report.missed.clear();
    for (const BoundCheck& check : report.checks) {
      if (check.missed) report.missed.push_back(in_words(check));
    }
  }
}

}  // namespace goniofit
