// Coverages of a verify run, drawn by gnuplot.

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "report/gnuplot.h"
#include "report/verify_report.h"
#include "support/error.h"
#include "support/output_file.h"

namespace goniofit {
namespace {

// Pixels of the SVG; the PNG has the same layout at a finer scale.
constexpr double panel_width = 380.0, row_height = 20.0, top = 62.0, bottom = 56.0, gap = 26.0, right = 18.0;
constexpr double letter = 7.4, font = 13.0, small_font = 11.5;
/// Channels that one row has place for; a parameter of more gets a higher row.
constexpr double dots_in_a_row = 6.0;

/// One parameter of one recipe, its channels from the top down.
struct Row {
  std::string label;
  std::vector<const Recovery*> channels;
  double y = 0.0;       ///< centre, in rows from the top
  double height = 1.0;  ///< in rows
};

struct Group {
  const VerifyReport* report;
  double y = 0.0, end = 0.0;  ///< its heading, and the end of its last row
  std::vector<Row> rows;
};

struct Panel {
  Bound bound;
  Proportion Recovery::*coverage;
  std::optional<std::pair<double, double>> VerifySettings::*allowed;
  double nominal;
  const char* title;
};

const std::array<Panel, 2> panels{{
    {Bound::coverage_68, &Recovery::coverage_68, &VerifySettings::coverage_68, 68.27, "truth in the 68 % interval / %"},
    {Bound::coverage_95, &Recovery::coverage_95, &VerifySettings::coverage_95, 95.0, "truth in the 95 % interval / %"},
}};

Group group_of(const VerifyReport& report, double& y) {
  Group group{&report, y + 0.5, 0.0, {}};
  y += 1.0;
  for (const Recovery& r : report.parameters) {
    if (r.coverage_68.of == 0 && r.coverage_95.of == 0) continue;
    const std::size_t dot = r.parameter.find('.');
    const std::string label = dot == std::string::npos ? r.parameter : r.parameter.substr(dot + 1);
    auto row =
        std::find_if(group.rows.begin(), group.rows.end(), [&](const Row& known) { return known.label == label; });
    if (row == group.rows.end()) row = group.rows.insert(group.rows.end(), {label, {}});
    row->channels.push_back(&r);
  }
  for (Row& row : group.rows) {
    row.height = std::max(1.0, static_cast<double>(row.channels.size()) / dots_in_a_row);
    row.y = y + 0.5 * row.height;
    y += row.height;
  }
  group.end = y;
  y += 0.4;
  return group;
}

struct Points {
  std::string text;                      ///< x y low high missed
  double lowest = 100.0, highest = 0.0;  ///< of the limits, in %
};

Points points_of(const std::vector<Group>& groups, const Panel& panel) {
  Points points;
  for (const Group& group : groups) {
    for (const Row& row : group.rows) {
      const auto count = static_cast<double>(row.channels.size());
      for (std::size_t c = 0; c < row.channels.size(); ++c) {
        const Recovery& r = *row.channels[c];
        const Proportion coverage = r.*panel.coverage;
        if (coverage.of == 0) continue;
        const Interval limits = exact_limits(coverage);
        const double y = row.y + 0.8 * row.height * ((static_cast<double>(c) + 0.5) / count - 0.5);
        points.text +=
            fmt::format("{:.6g} {:.6g} {:.6g} {:.6g} {}\n", 100.0 * coverage.fraction(), y, 100.0 * limits.lower,
                        100.0 * limits.upper, group.report->is_missed(r.parameter, panel.bound) ? 1 : 0);
        points.lowest = std::min(points.lowest, 100.0 * limits.lower);
        points.highest = std::max(points.highest, 100.0 * limits.upper);
      }
    }
  }
  return points;
}

struct Layout {
  Layout(const std::vector<Group>& groups, bool png) : font_unit(png ? 0.75 : 1.0) {
    std::size_t longest = 0;
    for (const Group& group : groups) {
      longest = std::max(longest, group.report->name.size());
      for (const Row& row : group.rows) longest = std::max(longest, row_label(row).size() + 2);
    }
    left = letter * static_cast<double>(longest) + 16.0;
    rows = groups.back().end + 0.4;
    width = left + 2.0 * panel_width + gap + right;
    height = top + row_height * rows + bottom;
  }
  static std::string row_label(const Row& row) {
    const bool crowded = static_cast<double>(row.channels.size()) > dots_in_a_row;
    return crowded ? fmt::format("{} of {} channels", row.label, row.channels.size()) : row.label;
  }
  [[nodiscard]] double x(double pixels) const { return pixels / width; }
  [[nodiscard]] double y(double pixels_from_top) const { return 1.0 - pixels_from_top / height; }
  [[nodiscard]] std::string font_text(double size) const { return fmt::format("sans-serif,{:.3g}", size * font_unit); }

  double font_unit, left = 0.0, rows = 0.0, width = 0.0, height = 0.0;
};

std::string terminal(const Layout& layout, bool png) {
  const double scale = png ? 1.5 : 1.0;
  return fmt::format("set terminal {} size {:.0f},{:.0f} {}font '{}' background '#FFFFFF'\n", png ? "pngcairo" : "svg",
                     scale * layout.width, scale * layout.height, png ? "fontscale 1.5 linewidth 1.5 " : "",
                     layout.font_text(font));
}

// What each recipe allows, and a line where its rows begin.
std::string bands(const std::vector<Group>& groups, const Panel& panel) {
  std::string out = "unset object\n";
  for (const Group& group : groups) {
    const auto& allowed = group.report->settings.*panel.allowed;
    if (!allowed || group.rows.empty()) continue;
    out += fmt::format("set object rectangle from {:.6g},{:.6g} to {:.6g},{:.6g} behind fc rgb '#D3E8DA' fs noborder\n",
                       100.0 * allowed->first, group.y + 0.5, 100.0 * allowed->second, group.end);
  }
  return out;
}

std::string names(const std::vector<Group>& groups, const Layout& layout) {
  std::string out;
  std::string tics;
  for (const Group& group : groups) {
    out += fmt::format("set label {} at screen {:.5f}, first {:.6g} left noenhanced\n",
                       gnuplot_quoted(group.report->name), layout.x(8.0), group.y + 0.1);
    for (const Row& row : group.rows) {
      tics += fmt::format("{}{} {:.6g}", tics.empty() ? "" : ", ", gnuplot_quoted(Layout::row_label(row)), row.y);
    }
  }
  return out + "set ytics (" + tics + ") nomirror noenhanced scale 0 textcolor rgb '#505050' font '" +
         layout.font_text(small_font) + "'\n";
}

std::string heading(const VerifyRunReport& run, const Layout& layout) {
  std::size_t least = run.recipes.front().trials;
  std::size_t most = least;
  for (const VerifyReport& report : run.recipes) {
    least = std::min(least, report.trials);
    most = std::max(most, report.trials);
  }
  const std::string trials = least == most ? fmt::format("{}", most) : fmt::format("{} to {}", least, most);
  const double middle = layout.x(layout.left + panel_width + 0.5 * gap);
  std::string out = fmt::format(
      "set label 'How often stated intervals hold the truth, {} simulated scans each' at screen "
      "{:.5f},{:.5f} center noenhanced font '{}'\n",
      trials, middle, layout.y(20.0), layout.font_text(16.0));
  return out + fmt::format(
                   "set label 'bars: exact 95 % limits; green: allowed; orange: missed ({} of {} tests, all "
                   "together at {:g} %); one bar a channel' at screen {:.5f},{:.5f} center noenhanced font '{}' "
                   "textcolor rgb '#606060'\n",
                   run.missed(), run.tests(), 100.0 * run.level, middle, layout.y(44.0), layout.font_text(small_font));
}

std::string panel_commands(const std::vector<Group>& groups, const Panel& panel, const Points& points,
                           const Layout& layout, std::size_t index) {
  const double x0 = layout.left + static_cast<double>(index) * (panel_width + gap);
  std::string out = fmt::format("set lmargin at screen {:.5f}\nset rmargin at screen {:.5f}\n", layout.x(x0),
                                layout.x(x0 + panel_width));
  const double low = std::max(0.0, std::min(points.lowest, panel.nominal - 6.0) - 1.0);
  const double high = std::min(100.0, std::max(points.highest, panel.nominal + 5.0) + 1.0);
  out += fmt::format("set xrange [{:.6g}:{:.6g}]\nset xlabel '{}' noenhanced\n", low, high, panel.title);
  out += "unset arrow\n" +
         fmt::format("set arrow from {0:.6g}, graph 0 to {0:.6g}, graph 1 nohead back lc rgb '#808080' dt 2\n",
                     panel.nominal);
  out += bands(groups, panel);
  if (index > 0) out += "unset label\nunset ytics\n";
  for (const char* const color : {"#0072B2", "#D55E00"}) {
    const int missed = color == std::string_view("#D55E00") ? 1 : 0;
    out += fmt::format(
        "{} $points{} using 1:($5 == {} ? $2 : 1/0):3:4 with xerrorbars lc rgb '{}' lw 1.3 pt 7 ps 0.5 "
        "notitle",
        missed == 0 ? "plot" : ",", index, missed, color);
  }
  return out + '\n';
}

}  // namespace

void plot_verify(const std::filesystem::path& path, const VerifyRunReport& run) {
  const bool png = is_png(path);
  std::vector<Group> groups;
  double y = 0.0;
  for (const VerifyReport& report : run.recipes) groups.push_back(group_of(report, y));
  const bool nothing = std::all_of(groups.begin(), groups.end(), [](const Group& g) { return g.rows.empty(); });
  if (nothing) throw usage_error(path.string() + ": no recipe states an interval, so there is no coverage to draw");

  const Layout layout(groups, png);
  std::string script = "set encoding utf8\n" + terminal(layout, png);
  std::array<Points, panels.size()> points;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    points[i] = points_of(groups, panels[i]);
    script += fmt::format("$points{} << EOD\n{}EOD\n", i, points[i].text);
  }
  script += fmt::format("set multiplot\nset tmargin at screen {:.5f}\nset bmargin at screen {:.5f}\n", layout.y(top),
                        layout.y(layout.height - bottom));
  script += fmt::format("set yrange [{:.6g}:0]\nset border 3 lc rgb '#808080'\nset bars 0\nunset key\n", layout.rows);
  script += "set xtics nomirror out\nset grid xtics lc rgb '#E4E4E4' dt solid lw 0.7\n";
  script += names(groups, layout) + heading(run, layout);
  for (std::size_t i = 0; i < panels.size(); ++i) script += panel_commands(groups, panels[i], points[i], layout, i);
  script += "unset multiplot\n";
  write_file_with(path, [&script](const std::filesystem::path& temporary) { run_gnuplot(script, temporary); });
}

}  // namespace goniofit
