#include "report/misfit_report.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "report/number_text.h"
#include "report/text_table.h"

namespace goniofit {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t indent = 2;
constexpr std::size_t label_width = 14;
constexpr std::size_t most_outlier_rows = 3;

Tint tint_of(FitVerdict verdict) {
  return verdict == FitVerdict::fails ? Tint::bad : verdict == FitVerdict::systematic ? Tint::warning : Tint::good;
}

std::string verdict_text(FitVerdict verdict) {
  return verdict == FitVerdict::fails ? "FAILS" : std::string(name_of(verdict));
}

std::string outlier_table(const FitDiagnostics& d, const Scan& scan, bool color) {
  using Align = TextTable::Align;
  TextTable table({{"θᵢ / °", Align::right},
                   {"φᵢ / °", Align::right},
                   {"θᵣ / °", Align::right},
                   {"φᵣ / °", Align::right},
                   {"channel", Align::left},
                   {"measured", Align::right},
                   {"fitted", Align::right},
                   {"std. dev.", Align::right}});
  for (std::size_t i = 0; i < std::min(d.outliers.size(), most_outlier_rows); ++i) {
    const Outlier& o = d.outliers[i];
    const AnglePair a = scan.angles(o.row);
    table.add_row({number_text(a.theta_i_deg), number_text(a.phi_i_deg), number_text(a.theta_r_deg),
                   number_text(a.phi_r_deg), printable(scan.channels[o.channel].name), fmt::format("{:.4g}", o.value),
                   fmt::format("{:.4g}", o.fitted), fmt::format("{:.3g}", o.sds)});
  }
  return table.str(indent + label_width, color);
}

Json value_or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

Json sizes_json(const Misfit& m) {
  Json out;
  out["peak"] = m.peak;
  out["bulk"] = m.bulk;
  out["typical"] = value_or_null(m.typical);
  return out;
}

Json runs_json(const RunsTest& runs) {
  Json out;
  out["lines"] = runs.lines;
  out["readings"] = runs.readings;
  out["runs"] = runs.runs;
  out["expected"] = runs.expected_runs();
  out["p"] = runs.testable() ? Json(runs.p()) : Json(nullptr);
  return out;
}

Json channel_json(const ChannelDiagnostics& c, const std::string& name) {
  Json out;
  out["name"] = name;
  out["misfit"] = sizes_json(c.misfit);
  out["runs"] = runs_json(c.runs);
  out["residuals"] = {{"relative", c.residuals.relative}, {"additive", c.residuals.additive}};
  out["noise_floor"] = c.noise_floor;
  out["reciprocity"] = value_or_null(c.reciprocity);
  out["all_zero"] = c.clipping.all_zero;
  out["at_zero"] = c.clipping.at_zero;
  out["at_maximum"] = c.clipping.at_maximum;
  return out;
}

Json regions_json(const FitDiagnostics& d) {
  Json out;
  for (std::size_t k = 0; k < region_count; ++k) {
    const RegionMisfit& r = d.regions[k];
    Json one;
    one["readings"] = r.readings;
    one["of_misfit"] = r.of_misfit;
    one["of_signal"] = r.of_signal;
    one["excess"] = r.excess;
    one["typical"] = value_or_null(r.typical);
    out[std::string(name_of(static_cast<Region>(k)))] = std::move(one);
  }
  return out;
}

Json outlier_json(const Outlier& o, const Scan& scan) {
  const AnglePair a = scan.angles(o.row);
  Json out;
  out["angles"] = {a.theta_i_deg, a.phi_i_deg, a.theta_r_deg, a.phi_r_deg};
  out["channel"] = scan.channels[o.channel].name;
  out["value"] = o.value;
  out["fitted"] = o.fitted;
  out["standard_deviations"] = o.sds;
  return out;
}

Json chi_square_json(const std::optional<ReducedChiSquare>& chi) {
  if (!chi) return nullptr;
  Json out;
  out["value"] = chi->value;
  out["degrees_of_freedom"] = chi->degrees_of_freedom;
  out["range_95"] = {chi->low, chi->high};
  return out;
}

}  // namespace

std::string misfit_block(const FitDiagnostics& d, const Scan& scan, bool color) {
  const auto label = [](const std::string& text) {
    return std::string(indent, ' ') + fmt::format("{:<{}}", text, label_width);
  };
  std::string out = label("verdict") + tinted(verdict_text(d.verdict), tint_of(d.verdict), color) + '\n';
  for (const std::string& finding : d.findings) {
    out += label(&finding == &d.findings.front() ? "because" : "") + wrapped(printable(finding), indent + label_width) +
           '\n';
  }
  if (!d.outliers.empty()) out += outlier_table(d, scan, color);
  if (d.outliers.size() > most_outlier_rows) {
    out += label("") +
           tinted(fmt::format("({} of {}; --json has {})\n", most_outlier_rows, d.outlier_count, d.outliers.size()),
                  Tint::faint, color);
  }
  return out;
}

Json misfit_json(const FitDiagnostics& d, const Scan& scan) {
  Json out;
  out["verdict"] = name_of(d.verdict);
  out["findings"] = d.findings;
  out["misfit"] = sizes_json(d.misfit);
  out["runs_p"] = d.runs_testable ? Json(d.p_runs) : Json(nullptr);
  out["chi_square"] = chi_square_json(d.chi_square);
  out["regions"] = regions_json(d);
  out["channels"] = Json::array();
  for (std::size_t c = 0; c < d.channels.size(); ++c) {
    out["channels"].push_back(channel_json(d.channels[c], scan.channels[c].name));
  }
  out["readings"] = d.readings;
  out["outlier_count"] = d.outlier_count;
  out["outliers"] = Json::array();
  for (const Outlier& o : d.outliers) out["outliers"].push_back(outlier_json(o, scan));
  return out;
}

}  // namespace goniofit
