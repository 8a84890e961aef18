#include "cli/verify_table.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "report/number_text.h"
#include "report/text_table.h"

namespace goniofit::cli {
namespace {

using Align = TextTable::Align;
using Json = nlohmann::ordered_json;

std::string significant(double value, int digits) { return fmt::format("{:.{}g}", value, digits); }

std::string coverage_text(double coverage, std::size_t stated) {
  return stated == 0 ? "–" : fmt::format("{:.1f} %", 100.0 * coverage);
}

std::string relative_bias(const Recovery& r) { return r.truth == 0.0 ? "" : percent_text(r.bias / std::fabs(r.truth)); }

std::string verdict(bool good, const ReportStyle& style) {
  return good ? tinted("passed", Tint::good, style.color) : tinted("FAILED", Tint::bad, style.color);
}

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json recovery_json(const Recovery& r) {
  return {{"parameter", r.parameter},
          {"truth", finite_or_null(r.truth)},
          {"mean", finite_or_null(r.mean)},
          {"bias", finite_or_null(r.bias)},
          {"spread", finite_or_null(r.spread)},
          {"mean_standard_uncertainty", r.stated > 0 ? finite_or_null(r.mean_u) : Json(nullptr)},
          {"coverage_68", r.stated > 0 ? finite_or_null(r.coverage_68) : Json(nullptr)},
          {"coverage_95", r.stated > 0 ? finite_or_null(r.coverage_95) : Json(nullptr)},
          {"stated", r.stated}};
}

Json report_json(const VerifyReport& report) {
  Json out{{"name", report.name}, {"trials", report.trials}, {"failures", report.failures}};
  out["parameters"] = Json::array();
  for (const Recovery& r : report.parameters) out["parameters"].push_back(recovery_json(r));
  out["missed"] = report.missed;
  out["passed"] = passed(report);
  return out;
}

Json random_json(const RandomRecoveryReport& report) {
  return {{"materials", report.materials},
          {"wrong_minima", report.wrong_minima},
          {"worst_ratio", finite_or_null(report.worst_ratio)},
          {"polish_starts", report.polish_starts},
          {"polish_failures", report.polish_failures},
          {"failures", report.failures},
          {"passed", passed(report)}};
}

}  // namespace

bool passed(const VerifyReport& report) noexcept { return report.missed.empty(); }
bool passed(const RandomRecoveryReport& report) noexcept { return report.wrong_minima == 0; }

std::string verify_table(const VerifyReport& report, const ReportStyle& style) {
  TextTable table({{"parameter", Align::left},
                   {"truth", Align::right},
                   {"mean", Align::right},
                   {"bias", Align::right},
                   {"of truth", Align::right},
                   {"spread", Align::right},
                   {"stated u", Align::right},
                   {"in ±1 u", Align::right},
                   {"in 95 %", Align::right},
                   {"stated", Align::right}});
  for (const Recovery& r : report.parameters) {
    table.add_row({printable(r.parameter), number_text(r.truth), significant(r.mean, 6), significant(r.bias, 2),
                   relative_bias(r), significant(r.spread, 3), r.stated == 0 ? "–" : significant(r.mean_u, 3),
                   coverage_text(r.coverage_68, r.stated), coverage_text(r.coverage_95, r.stated),
                   fmt::format("{}/{}", r.stated, report.trials)});
  }
  std::string out = tinted(printable(report.name), Tint::bold, style.color) +
                    fmt::format(": {} trials, {} failed\n", report.trials, report.failures) + table.str(2, style.color);
  for (const std::string& missed : report.missed) out += "  " + wrapped(printable(missed), 2) + '\n';
  return out + "  " + verdict(passed(report), style) + '\n';
}

std::string random_recovery_text(const RandomRecoveryReport& report, const ReportStyle& style) {
  std::string out = tinted("random materials", Tint::bold, style.color) + '\n';
  out += fmt::format("  materials        {}\n", report.materials);
  out += fmt::format("  wrong minima     {}\n", report.wrong_minima);
  out += fmt::format("  worst loss       {:.6g} times the loss reached from the truth\n", report.worst_ratio);
  if (report.polish_starts > 0) {
    out += fmt::format("  polish alone     {} of {} random starts end in a wrong minimum\n", report.polish_failures,
                       report.polish_starts);
  }
  for (const std::string& failure : report.failures) out += "  " + wrapped(printable(failure), 2) + '\n';
  return out + "  " + verdict(passed(report), style) + '\n';
}

std::string verify_json(const std::vector<VerifyReport>& reports, const RandomRecoveryReport* random) {
  bool all = random == nullptr || passed(*random);
  Json out{{"recipes", Json::array()}};
  for (const VerifyReport& report : reports) {
    out["recipes"].push_back(report_json(report));
    all = all && passed(report);
  }
  out["random"] = random == nullptr ? Json(nullptr) : random_json(*random);
  out["passed"] = all;
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace goniofit::cli
