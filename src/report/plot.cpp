#include "report/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string>

#include <fmt/format.h>

#include "brdf/azimuths.h"
#include "brdf/evaluator.h"
#include "geometry/angles.h"
#include "report/fit_rows.h"
#include "report/gnuplot.h"
#include "report/number_text.h"
#include "report/plot_plan.h"
#include "support/error.h"
#include "support/output_file.h"

namespace goniofit {
namespace {

// Okabe and Ito's colours, which people with any kind of colour vision tell apart, without the yellow that is lost on
// white; each with a mark of its own for print in grey.
struct CurveStyle {
  const char* color;
  int mark;
};
constexpr std::array<CurveStyle, 8> styles{{{"#0072B2", 7},
                                            {"#D55E00", 5},
                                            {"#009E73", 9},
                                            {"#CC79A7", 13},
                                            {"#E69F00", 11},
                                            {"#56B4E9", 6},
                                            {"#000000", 4},
                                            {"#8B5A2B", 8}}};

// Everything in pixels of the SVG; the PNG has the same layout at a finer scale.
struct Layout {
  static constexpr double font = 13.0, title_font = 17.0, panel_font = 14.0, small_font = 11.5;
  static constexpr double panel_width = 330.0, panel_height = 270.0;
  static constexpr double single_width = 620.0, single_height = 420.0;
  static constexpr double left = 78.0, right = 150.0, top = 66.0, bottom = 58.0, gap = 16.0;
  static constexpr std::size_t most_columns = 3;

  Layout(std::size_t panels, bool png)
      : columns(panels == 4 ? 2 : std::min(panels, most_columns)),
        rows((panels + columns - 1) / columns),
        each_width(panels == 1 ? single_width : panel_width),
        each_height(panels == 1 ? single_height : panel_height),
        font_unit(png ? 0.75 : 1.0) {
    const auto c = static_cast<double>(columns);
    const auto r = static_cast<double>(rows);
    width = left + c * each_width + (c - 1.0) * gap + right;
    height = top + r * each_height + (r - 1.0) * gap + bottom;
  }

  std::size_t columns, rows;
  double each_width, each_height;
  double font_unit;  // pngcairo counts points, svg pixels
  double width = 0.0, height = 0.0;
};

std::string font_text(const Layout& layout, double pixels) {
  return fmt::format("sans-serif,{:.4g}", pixels * layout.font_unit);
}

std::string terminal(bool png, const Layout& layout) {
  constexpr double png_scale = 1.75;
  if (!png) {
    return fmt::format("set terminal svg size {:.0f},{:.0f} font '{}' background '#FFFFFF' enhanced\n", layout.width,
                       layout.height, font_text(layout, Layout::font));
  }
  return fmt::format(
      "set terminal pngcairo size {:.0f},{:.0f} font '{}' fontscale {} linewidth {} pointscale {} background '#FFFFFF' "
      "enhanced\n",
      png_scale * layout.width, png_scale * layout.height, font_text(layout, Layout::font), png_scale, png_scale,
      png_scale);
}

struct ValueRange {
  double low, high;
};

// The readings decide; a curve may rise above them (a mirror spike between two readings) by a factor 20 and no more.
ValueRange value_range(const PlotPlan& plan, double curve_highest) {
  if (plan.log) {
    const double high = std::max(plan.highest, std::min(curve_highest, 20.0 * plan.highest));
    return {0.6 * plan.lowest, 2.0 * high};
  }
  const double high = std::max(plan.highest, std::min(curve_highest, 2.0 * plan.highest));
  const double low = std::min(plan.lowest, 0.0);
  const double span = high > low ? high - low : 1.0;
  return {low < 0.0 ? low - 0.05 * span : 0.0, high + 0.08 * span};
}

std::string measured_block(const Scan& scan, const PlotPlan& plan, std::size_t channel, std::size_t incidence) {
  const PlottedIncidence& group = plan.incidences[incidence];
  std::string out = fmt::format("$m{}_{} << EOD\n", channel, incidence);
  for (std::size_t i = 0; i < group.rows.size(); ++i) {
    const double value = scan.channels[channel].values[group.rows[i]];
    // A line that gnuplot skips keeps a block of negative readings from being empty, which it takes for an error.
    out += plan.log && value <= 0.0 ? std::string("NaN NaN\n")
                                    : fmt::format("{:.7g} {:.7g}\n", group.signed_theta_r_deg[i], value);
  }
  return out + "EOD\n";
}

struct Curve {
  std::vector<double> angles, values;
};

Curve curve_of(const Evaluator& evaluator, const PlotPlan& plan, std::size_t channel, std::size_t incidence) {
  const double theta_i = plan.incidences[incidence].theta_i_deg;
  Curve curve{curve_angles(plan, theta_i, lobe_width_deg(evaluator.material())), {}};
  curve.values.reserve(curve.angles.size());
  for (const double angle : curve.angles) {
    AnglePair pair = in_plane(theta_i, angle);
    pair.phi_i_deg += plan.phi_i_deg.value_or(0.0);
    pair.phi_r_deg += plan.phi_i_deg.value_or(0.0);
    curve.values.push_back(evaluator.value(make_pair(pair), channel));
  }
  return curve;
}

std::string curve_block(const Curve& curve, const ValueRange& range, bool log, std::size_t channel,
                        std::size_t incidence) {
  // Beyond the frame the exact value does not matter, and neither 0 nor 1e300 has a place on a log axis.
  const double low = log ? 1e-2 * range.low : range.low - (range.high - range.low);
  const double high = log ? 1e2 * range.high : range.high + (range.high - range.low);
  std::string out = fmt::format("$f{}_{} << EOD\n", channel, incidence);
  for (std::size_t i = 0; i < curve.angles.size(); ++i) {
    out += fmt::format("{:.5g} {:.5g}\n", curve.angles[i], std::clamp(curve.values[i], low, high));
  }
  return out + "EOD\n";
}

// "0.0854 ± 0.0011", or the value alone.
std::string value_with_uncertainty(const Material& material, const std::string& name, double value) {
  if (!material.fit) return number_text(value);
  const auto found = material.fit->shared_uncertainty.find(name);
  if (found == material.fit->shared_uncertainty.end()) return number_text(value);
  const ValueText pair = value_text(value, found->second);
  return pair.value + " ± " + pair.uncertainty;
}

std::string shape_text(const Material& material) {
  std::string text;
  const auto add = [&](const std::string& label, const std::string& name, const std::optional<double>& value) {
    if (value) text += "   " + label + " = " + value_with_uncertainty(material, name, *value);
  };
  const Surface& s = material.surface;
  add("slope σ/τ", "slope", s.slope);
  add("σ/τ across", "slope_y", s.slope_y);
  add("tail", "tail", s.tail);
  add("facet slope / °", "facet_slope_deg", s.facet_slope_deg);
  for (const auto& [name, value] : material.parameters) add(name, name, value);
  return text;
}

std::string subtitle(const Scan& scan, const Material& material, const PlotPlan& plan) {
  const bool peer = material.model != surface_model;
  std::string text = peer ? material.model : effects_text(material.components, " + ");
  text += shape_text(material);
  if (material.fit) text += fmt::format("   RMS {:.3g} sr⁻¹", material.fit->rms);
  if (plan.channels.size() < scan.channels.size()) {
    text += fmt::format("   {} of {} channels", plan.channels.size(), scan.channels.size());
  }
  return text;
}

std::string frame_commands(const Layout& layout, const PlotPlan& plan, const ValueRange& range) {
  std::string out = fmt::format("set xrange [{:.6g}:{:.6g}]\nset yrange [{:.6g}:{:.6g}]\n", plan.theta_min_deg,
                                plan.theta_max_deg, range.low, range.high);
  out += fmt::format("set xtics {} nomirror out\nset mxtics {}\nset ytics nomirror out\n",
                     plan.theta_max_deg - plan.theta_min_deg > 100.0 || layout.columns > 2 ? 30 : 15, 3);
  out +=
      "set border 3 lc rgb '#404040'\nset grid xtics ytics lc rgb '#D0D0D0' lw 1 dt solid\nset tics textcolor rgb "
      "'#202020'\n";
  // Beyond four decades every second one is labelled, or they would touch.
  if (plan.log) {
    const double decades = std::log10(range.high / range.low);
    out += "set logscale y\n" + fmt::format("set format y '10^{{%T}}'\nset ytics {}\n", decades > 6.0 ? 100 : 10);
    out += decades > 6.0 ? "set mytics default\n" : "set mytics 10\n";
  }
  return out;
}

std::string key_commands(const Layout& layout, const PlotPlan& plan) {
  const double x = (layout.width - Layout::right + 14.0) / layout.width;
  const double y = 1.0 - Layout::top / layout.height;
  std::string out = fmt::format(
      "set key at screen {:.5f},{:.5f} left top vertical Left reverse noenhanced samplen 2.2 spacing 1.25\n", x, y);
  out += "plot keyentry with points lc rgb '#606060' pt 7 ps 0.6 title 'measured'";
  out += ", keyentry with lines lc rgb '#606060' lw 1.5 title 'fitted'";
  for (std::size_t i = 0; i < plan.incidences.size(); ++i) {
    const CurveStyle& style = styles[i % styles.size()];
    out += fmt::format(", keyentry with linespoints lc rgb '{}' lw 1.5 pt {} ps 0.6 title {}", style.color, style.mark,
                       gnuplot_quoted("θᵢ = " + angle_text(plan.incidences[i].theta_i_deg) + "°"));
  }
  return out;
}

// Dense scans (one reading a degree) get small marks, sparse ones large ones.
double mark_size(const PlotPlan& plan) {
  std::size_t most = 0;
  for (const PlottedIncidence& group : plan.incidences) most = std::max(most, group.rows.size());
  return most > 100 ? 0.3 : most > 50 ? 0.42 : 0.6;
}

std::string panel_commands(const Layout& layout, const PlotPlan& plan, const Scan& scan, std::size_t panel) {
  const std::size_t row = panel / layout.columns;
  const std::size_t column = panel % layout.columns;
  const double x0 = Layout::left + static_cast<double>(column) * (layout.each_width + Layout::gap);
  const double y0 = Layout::top + static_cast<double>(row) * (layout.each_height + Layout::gap);
  std::string out = fmt::format(
      "set lmargin at screen {:.5f}\nset rmargin at screen {:.5f}\nset tmargin at screen {:.5f}\nset bmargin at screen "
      "{:.5f}\n",
      x0 / layout.width, (x0 + layout.each_width) / layout.width, 1.0 - y0 / layout.height,
      1.0 - (y0 + layout.each_height) / layout.height);
  const bool lowest = panel + layout.columns >= plan.channels.size();
  out += lowest ? "set format x '%h'\n" : "set format x ''\n";
  if (column > 0) out += "set format y ''\n";
  const std::size_t channel = plan.channels[panel];
  out += fmt::format("set label 1 {} at graph 0.03,0.95 left noenhanced font '{}' front\n",
                     gnuplot_quoted(scan.channels[channel].name), font_text(layout, Layout::panel_font));
  // The key is drawn with the first panel, and is nothing but its entries; the panel's own curves have none.
  out += panel == 0 ? key_commands(layout, plan) : std::string("plot ");
  for (std::size_t i = 0; i < plan.incidences.size(); ++i) {
    out += fmt::format("{}$f{}_{} using 1:2 with lines lc rgb '{}' lw 1.5 notitle", i == 0 && panel > 0 ? "" : ", ",
                       channel, i, styles[i % styles.size()].color);
  }
  // The readings above every curve.
  for (std::size_t i = 0; i < plan.incidences.size(); ++i) {
    const CurveStyle& style = styles[i % styles.size()];
    out += fmt::format(", $m{}_{} using 1:2 with points lc rgb '{}' lw 1.2 pt {} ps {} notitle", channel, i,
                       style.color, style.mark, mark_size(plan));
  }
  return out + "\nunset label 1\n";
}

std::string text_commands(const Layout& layout, const PlotPlan& plan, const Scan& scan, const Material& material) {
  const double middle = (Layout::left + 0.5 * (layout.width - Layout::left - Layout::right)) / layout.width;
  const auto y = [&layout](double from_top) { return 1.0 - from_top / layout.height; };
  const std::string name = material.name.empty() ? scan.name : material.name;
  std::string out = fmt::format("set label 11 {} at screen {:.5f},{:.5f} center noenhanced font '{}'\n",
                                gnuplot_quoted(name), middle, y(16.0), font_text(layout, Layout::title_font));
  out += fmt::format("set label 12 {} at screen {:.5f},{:.5f} center noenhanced textcolor rgb '#505050'\n",
                     gnuplot_quoted(subtitle(scan, material, plan)), middle, y(36.0));
  out += fmt::format("set label 13 {} at screen {:.5f},{:.5f} center noenhanced font '{}' textcolor rgb '#606060'\n",
                     gnuplot_quoted(plot_remarks(plan)), middle, y(54.0), font_text(layout, Layout::small_font));
  out += fmt::format("set label 14 'θᵣ (degrees; positive = forward)' at screen {:.5f},{:.5f} center noenhanced\n",
                     middle, y(layout.height - 14.0));
  out += fmt::format("set label 15 'BRDF (sr⁻¹)' at screen {:.5f},{:.5f} center rotate by 90 noenhanced\n",
                     16.0 / layout.width, y(Layout::top + 0.5 * (layout.height - Layout::top - Layout::bottom)));
  return out;
}

std::string script_of(bool png, const Scan& scan, const Material& material, const PlotPlan& plan) {
  const Layout layout(plan.channels.size(), png);
  const Evaluator evaluator(material);
  std::vector<Curve> curves;
  double highest = 0.0;
  for (const std::size_t channel : plan.channels) {
    for (std::size_t i = 0; i < plan.incidences.size(); ++i) {
      curves.push_back(curve_of(evaluator, plan, channel, i));
      highest = std::max(highest, *std::max_element(curves.back().values.begin(), curves.back().values.end()));
    }
  }
  const ValueRange range = value_range(plan, highest);
  std::string script = "set encoding utf8\n" + terminal(png, layout);
  auto curve = curves.cbegin();
  for (const std::size_t channel : plan.channels) {
    for (std::size_t i = 0; i < plan.incidences.size(); ++i) {
      script += measured_block(scan, plan, channel, i) + curve_block(*curve++, range, plan.log, channel, i);
    }
  }
  script += "set datafile missing 'NaN'\nset multiplot\n";
  for (std::size_t panel = 0; panel < plan.channels.size(); ++panel) {
    script += frame_commands(layout, plan, range);
    if (panel == 0) script += text_commands(layout, plan, scan, material);
    script += panel_commands(layout, plan, scan, panel);
    if (panel == 0)
      script += "unset label 11\nunset label 12\nunset label 13\nunset label 14\nunset label 15\nunset key\n";
  }
  return script + "unset multiplot\n";
}

}  // namespace

void check_plot(const std::filesystem::path& path, const Scan& scan, const PlotOptions& options) {
  static_cast<void>(is_png(path));
  static_cast<void>(plan_plot(scan, options));
}

void plot_fit(const std::filesystem::path& path, const Scan& scan, const Material& material,
              const PlotOptions& options) {
  const bool png = is_png(path);
  if (material.channels.size() != scan.channels.size()) {
    throw usage_error(fmt::format("the material has {} channels and the scan {}: they cannot be drawn together",
                                  material.channels.size(), scan.channels.size()));
  }
  // What an anisotropic material does at one azimuth says nothing of the readings at another.
  const bool anisotropic = scan.size() > 0 && is_anisotropic(Evaluator(material));
  const Scan shown = anisotropic ? at_azimuth(scan, scan.phi_i_deg.front()) : scan;
  PlotPlan plan = plan_plot(shown, options);
  if (anisotropic) plan.phi_i_deg = scan.phi_i_deg.front();
  const std::string script = script_of(png, shown, material, plan);
  write_file_with(path, [&script](const std::filesystem::path& temporary) { run_gnuplot(script, temporary); });
}

}  // namespace goniofit
