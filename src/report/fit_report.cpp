#include "report/fit_report.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "report/comparison_criteria_report.h"
#include "report/fit_rows.h"
#include "report/identifiability_report.h"
#include "report/material_text.h"
#include "report/misfit_report.h"
#include "report/number_text.h"
#include "report/objective_text.h"
#include "report/profile_report.h"
#include "report/text_table.h"
#include "report/uncertainty_report.h"

namespace goniofit {
namespace {

using Align = TextTable::Align;

constexpr std::size_t indent = 2;
constexpr std::size_t label_width = 14;
constexpr std::size_t compact_above = 4;  // more channels than this: one row a channel
constexpr std::size_t most_reflectance_rows = 12;
constexpr std::size_t most_reflectance_columns = 8;

std::string heading(const std::string& text, bool color) { return '\n' + tinted(text, Tint::bold, color) + '\n'; }

// One "label  text" line; long text goes on below itself.
std::string line(const std::string& label, const std::string& text, Tint tint, bool color) {
  const std::string body = wrapped(text, indent + label_width);
  return std::string(indent, ' ') + fmt::format("{:<{}}", label, label_width) + tinted(body, tint, color) + '\n';
}

std::string count_text(std::size_t count, const std::string& one, const std::string& many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

std::string optics_text(const Material& material) {
  const auto describe = [](const MaterialChannel& c) {
    if (c.f0) return "f0 = " + number_text(*c.f0);
    if (!c.n) return std::string("none");
    return "n = " + number_text(*c.n) + ", κ = " + number_text(c.kappa.value_or(0.0));
  };
  std::set<std::string> different;
  for (const MaterialChannel& channel : material.channels) different.insert(describe(channel));
  if (different.size() == 1) return *different.begin();
  if (material.channels.size() > compact_above) return "by channel (below)";
  std::string text;
  for (const MaterialChannel& channel : material.channels) {
    text += (text.empty() ? "" : "; ") + printable(channel.name) + ": " + describe(channel);
  }
  return text;
}

bool is_peer(const Material& material) { return material.model != surface_model; }

std::string title_block(const FitResult& result, const Scan& scan, bool color) {
  const Material& material = result.material;
  const auto say = [color](const std::string& label, const std::string& text) {
    return line(label, text, Tint::none, color);
  };
  std::string out = tinted(printable(material.name.empty() ? "(no name)" : material.name), Tint::bold, color) + '\n';
  out += say("scan", printable(scan.source));
  out += say("geometry", fmt::format("{}, {} × {}", geometry_name(scan.geometry),
                                     count_text(scan.size(), "direction", "directions"),
                                     count_text(scan.channels.size(), "channel", "channels")));
  out += say("model", material.model + (material.surface.anisotropic() ? ", anisotropic" : ""));
  if (!is_peer(material)) {
    out += say("components", effects_text(material.components, " + ") +
                                 (result.components_were_auto ? " (chosen automatically)" : ""));
  }
  out += say("terms", terms_text(material));
  if (const std::string forms = forms_text(material); !forms.empty()) out += say("forms", forms);
  out += say("optics", optics_text(material));
  if (material.components.has(Effect::coh)) {
    out += say("solid angle", number_text(material.solid_angle_sr) + " sr (source)");
  }
  out += say("loss", objective_text(result));
  return out;
}

Cell remark_cell(const FittedParameter& p) {
  const std::string text = remark_of(p);
  const bool weak = p.at_lower || p.at_upper || (!p.value && !p.fixed);
  return {text, weak ? Tint::warning : Tint::faint};
}

std::string bounds_text(const FittedParameter& p) {
  if (p.fixed || p.derived || !p.value) return {};
  const auto end = [](double bound) {
    if (std::isinf(bound)) return std::string(bound > 0 ? "∞" : "−∞");
    return number_text(bound);
  };
  return end(p.lower) + " … " + end(p.upper);
}

void add_parameter(TextTable& table, const FittedParameter& p) {
  const std::string name = p.channel.empty() ? p.name : printable(p.channel) + "." + p.name;
  if (!p.value) {
    table.add_row({name, "–", "", "", "", unit_text(p.unit), bounds_text(p), remark_cell(p)});
    return;
  }
  if (!p.u) {
    table.add_row(
        {name, number_text(*p.value), "", "", interval_text(p), unit_text(p.unit), bounds_text(p), remark_cell(p)});
    return;
  }
  const ValueText text = value_text(*p.value, *p.u);
  const std::string relative = *p.value == 0.0 ? "" : percent_text(std::fabs(*p.u / *p.value));
  table.add_row({name, text.value, "± " + text.uncertainty, relative, interval_text(p), unit_text(p.unit),
                 bounds_text(p), remark_cell(p)});
}

TextTable parameter_table() {
  return TextTable({{"parameter", Align::left},
                    {"value", Align::right},
                    {"std. unc.", Align::left},
                    {"relative", Align::right},
                    {"95 %", Align::left},
                    {"unit", Align::left},
                    {"bounds", Align::left},
                    {"", Align::left}});
}

// "0.5912 ± 0.0014", or the value and why it has no uncertainty.
std::pair<Cell, Cell> compact_cells(const FittedParameter* p) {
  if (p == nullptr) return {};
  if (!p->value) return {Cell("–"), Cell("undetermined", Tint::warning)};
  if (p->u) {
    const ValueText text = value_text(*p->value, *p->u);
    return {Cell(text.value), Cell("± " + text.uncertainty)};
  }
  const bool bound = p->at_lower || p->at_upper;
  if (bound && !p->fixed && p->interval_95)
    return {Cell(number_text(*p->value)), Cell(interval_text(*p), Tint::warning)};
  return {Cell(number_text(*p->value)), Cell(short_remark_of(*p), bound ? Tint::warning : Tint::faint)};
}

std::string compact_channels(const FitResult& result, bool color) {
  const std::vector<std::string> names = channel_parameter_names(result);
  std::vector<TextTable::Column> columns{{"channel", Align::left}};
  for (const std::string& name : names) {
    columns.push_back({name, Align::right});
    columns.push_back({"", Align::left});
  }
  columns.push_back({"RMS / sr⁻¹", Align::right});
  TextTable table(columns);
  for (std::size_t c = 0; c < result.material.channels.size(); ++c) {
    const std::string& channel = result.material.channels[c].name;
    std::vector<Cell> row{printable(channel)};
    for (const std::string& name : names) {
      auto [value, u] = compact_cells(find_parameter(result, channel, name));
      row.push_back(std::move(value));
      row.push_back(std::move(u));
    }
    row.emplace_back(c < result.channel_rms.size() ? fmt::format("{:#.3g}", result.channel_rms[c]) : std::string());
    table.add_row(std::move(row));
  }
  return table.str(indent, color);
}

std::string parameter_block(const FitResult& result, bool color) {
  const bool compact = result.material.channels.size() > compact_above;
  std::string out = heading("Parameters", color);
  TextTable table = parameter_table();
  for (const FittedParameter& p : result.parameters) {
    if (p.channel.empty()) add_parameter(table, p);
  }
  if (!compact) {
    for (const FittedParameter& p : result.parameters) {
      if (!p.channel.empty()) add_parameter(table, p);
    }
  }
  out += table.str(indent, color);
  if (compact) out += heading("Channels", color) + compact_channels(result, color);
  for (const std::string& sentence : uncertainty_sentences(result))
    out += tinted("  (" + wrapped(sentence, indent + 1) + ")\n", Tint::faint, color);
  return out;
}

std::string channel_rms_text(const FitResult& result) {
  std::string text;
  for (std::size_t c = 0; c < result.channel_rms.size(); ++c) {
    text += fmt::format("{}{} {:#.3g}", c > 0 ? ", " : "", printable(result.material.channels[c].name),
                        result.channel_rms[c]);
  }
  return text + " sr⁻¹ (RMS, unweighted)";
}

std::string fit_block(const FitResult& result, const Scan& scan, bool color) {
  const auto say = [color](const std::string& label, const std::string& text, Tint tint = Tint::none) {
    return line(label, text, tint, color);
  };
  std::string out = heading("Fit", color);
  out += say("converged", result.converged ? "yes" : "NO", result.converged ? Tint::good : Tint::bad);
  if (!is_published(result)) out += say("minimum", fmt::format("{:.6g}", result.objective.value));
  out += say("loss", fmt::format("{:.6g} sr⁻²{}", result.loss,
                                 is_published(result) ? "" : " = Σ cos θᵢ (f_model − f_measured)², for comparison"));
  out += say("RMS", fmt::format("{:.4g} sr⁻¹ = √(loss / readings)", result.rms));
  const std::size_t channels = result.channel_rms.size();
  if (channels > 1 && channels <= compact_above) out += say("by channel", channel_rms_text(result));
  out += say("samples", samples_text(result, scan));
  if (result.left_out.negative_values > 0) {
    out += say("negatives",
               count_text(result.left_out.negative_values, "negative value", "negative values") + " (noise), kept");
  }
  out += say("search", fmt::format("{}, {}, {}; {}", count_text(result.search_evaluations, "evaluation", "evaluations"),
                                   count_text(result.polish_starts, "start", "starts"),
                                   count_text(result.polish_iterations, "iteration", "iterations"),
                                   duration_text(result.seconds)));
  return out;
}

std::string reflectance_block(const FitResult& result, bool color) {
  if (result.reflectance.empty()) return {};
  const std::size_t channel_count = result.material.channels.size();
  const std::vector<std::size_t> rows = evenly_chosen(result.reflectance.size(), most_reflectance_rows);
  const std::vector<std::size_t> channels = evenly_chosen(channel_count, most_reflectance_columns);
  std::vector<TextTable::Column> columns{{"θᵢ / °", Align::right}};
  for (const std::size_t c : channels) columns.push_back({printable(result.material.channels[c].name), Align::right});
  columns.push_back({"", Align::left});
  TextTable table(columns);
  for (const std::size_t r : rows) {
    const HemisphericalReflectance& at = result.reflectance[r];
    std::vector<Cell> row{number_text(at.theta_i_deg)};
    for (const std::size_t c : channels) {
      const double value = at.by_channel.at(c);
      row.emplace_back(fmt::format("{:.4f}", value), value > 1.0 ? Tint::bad : Tint::none);
    }
    const bool over = std::any_of(at.by_channel.begin(), at.by_channel.end(), [](double v) { return v > 1.0; });
    row.emplace_back(over ? "> 1" : "", Tint::bad);
    table.add_row(std::move(row));
  }
  std::string out = heading("Directional-hemispherical reflectance of the fit", color) + table.str(indent, color);
  if (rows.size() < result.reflectance.size() || channels.size() < channel_count) {
    out += tinted(fmt::format("  ({} of {} incidence angles, {} of {} channels; --json has all)\n", rows.size(),
                              result.reflectance.size(), channels.size(), channel_count),
                  Tint::faint, color);
  }
  return out;
}

std::string fitted_reflectances_block(const FitResult& result, bool color) {
  if (result.fitted_reflectances.empty()) return {};
  TextTable table({{"θᵢ / °", Align::right},
                   {"channel", Align::left},
                   {"measured", Align::right},
                   {"fitted", Align::right},
                   {"difference", Align::right}});
  for (const FittedReflectance& r : result.fitted_reflectances) {
    table.add_row({number_text(r.theta_i_deg), printable(r.channel), fmt::format("{:.4f}", r.measured),
                   fmt::format("{:.4f}", r.fitted), fmt::format("{:+.4f}", r.fitted - r.measured)});
  }
  return heading("Reflectances fitted beside the scan", color) + table.str(indent, color);
}

// How the effects were chosen.
std::string selection_block(const Selection& selection, bool color) {
  TextTable table({{"", Align::left},
                   {"components", Align::left},
                   {"free", Align::right},
                   {"loss", Align::right},
                   {"χ²", Align::right},
                   {"ΔAICc", Align::right},
                   {"ΔBIC", Align::right},
                   {"weight", Align::right},
                   {"left-out score", Align::right},
                   {"to the best", Align::left}});
  double aicc = selection.rows.front().aicc;
  double bic = selection.rows.front().bic;
  for (const SelectionRow& row : selection.rows) {
    aicc = std::min(aicc, row.aicc);
    bic = std::min(bic, row.bic);
  }
  for (const SelectionRow& row : selection.rows) {
    std::vector<Cell> cells{row.chosen ? "→" : "",
                            effects_text(row.components, " + "),
                            fmt::format("{}", row.free_parameters),
                            fmt::format("{:.5g}", row.loss),
                            fmt::format("{:.5g}", row.chi2),
                            fmt::format("{:.4g}", row.aicc - aicc),
                            fmt::format("{:.4g}", row.bic - bic),
                            fmt::format("{:.3f}", row.bic_weight)};
    if (row.cross_validated) cells.emplace_back(fmt::format("{:.4f}", *row.cross_validated));
    if (row.difference) cells.emplace_back(fmt::format("+{:.4f} ± {:.4f}", *row.difference, *row.difference_error));
    table.add_row(std::move(cells));
  }
  std::string out = heading("Choice of the components", color) + table.str(indent, color);
  std::string text = noise_text(selection.noise, selection.u_scale) + "; weight by the BIC";
  if (!selection.channels.empty()) {
    text += fmt::format("; compared on {}, which tell most, and the choice confirmed on all channels",
                        fmt::join(selection.channels, ", "));
  }
  if (!selection.not_fitted.empty()) {
    text += fmt::format("; {} not tried, being parts of what describes the scan far worse",
                        count_text(selection.not_fitted.size(), "more set was", "more sets were"));
  }
  return out + tinted("  (" + wrapped(text, indent + 1) + ")\n", Tint::faint, color);
}

std::string list_block(const std::string& title, const std::vector<std::string>& items, Tint tint, bool color) {
  if (items.empty()) return {};
  std::string out = heading(title, color);
  for (const std::string& item : items) {
    out += "  " + tinted("•", tint, color) + " " + wrapped(printable(item), indent + 2) + '\n';
  }
  return out;
}

}  // namespace

std::string fit_report(const FitResult& result, const Scan& scan, const ReportStyle& style) {
  std::string out = title_block(result, scan, style.color);
  out += parameter_block(result, style.color);
  if (!result.profiles.empty())
    out += heading("Profile likelihoods", style.color) + profile_block(result.profiles, style.color);
  out += fit_block(result, scan, style.color);
  if (result.diagnostics) {
    out += heading("Misfit", style.color) + misfit_block(*result.diagnostics, scan, style.color);
  }
  if (const std::string determined = identifiability_block(result, style.color); !determined.empty()) {
    out += heading("What the scan determines", style.color) + determined;
  }
  out += fitted_reflectances_block(result, style.color);
  if (style.show_reflectance) out += reflectance_block(result, style.color);
  if (result.selection) out += selection_block(*result.selection, style.color);
  out += list_block("Notes", result.notes, Tint::faint, style.color);
  out += list_block("Warnings", result.warnings, Tint::warning, style.color);
  return out;
}

}  // namespace goniofit
