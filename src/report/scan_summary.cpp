#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "report/fit_report.h"
#include "report/fit_rows.h"
#include "report/number_text.h"
#include "report/scan_statistics.h"
#include "report/text_table.h"

namespace goniofit {

namespace {

using Align = TextTable::Align;

constexpr std::size_t indent = 2;
constexpr std::size_t label_width = 14;
constexpr std::size_t most_incidences = 24;

std::string angle(double degrees) { return fmt::format("{:.6g}°", degrees == 0.0 ? 0.0 : degrees); }
std::string angles(const ValueRange& range) { return angle(range.min) + " to " + angle(range.max); }
std::string count_text(std::size_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

// "label" by display columns: the labels have Greek letters in them.
std::string line(const std::string& label, const std::string& text) {
  return std::string(indent, ' ') + fmt::format("{:<{}}", label, label_width) + wrapped(text, indent + label_width) +
         '\n';
}

std::string azimuth_text(const ScanStatistics& s) {
  std::string text = s.left > 0 && s.right > 0 ? "both halves"
                     : s.left > 0              ? "the half from 0° to 180°"
                     : s.right > 0             ? "the half from -180° to 0°"
                                               : "in the plane of incidence only";
  if (s.azimuth_gap) {
    const auto [from, to] = *s.azimuth_gap;
    text += fmt::format("; largest gap {}, |Δφ| from {} to {}", angle(to - from), angle(from), angle(to));
  }
  return text;
}

std::string reciprocity_text(const ScanStatistics& s) {
  if (s.reciprocal_pairs == 0) return "not testable: no direction was read with its swapped pair";
  return count_text(s.reciprocal_pairs, "direction", "directions") +
         " read with the swapped pair, |Δφ| alike; ratios below";
}

std::string repeats_text(const ScanStatistics& s) {
  if (s.repeated_directions == 0) return "none";
  return fmt::format("{} read more than once, {} readings; spread below",
                     count_text(s.repeated_directions, "direction", "directions"), s.repeated_readings);
}

std::string overview(const Scan& scan, const ScanStatistics& s, bool color) {
  const bool hemispherical = scan.geometry == ScanGeometry::hemispherical;
  std::string out = tinted(printable(scan.name.empty() ? "(no name)" : scan.name), Tint::bold, color) + '\n';
  out += line("scan", printable(scan.source));
  out += line("geometry", fmt::format("{}, {} × {}", geometry_name(scan.geometry),
                                      count_text(scan.size(), "direction", "directions"),
                                      count_text(scan.channels.size(), "channel", "channels")));
  out += line("θᵢ", angles(s.theta_i_deg) + ", " + count_text(s.incidences.size(), "angle", "angles"));
  out += line("θᵣ", angles(s.theta_r_deg) + (hemispherical ? "" : ", positive on the forward side"));
  if (hemispherical) out += line("Δφ", azimuth_text(s));
  out += line("in the plane", fmt::format("{} forward, {} retro", s.forward, s.retro));
  out += line("at θ = 90°", s.at_horizon == 0 ? "none" : count_text(s.at_horizon, "reading", "readings"));
  out += line("reciprocity", reciprocity_text(s));
  out += line("repeats", repeats_text(s));
  out += line("solid angle", scan.solid_angle_sr ? number_text(*scan.solid_angle_sr) + " sr" : "not stated");
  return out;
}

std::string incidence_table(const ScanStatistics& s, bool color) {
  if (s.incidences.size() > most_incidences) {
    const auto [fewest, most] = std::minmax_element(
        s.incidences.begin(), s.incidences.end(), [](const auto& a, const auto& b) { return a.readings < b.readings; });
    const std::string readings = fewest->readings == most->readings
                                     ? count_text(most->readings, "reading", "readings")
                                     : fmt::format("{} to {} readings", fewest->readings, most->readings);
    return fmt::format("{}{} incidence angles, {} each\n", std::string(indent, ' '), s.incidences.size(), readings);
  }
  TextTable table({{"θᵢ", Align::right},
                   {"readings", Align::right},
                   {"θᵣ", Align::right},
                   {"mirror within", Align::right},
                   {"retro within", Align::right}});
  for (const IncidenceStatistics& i : s.incidences) {
    table.add_row({angle(i.theta_i_deg), std::to_string(i.readings), angles(i.theta_r_deg),
                   fmt::format("{:.1f}°", i.nearest_mirror_deg), fmt::format("{:.1f}°", i.nearest_retro_deg)});
  }
  return table.str(indent, color);
}

std::string index_text(const ScanChannel& channel) {
  if (!channel.n) return {};
  const double kappa = channel.kappa.value_or(0.0);
  return number_text(*channel.n) + (kappa == 0.0 ? "" : " + " + number_text(kappa) + "i");
}

std::string nonzero(std::size_t count) { return count == 0 ? std::string{} : std::to_string(count); }

std::string channel_table(const Scan& scan, const ScanStatistics& s, bool color) {
  TextTable table({{"channel", Align::left},
                   {"λ [µm]", Align::right},
                   {"n + iκ", Align::right},
                   {"least [1/sr]", Align::right},
                   {"median", Align::right},
                   {"largest", Align::right},
                   {"below 0", Align::right},
                   {"zero", Align::right},
                   {"u", Align::right},
                   {"swapped", Align::right},
                   {"9 of 10 within", Align::right},
                   {"repeats", Align::right}});
  for (std::size_t c = 0; c < scan.channels.size(); ++c) {
    const ScanChannel& channel = scan.channels[c];
    const ChannelStatistics& t = s.channels[c];
    const auto& ratio = t.reciprocity;
    table.add_row(
        {Cell(printable(channel.name)), Cell(channel.wavelength_um ? number_text(*channel.wavelength_um) : ""),
         Cell(index_text(channel)), Cell(fmt::format("{:.4g}", t.value.min)), Cell(fmt::format("{:.4g}", t.median)),
         Cell(fmt::format("{:.4g}", t.value.max)), Cell(nonzero(t.negative), Tint::warning), Cell(nonzero(t.zero)),
         Cell(t.relative_u ? percent_text(*t.relative_u) : ""), Cell(ratio ? fmt::format("{:.3f}", ratio->median) : ""),
         Cell(ratio ? fmt::format("{:.3f} to {:.3f}", ratio->inner_90.min, ratio->inner_90.max) : ""),
         Cell(t.repeat_spread ? percent_text(*t.repeat_spread) : "")});
  }
  return table.str(indent, color);
}

std::string heading(const std::string& text, bool color) { return '\n' + tinted(text, Tint::bold, color) + '\n'; }

}  // namespace

std::string scan_summary(const Scan& scan, const ReportStyle& style) {
  const ScanStatistics s = scan_statistics(scan);
  std::string out = overview(scan, s, style.color);
  out += heading("Incidence angles", style.color) + incidence_table(s, style.color);
  out += heading("Channels", style.color) + channel_table(scan, s, style.color);
  const std::vector<std::string> notes = scan_notes(scan, s);
  if (!notes.empty()) out += heading("Notes", style.color);
  for (const std::string& note : notes) out += std::string(indent, ' ') + "· " + wrapped(note, indent + 2) + '\n';
  return out;
}

}  // namespace goniofit
