#include "report/verify_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "report/number_text.h"
#include "report/text_table.h"

namespace goniofit {
namespace {

using Align = TextTable::Align;

std::string verdict(bool good, const ReportStyle& style) {
  return good ? tinted("passed", Tint::good, style.color) : tinted("FAILED", Tint::bad, style.color);
}

std::string bias_text(const Recovery& r) {
  if (r.determined < 2) return fmt::format("{:.2g}", r.bias);
  const ValueText text = value_text(r.bias, r.bias_error);
  return text.value + " ± " + text.uncertainty;
}

Cell coverage_cell(Proportion coverage, bool missed) {
  if (coverage.of == 0) return {"–"};
  const Interval limits = exact_limits(coverage);
  return {
      fmt::format("{:.1f} % ({:.1f}–{:.1f})", 100.0 * coverage.fraction(), 100.0 * limits.lower, 100.0 * limits.upper),
      missed ? Tint::bad : Tint::none};
}

std::string recipe_text(const VerifyReport& report, const ReportStyle& style) {
  TextTable table({{"parameter", Align::left},
                   {"truth", Align::right},
                   {"bias", Align::right},
                   {"of truth", Align::right},
                   {"spread", Align::right},
                   {"mean u", Align::right},
                   {"in 68 % interval", Align::right},
                   {"in 95 % interval", Align::right},
                   {"stated in", Align::right}});
  for (const Recovery& r : report.parameters) {
    const bool biased = report.is_missed(r.parameter, Bound::bias) || report.is_missed(r.parameter, Bound::slope_bias);
    table.add_row({printable(r.parameter),
                   number_text(r.truth),
                   {bias_text(r), biased ? Tint::bad : Tint::none},
                   r.truth == 0.0 ? "" : percent_text(r.bias / std::fabs(r.truth)),
                   fmt::format("{:.3g}", r.spread),
                   r.stated_u == 0 ? "–" : fmt::format("{:.3g}", r.mean_u),
                   coverage_cell(r.coverage_68, report.is_missed(r.parameter, Bound::coverage_68)),
                   coverage_cell(r.coverage_95, report.is_missed(r.parameter, Bound::coverage_95)),
                   fmt::format("{} of {}", r.coverage_95.of, report.trials)});
  }
  std::string out = tinted(printable(report.name), Tint::bold, style.color) +
                    fmt::format(": {} trials (seed {}), {} failed (at most {:.2g} %)\n", report.trials, report.seed,
                                report.failures, 100.0 * exact_limits(report.failure_rate(), 0.90).upper) +
                    table.str(2, style.color);
  if (!report.undetermined.empty()) {
    std::string names;
    for (const std::string& name : report.undetermined) names += (names.empty() ? "" : ", ") + name;
    out += "  " + wrapped("never determined: " + printable(names), 2) + '\n';
  }
  for (const std::string& missed : report.missed) out += "  " + wrapped(printable(missed), 2) + '\n';
  return out + "  " + verdict(report.missed.empty(), style) + '\n';
}

std::string random_text(const RandomRecoveryReport& report, const ReportStyle& style) {
  std::string out = tinted("random materials", Tint::bold, style.color) + '\n';
  out += fmt::format("  materials        {}\n", report.materials);
  out += fmt::format("  wrong minima     {}\n", report.wrong_minima);
  out += fmt::format("  worst loss       {:.6g} times the loss reached from the truth\n", report.worst_ratio);
  if (report.polish_starts > 0) {
    out += fmt::format("  polish alone     {} of {} random starts end in a wrong minimum\n", report.polish_failures,
                       report.polish_starts);
  }
  for (const std::string& failure : report.failures) out += "  " + wrapped(printable(failure), 2) + '\n';
  return out + "  " + verdict(report.wrong_minima == 0, style) + '\n';
}

}  // namespace

std::size_t VerifyRunReport::tests() const noexcept {
  std::size_t count = 0;
  for (const VerifyReport& report : recipes) {
    for (const BoundCheck& check : report.checks) count += check.p ? 1 : 0;
  }
  return count;
}

std::size_t VerifyRunReport::missed() const noexcept {
  std::size_t count = 0;
  for (const VerifyReport& report : recipes) count += report.missed.size();
  return count;
}

bool VerifyRunReport::passed() const noexcept {
  return missed() == 0 && (random == nullptr || random->wrong_minima == 0);
}

std::string verify_text(const VerifyRunReport& run, const ReportStyle& style) {
  std::string out;
  for (const VerifyReport& report : run.recipes) out += recipe_text(report, style) + '\n';
  if (!run.recipes.empty()) {
    out += fmt::format("{} of {} tests missed at {:g} % for all together (Holm's correction); limits hold 95 %\n",
                       run.missed(), run.tests(), 100.0 * run.level);
  }
  if (run.random != nullptr) out += (out.empty() ? "" : "\n") + random_text(*run.random, style);
  return out;
}

}  // namespace goniofit
