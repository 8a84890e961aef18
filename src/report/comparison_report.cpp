#include "report/comparison_report.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "report/comparison_criteria_report.h"
#include "report/fit_rows.h"
#include "report/material_json.h"
#include "report/number_text.h"
#include "report/text_table.h"

namespace goniofit {
namespace {

using Align = TextTable::Align;
using Json = nlohmann::ordered_json;

// A surface has a slope and lengths in every report, whether or not its components read them.
bool is_read(const FittedParameter& p, const Material& material) {
  const EffectSet& components = material.components;
  if (p.name == "slope") return components.has(Effect::dd) || components.has(Effect::fs) || components.has(Effect::coh);
  return p.unit != "um";
}

double least_loss(const Comparison& comparison) {
  return comparison.rows.empty() ? 0.0 : comparison.rows.front().fit.loss;
}

// 1 for the best; infinity beside one that fits exactly.
double relative_loss(double loss, double least) {
  if (least > 0.0) return loss / least;
  return loss > 0.0 ? std::numeric_limits<double>::infinity() : 1.0;
}

// "slope 0.0854, tail 2.31": the parameters that all channels share.
std::string shape_text(const FitResult& fit) {
  std::string text;
  for (const FittedParameter& p : fit.parameters) {
    if (!p.channel.empty() || !p.value || p.derived) continue;
    text += (text.empty() ? "" : ", ") + p.name + " " + fmt::format("{:.4g}", *p.value);
  }
  return text;
}

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json value_or_null(const std::optional<double>& value) { return value ? finite_or_null(*value) : Json(nullptr); }

Json terms_json(const Material& material) {
  if (material.model != surface_model) return {{"fresnel", name_of(material.terms.fresnel)}};
  return terms_json(material.terms);
}

Json criteria_json(const SelectionRow& r) {
  return {{"free_parameters", r.free_parameters},
          {"chi2", finite_or_null(r.chi2)},
          {"aicc", finite_or_null(r.aicc)},
          {"bic", finite_or_null(r.bic)},
          {"aicc_weight", finite_or_null(r.aicc_weight)},
          {"bic_weight", finite_or_null(r.bic_weight)},
          {"cross_validated", value_or_null(r.cross_validated)},
          {"difference", value_or_null(r.difference)},
          {"difference_error", value_or_null(r.difference_error)},
          {"chosen", r.chosen}};
}

// Null where the scan states its own.
Json noise_json(const Comparison& comparison) {
  if (!comparison.noise) return nullptr;
  return {{"relative", comparison.noise->relative}, {"additive", comparison.noise->additive}};
}

Json row_json(const ComparedFit& row, double least) {
  const FitResult& fit = row.fit;
  Json out{{"model", row.model},
           {"free_parameters", row.free_parameters},
           {"loss", finite_or_null(fit.loss)},
           {"rms", finite_or_null(fit.rms)},
           {"relative_loss", finite_or_null(relative_loss(fit.loss, least))},
           {"converged", fit.converged},
           {"seconds", fit.seconds},
           {"remarks", remarks_of(row)},
           {"components", effect_names(fit.material.components)},
           {"terms", terms_json(fit.material)},
           {"criteria", criteria_json(row.criteria)}};
  out["parameters"] = Json::array();
  for (const FittedParameter& p : fit.parameters) {
    out["parameters"].push_back({{"name", p.name},
                                 {"channel", p.channel.empty() ? Json(nullptr) : Json(p.channel)},
                                 {"unit", p.unit},
                                 {"value", value_or_null(p.value)},
                                 {"standard_uncertainty", value_or_null(p.u)},
                                 {"state", state_of(p)}});
  }
  return out;
}

}  // namespace

std::vector<std::string> remarks_of(const ComparedFit& row) {
  std::vector<std::string> remarks;
  if (!row.fit.converged) remarks.emplace_back("did not converge");
  for (const FittedParameter& p : row.fit.parameters) {
    const std::string name = p.channel.empty() ? p.name : p.channel + "." + p.name;
    if (p.fixed) continue;
    if (p.at_upper) remarks.push_back(name + " at upper bound");
    // A coefficient of 0 says that its part is not in the scan, which is a result.
    if (p.at_lower && p.channel.empty()) remarks.push_back(name + " at lower bound");
    if (!p.value && p.channel.empty() && is_read(p, row.fit.material)) remarks.push_back(name + " undetermined");
  }
  return remarks;
}

std::string comparison_report(const Comparison& comparison, const Scan& scan, const ReportStyle& style) {
  TextTable table({{"model", Align::left},
                   {"free", Align::right},
                   {"loss / sr⁻²", Align::right},
                   {"RMS / sr⁻¹", Align::right},
                   {"loss / best", Align::right},
                   {"shape", Align::left},
                   {"time", Align::right},
                   {"", Align::left}});
  const double least = least_loss(comparison);
  for (const ComparedFit& row : comparison.rows) {
    const std::vector<std::string> remarks = remarks_of(row);
    table.add_row(
        {printable(row.model), fmt::format("{}", row.free_parameters), fmt::format("{:#.4g}", row.fit.loss),
         fmt::format("{:#.3g}", row.fit.rms), fmt::format("{:#.4g}", relative_loss(row.fit.loss, least)),
         shape_text(row.fit), duration_text(row.fit.seconds),
         Cell(printable(fmt::format("{}", fmt::join(remarks, ", "))), row.fit.converged ? Tint::warning : Tint::bad)});
  }
  std::string out = tinted(printable(scan.name.empty() ? scan.source : scan.name), Tint::bold, style.color) +
                    fmt::format(": {} directions × {} channels\n", scan.size(), scan.channels.size());
  out += table.str(2, style.color);
  out += tinted("  (loss: the weighted sum of squares that each fit makes least; free: parameters that it found)\n",
                Tint::faint, style.color);
  out += comparison_criteria_block(comparison, style.color);
  for (const std::string& note : comparison.notes) out += "  " + wrapped(printable(note), 2) + '\n';
  return out;
}

std::string comparison_json(const Comparison& comparison, const Scan& scan) {
  Json out{{"name", scan.name},
           {"scan", scan.source},
           {"directions", scan.size()},
           {"channels", scan.channels.size()},
           {"rows", Json::array()}};
  for (const ComparedFit& row : comparison.rows) out["rows"].push_back(row_json(row, least_loss(comparison)));
  out["verdict"] = comparison.verdict;
  out["noise"] = noise_json(comparison);
  out["stated_uncertainties"] = !comparison.verdict.empty() && !comparison.noise;
  out["u_scale"] = comparison.u_scale;
  out["groups"] = comparison.groups;
  out["notes"] = comparison.notes;
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace goniofit
