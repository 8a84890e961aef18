// Error against time, drawn by gnuplot.

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "cost/candidate.h"
#include "report/gnuplot.h"
#include "report/label_placement.h"
#include "report/plot_page.h"
#include "report/tradeoff_report.h"
#include "support/error.h"
#include "support/output_file.h"

namespace goniofit {
namespace {

using Rows = std::vector<const TradeoffRow*>;

constexpr double least_error = 1e-8;  // what is below stands on the axis
constexpr double label_pixels = 11.0;
constexpr const char* front_color = "#0072B2";
constexpr const char* other_color = "#707070";

struct ValueRange {
  double low, high;
};

double error_of(const TradeoffRow& row) { return std::max(row.error.l1, least_error); }

// Panels of one group: models where there are any.
std::vector<Rows> panels_of(const Tradeoff& t) {
  std::vector<Rows> panels;
  if (t.rows.empty()) return panels;
  const bool any_models =
      std::any_of(t.rows.begin(), t.rows.end(), [](const TradeoffRow& r) { return r.group == TradeoffGroup::model; });
  const TradeoffGroup group = any_models ? TradeoffGroup::model : t.rows.front().group;
  for (const TradeoffRow& row : t.rows) {
    if (row.group != group || row.arithmetic == name_of(Arithmetic::scalar)) continue;
    if (panels.empty() || panels.back().front()->material != row.material) panels.emplace_back();
    panels.back().push_back(&row);
  }
  // The front first: its labels find their places before the others'.
  for (Rows& rows : panels) {
    std::stable_sort(rows.begin(), rows.end(), [](const TradeoffRow* a, const TradeoffRow* b) {
      if (a->pareto != b->pareto) return a->pareto;
      return a->time.median_ns < b->time.median_ns;
    });
  }
  return panels;
}

// The same axes in all panels, whole decades of error.
ValueRange time_range(const std::vector<Rows>& panels) {
  ValueRange r{1e300, 0.0};
  for (const Rows& rows : panels) {
    for (const TradeoffRow* row : rows) {
      r.low = std::min(r.low, row->time.median_ns);
      r.high = std::max(r.high, row->time.median_ns);
    }
  }
  return {r.low / 1.6, r.high * 2.0};
}
ValueRange error_range(const std::vector<Rows>& panels) {
  double low = 1.0;
  double high = 0.0;
  for (const Rows& rows : panels) {
    for (const TradeoffRow* row : rows) {
      low = std::min(low, error_of(*row));
      high = std::max(high, error_of(*row));
    }
  }
  return {low / 3.0, 3.0 * std::max(high, 10.0 * low)};
}

struct Axes {
  ValueRange ns, error;
  double width, height;
  [[nodiscard]] double x(double value) const { return width * std::log(value / ns.low) / std::log(ns.high / ns.low); }
  [[nodiscard]] double y(double value) const {
    return height * (1.0 - std::log(value / error.low) / std::log(error.high / error.low));
  }
};

// Of a sans-serif font, in parts of its size; a little too wide rather than too narrow.
double label_width(const std::string& text) {
  double width = 0.0;
  for (const char c : text) {
    const std::string_view narrow = "filrtj1,.- ";
    width += c == 'm' || c == 'w' ? 1.0 : narrow.find(c) != std::string_view::npos ? 0.42 : 0.66;
  }
  return label_pixels * width;
}

// The line through the front as small boxes along it.
std::vector<LabelBox> line_boxes(const Rows& rows, const Axes& axes) {
  constexpr double step = 4.0;
  std::vector<LabelBox> boxes;
  for (std::size_t i = 0; i + 1 < rows.size() && rows[i + 1]->pareto; ++i) {
    const double x = axes.x(rows[i]->time.median_ns);
    const double y = axes.y(error_of(*rows[i]));
    const double dx = axes.x(rows[i + 1]->time.median_ns) - x;
    const double dy = axes.y(error_of(*rows[i + 1])) - y;
    const double count = std::ceil(std::hypot(dx, dy) / step);
    for (double k = 0.0; k < count; ++k) {
      const double at = k / count;
      boxes.push_back({x + at * dx - 1.5, y + at * dy - 1.5, x + at * dx + 1.5, y + at * dy + 1.5});
    }
  }
  return boxes;
}

std::string labels(const Rows& rows, const Axes& axes, const PlotPage& page) {
  std::vector<LabelledPoint> points;
  for (const TradeoffRow* row : rows) {
    points.push_back(
        {axes.x(row->time.median_ns), axes.y(error_of(*row)), label_width(row->name), 1.15 * label_pixels});
  }
  const std::vector<std::optional<PlacedLabel>> placed =
      place_labels(points, {2.0, 2.0, axes.width - 2.0, axes.height - 2.0}, line_boxes(rows, axes));
  std::string out;
  const auto graph = [&](double x, double y) {
    return fmt::format("graph {:.5f}, graph {:.5f}", x / axes.width, 1.0 - y / axes.height);
  };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!placed[i]) continue;
    const LabelBox& b = placed[i]->box;
    const char* const color = rows[i]->pareto ? front_color : "#404040";
    out += fmt::format("set label {} {} at {} center noenhanced font '{}' textcolor rgb '{}'\n", 100 + i,
                       gnuplot_quoted(rows[i]->name), graph(0.5 * (b.left + b.right), 0.5 * (b.top + b.bottom)),
                       page.font(label_pixels), color);
    if (!placed[i]->led) continue;
    const double x = std::clamp(points[i].x, b.left, b.right);
    const double y = std::clamp(points[i].y, b.top, b.bottom);
    out += fmt::format("set arrow from {} to {} nohead lc rgb '#C0C0C0' lw 0.7 back\n", graph(points[i].x, points[i].y),
                       graph(x, y));
  }
  return out;
}

std::string data_of(const Rows& rows, std::size_t panel) {
  std::string front;
  std::string others;
  for (const TradeoffRow* row : rows) {
    (row->pareto ? front : others) += fmt::format("{:.6g} {:.6g}\n", row->time.median_ns, error_of(*row));
  }
  return fmt::format("$front{0} << EOD\n{1}EOD\n$others{0} << EOD\n{2}EOD\n", panel, front,
                     others.empty() ? "1e-99 1e-99\n" : others);
}

std::string panel_commands(const PanelGrid& grid, const PlotPage& page, const Axes& axes, const Rows& rows,
                           std::size_t panel) {
  std::string out = "unset label\nunset arrow\n";
  out += page.margins(grid.x(panel), grid.y(panel), grid.panel_width, grid.panel_height);
  out += page.label(1, rows.front()->material, grid.x(panel), grid.y(panel) - 12.0,
                    fmt::format("left font '{}'", page.font(13.5)));
  out += labels(rows, axes, page);
  out += fmt::format("set xrange [{:.6g}:{:.6g}]\nset yrange [{:.6g}:{:.6g}]\n", axes.ns.low, axes.ns.high,
                     axes.error.low, axes.error.high);
  out += panel + grid.columns >= grid.panels ? "set xlabel 'ns per evaluation' noenhanced\n" : "unset xlabel\n";
  out += panel % grid.columns == 0 ? "set ylabel 'L1 error' noenhanced\n" : "unset ylabel\n";
  return out + fmt::format(
                   "plot $front{0} using 1:2 with lines lc rgb '{1}' lw 1.4, $others{0} using 1:2 with points pt 7 ps "
                   "0.45 lc rgb '{2}', $front{0} using 1:2 with points pt 7 ps 0.7 lc rgb '{1}'\n",
                   panel, front_color, other_color);
}

std::string page_texts(const PlotPage& page, const Tradeoff& t, const TradeoffRow& any) {
  const bool models = any.group == TradeoffGroup::model;
  std::string out = page.label(
      11, models ? "What accuracy costs in time" : "What accuracy costs in time: " + std::string(name_of(any.group)),
      0.5 * page.width, 20.0, fmt::format("center font '{}'", page.font(17.0)));
  const std::string text =
      fmt::format("L1 error against {} (below 1e-8: on the axis); blue: nothing is both faster and nearer; {}, {}",
                  models ? t.reference : any.reference, t.machine, name_of(t.instructions));
  return out + page.label(12, text, 0.5 * page.width, 42.0,
                          fmt::format("center font '{}' textcolor rgb '#606060'", page.font(11.5)));
}

}  // namespace

void plot_tradeoff(const std::filesystem::path& path, const Tradeoff& tradeoff) {
  const bool png = is_png(path);
  const std::vector<Rows> panels = panels_of(tradeoff);
  if (panels.empty()) throw usage_error(path.string() + ": there is nothing to draw");
  const PanelGrid grid{.panels = panels.size(),
                       .columns = panels.size() > 1 ? std::size_t{2} : std::size_t{1},
                       .panel_width = 600.0,
                       .panel_height = 480.0,
                       .gap_x = 64.0,
                       .gap_y = 74.0,
                       .left = 84.0,
                       .top = 88.0,
                       .right = 24.0,
                       .bottom = 60.0};
  const PlotPage page = grid.page(png);
  const Axes axes{time_range(panels), error_range(panels), grid.panel_width, grid.panel_height};
  std::string script = page.terminal();
  for (std::size_t i = 0; i < panels.size(); ++i) script += data_of(panels[i], i);
  script +=
      "set border 3\nunset key\nset logscale xy\nset format y '10^{%T}'\nset xtics nomirror out\nset ytics nomirror "
      "out\n"
      "set grid lc rgb '#E8E8E8' lt 1 lw 0.5\nset multiplot\n";
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const std::string commands = panel_commands(grid, page, axes, panels[i], i);
    const std::size_t plot = commands.rfind("plot ");
    script += i > 0 ? commands
                    : commands.substr(0, plot) + page_texts(page, tradeoff, *panels[0].front()) + commands.substr(plot);
  }
  script += "unset multiplot\n";
  write_file_with(path, [&script](const std::filesystem::path& temporary) { run_gnuplot(script, temporary); });
}

}  // namespace goniofit
