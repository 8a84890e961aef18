#include "report/residual_plot.h"
#include "report/number_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "geometry/angles.h"
#include "report/gnuplot.h"
#include "report/plot_page.h"
#include "report/residual_plan.h"
#include "support/output_file.h"

namespace goniofit {
namespace {

// Okabe and Ito's, as in the plot of the fit.
constexpr std::array<const char*, 3> colors{"#D55E00", "#009E73", "#0072B2"};
constexpr std::array<int, 3> marks{5, 9, 7};

/// Of the map: the horizon lies at 1.
double map_radius(double theta_deg) { return std::sqrt(2.0) * sin_deg(0.5 * theta_deg); }

struct MapPoint {
  double x, y;
};
// From above, azimuths counter-clockwise; forward, where the mirror direction is, to the right.
MapPoint map_point(const AnglePair& a) {
  const double phi = a.phi_r_deg - a.phi_i_deg;
  const double r = map_radius(a.theta_r_deg);
  return {-r * cos_deg(phi), -r * sin_deg(phi)};
}

std::string panel_title(const ResidualPanel& panel) {
  const std::string low = angle_text(panel.theta_i_deg);
  const std::string high = angle_text(panel.theta_i_high_deg);
  return "θᵢ = " + (low == high ? low : low + " – " + high) + "°";
}

std::string unit_text(const ResidualPlan& plan) {
  return plan.by_u ? "(measured − fitted) / u" : "(measured − fitted) / the larger of them";
}

// As the label of a tic, which gnuplot takes for a format.
std::string scale_text(const ResidualPlan& plan, double value) {
  return plan.by_u ? fmt::format("{:+.3g}", value) : fmt::format("{:+.3g} %%", 100.0 * value);
}

// What a reader must know to read the picture.
std::string remarks(const ResidualPlan& plan, const Scan& scan) {
  std::string text = unit_text(plan);
  if (!plan.by_u) text += fmt::format(", or / {:.2g} sr⁻¹ where both are less", plan.floor);
  std::size_t readings = 0;
  for (const ResidualPanel& panel : plan.panels) readings += panel.rows.size();
  text += fmt::format("; {} of {} beyond the scale", plan.beyond, readings * plan.channels.size());
  if (plan.channels.size() < scan.channels.size())
    text +=
        fmt::format("; channel {}, the worst of {}", scan.channels[plan.channels.front()].name, scan.channels.size());
  if (plan.panels.size() < plan.incidences)
    text += fmt::format("; {} panels of {} incidence angles", plan.panels.size(), plan.incidences);
  return text;
}

std::string page_texts(const PlotPage& page, const ResidualPlan& plan, const Scan& scan, const FitResult& result) {
  const std::string& name = result.material.name.empty() ? scan.name : result.material.name;
  return page.label(11, name + ": residuals", 0.5 * page.width, 18.0,
                    fmt::format("center font '{}'", page.font(16.0))) +
         page.label(12, remarks(plan, scan), 0.5 * page.width, 39.0,
                    fmt::format("center font '{}' textcolor rgb '#606060'", page.font(11.5)));
}

// Circles that just touch where the readings are spread evenly over the hemisphere.
double mark_radius(const ResidualPanel& panel) {
  const double spread = 0.98 / std::sqrt(static_cast<double>(std::max<std::size_t>(panel.rows.size(), 1)));
  return std::clamp(spread, 0.012, 0.07);
}

std::string map_data(const Scan& scan, const ResidualPlan& plan, std::size_t panel) {
  std::string below;
  std::string out = fmt::format("$r{} << EOD\n", panel);
  for (const std::size_t row : plan.panels[panel].rows) {
    const double value = std::clamp(plan.values.front()[row], -plan.limit, plan.limit);
    const MapPoint at = map_point(scan.angles(row));
    out += fmt::format("{:.5f} {:.5f} {:.6g}\n", at.x, at.y, value);
    // What is nearly white has no sign to speak of.
    if (value < -0.1 * plan.limit) below += fmt::format("{:.5f} {:.5f}\n", at.x, at.y);
  }
  return out + "EOD\n" + fmt::format("$b{} << EOD\n{}NaN NaN\nEOD\n", panel, below);
}

std::string map_panel(const PanelGrid& grid, const PlotPage& page, const ResidualPlan& plan, std::size_t panel) {
  const ResidualPanel& shown = plan.panels[panel];
  std::string out = "unset label\nunset object\n";
  out += page.margins(grid.x(panel), grid.y(panel), grid.panel_width, grid.panel_height);
  out += page.label(1, panel_title(shown), grid.x(panel), grid.y(panel) - 2.0,
                    fmt::format("left font '{}'", page.font(13.0)));
  for (const double theta : {30.0, 60.0, 90.0}) {
    out += fmt::format("set object circle at 0,0 size first {:.5f} fs empty border rgb '{}' lw 1 {}\n",
                       map_radius(theta), theta == 90.0 ? "#606060" : "#B0B0B0", theta == 90.0 ? "back" : "front");
  }
  const double radius = mark_radius(shown);
  const double mirror = map_radius(0.5 * (shown.theta_i_deg + shown.theta_i_high_deg));
  out += fmt::format(
      "plot $r{0} using 1:2:({1:.4f}):3 with circles lc palette fs solid noborder, "
      "$b{0} using 1:2:({2:.4f}) with circles lc rgb '#000000' fs solid noborder, "
      "'+' using ({3:.4f}):(0) every ::0::0 with points pt 2 ps 1.1 lw 1.6 lc rgb '#000000'\n",
      panel, radius, 0.28 * radius, mirror);
  return out;
}

// A bar of the scale, and what the marks mean.
std::string map_legend(const PlotPage& page, const ResidualPlan& plan) {
  std::string out = fmt::format(
      "set palette defined (-1 '#0B4F8A', -0.5 '#6BAED6', 0 '#FFFFFF', 0.5 '#FDAE61', 1 '#C44E00')\n"
      "set cbrange [{0:.6g}:{1:.6g}]\n"
      "set colorbox horizontal user origin screen {2:.5f},{3:.5f} size screen {4:.5f},{5:.5f}\n"
      "set cbtics ({6} {0:.6g}, {7} {8:.6g}, '0' 0, {9} {10:.6g}, {11} {1:.6g}) scale 0.4\n",
      -plan.limit, plan.limit, 0.5 - 130.0 / page.width, 40.0 / page.height, 260.0 / page.width, 12.0 / page.height,
      gnuplot_quoted(scale_text(plan, -plan.limit)), gnuplot_quoted(scale_text(plan, -0.5 * plan.limit)),
      -0.5 * plan.limit, gnuplot_quoted(scale_text(plan, 0.5 * plan.limit)), 0.5 * plan.limit,
      gnuplot_quoted(scale_text(plan, plan.limit)));
  const std::string small = fmt::format("font '{}' textcolor rgb '#303030'", page.font(11.5));
  const double y = page.height - 45.0;
  out += page.label(13, "measured below fitted (dotted)", 0.5 * page.width - 160.0, y, "right " + small);
  out += page.label(14, "measured above fitted", 0.5 * page.width + 160.0, y, "left " + small);
  out += page.label(15, "the view from above, forward to the right; × mirror direction; rings θᵣ = 30°, 60°, 90°",
                    0.5 * page.width, page.height - 10.0, "center " + small);
  return out;
}

std::string map_script(bool png, const Scan& scan, const ResidualPlan& plan, const FitResult& result) {
  const std::size_t panels = plan.panels.size();
  const PanelGrid grid{
      .panels = panels,
      .columns = panels > 4 || panels == 3 ? 3 : std::max<std::size_t>(std::min<std::size_t>(panels, 2), 1),
      .panel_width = panels == 1 ? 460.0 : 270.0,
      .panel_height = panels == 1 ? 460.0 : 270.0,
      .gap_x = 24.0,
      .gap_y = 26.0,
      .left = panels < 3 ? 120.0 : 24.0,
      .top = 76.0,
      .right = panels < 3 ? 120.0 : 24.0,
      .bottom = 84.0};
  const PlotPage page = grid.page(png);
  std::string script = page.terminal();
  for (std::size_t i = 0; i < panels; ++i) script += map_data(scan, plan, i);
  script +=
      "set datafile missing 'NaN'\nset samples 2\nset xrange [-1.03:1.03]\nset yrange [-1.03:1.03]\nunset "
      "border\nunset "
      "tics\nunset key\nset style circle noclip\nset multiplot\n";
  for (std::size_t i = 0; i < panels; ++i) {
    const std::string commands = map_panel(grid, page, plan, i);
    const std::size_t plot = commands.rfind("plot ");
    script += commands.substr(0, plot);
    script += i == 0 ? page_texts(page, plan, scan, result) + map_legend(page, plan) : "unset colorbox\n";
    script += commands.substr(plot);
  }
  return script + "unset multiplot\n";
}

std::string curve_data(const Scan& scan, const ResidualPlan& plan, std::size_t panel) {
  std::vector<std::size_t> rows = plan.panels[panel].rows;
  std::stable_sort(rows.begin(), rows.end(), [&](std::size_t a, std::size_t b) {
    return scan.signed_theta_r_deg(a) < scan.signed_theta_r_deg(b);
  });
  std::string out;
  for (std::size_t c = 0; c < plan.channels.size(); ++c) {
    std::string beyond;
    out += fmt::format("$r{}_{} << EOD\n", panel, c);
    for (const std::size_t row : rows) {
      const double value = plan.values[c][row];
      const double theta = scan.signed_theta_r_deg(row);
      out += fmt::format("{:.5g} {:.6g}\n", theta, std::clamp(value, -plan.limit, plan.limit));
      if (std::fabs(value) > plan.limit)
        beyond += fmt::format("{:.5g} {:.6g}\n", theta, std::copysign(plan.limit, value));
    }
    out += "EOD\n" + fmt::format("$b{}_{} << EOD\n{}NaN NaN\nEOD\n", panel, c, beyond);
  }
  return out;
}

std::string curve_panel(const PanelGrid& grid, const PlotPage& page, const Scan& scan, const ResidualPlan& plan,
                        std::size_t panel) {
  std::string out = "unset label\nunset arrow\n";
  out += page.margins(grid.x(panel), grid.y(panel), grid.panel_width, grid.panel_height);
  out += page.label(1, panel_title(plan.panels[panel]), grid.x(panel), grid.y(panel) - 9.0,
                    fmt::format("left font '{}'", page.font(13.0)));
  const double mirror = plan.panels[panel].theta_i_deg;
  out += fmt::format(
      "set arrow from first {0:.4g}, graph 0 to first {0:.4g}, graph 1 nohead back lc rgb '#B0B0B0' dt 2\n", mirror);
  out += "set arrow from graph 0, first 0 to graph 1, first 0 nohead back lc rgb '#404040'\n";
  out += panel + grid.columns >= grid.panels ? "set format x '%h'\n" : "set format x ''\n";
  std::string tics;
  for (const double part : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
    const std::string text = panel % grid.columns > 0 ? "" : part == 0.0 ? "0" : scale_text(plan, part * plan.limit);
    tics += fmt::format("{}{} {:.6g}", tics.empty() ? "" : ", ", gnuplot_quoted(text), part * plan.limit);
  }
  out += "set ytics (" + tics + ") nomirror out\nplot ";
  for (std::size_t c = 0; c < plan.channels.size(); ++c) {
    // More than one channel has its name in a key.
    const std::string name = plan.channels.size() > 1 && panel == 0
                                 ? "title " + gnuplot_quoted(scan.channels[plan.channels[c]].name)
                                 : std::string("notitle");
    out += fmt::format(
        "{0}$r{1}_{2} using 1:2 with linespoints lc rgb '{3}' lw 0.8 pt {4} ps 0.4 {5}, $b{1}_{2} using "
        "1:2 with points pt 2 ps 0.8 lw 1.4 lc rgb '{3}' notitle",
        c > 0 ? ", " : "", panel, c, colors[c], marks[c], name);
  }
  return out + "\n";
}

std::string curve_script(bool png, const Scan& scan, const ResidualPlan& plan, const FitResult& result) {
  const std::size_t panels = plan.panels.size();
  const PanelGrid grid{
      .panels = panels,
      .columns = panels > 4 || panels == 3 ? 3 : std::max<std::size_t>(std::min<std::size_t>(panels, 2), 1),
      .panel_width = panels == 1 ? 640.0 : 300.0,
      .panel_height = panels == 1 ? 320.0 : 150.0,
      .gap_x = 20.0,
      .gap_y = 36.0,
      .left = 84.0,
      .top = 82.0,
      .right = 24.0,
      .bottom = 58.0};
  const PlotPage page = grid.page(png);
  std::string script = page.terminal();
  for (std::size_t i = 0; i < panels; ++i) script += curve_data(scan, plan, i);
  script += fmt::format(
      "set datafile missing 'NaN'\nset xrange [-90:90]\nset yrange [{:.6g}:{:.6g}]\nset xtics -60,60,60 nomirror "
      "out\nset "
      "border 3 lc rgb '#404040'\nset key at screen {:.5f},{:.5f} right horizontal noenhanced samplen 1.5\nset "
      "multiplot\n",
      -1.12 * plan.limit, 1.12 * plan.limit, 1.0 - 20.0 / page.width, 1.0 - 58.0 / page.height);
  for (std::size_t i = 0; i < panels; ++i) {
    const std::string commands = curve_panel(grid, page, scan, plan, i);
    const std::size_t plot = commands.rfind("plot ");
    script += commands.substr(0, plot);
    if (i == 0) {
      script += page_texts(page, plan, scan, result) +
                page.label(13, "θᵣ (degrees; positive = forward; dashed: mirror direction; × beyond the scale)",
                           0.5 * page.width, page.height - 14.0, "center");
    }
    script += commands.substr(plot);
  }
  return script + "unset multiplot\n";
}

}  // namespace

void plot_residuals(const std::filesystem::path& path, const Scan& scan, const FitResult& result) {
  const bool png = is_png(path);
  const ResidualPlan plan = plan_residuals(scan, result);
  const std::string script = plan.map ? map_script(png, scan, plan, result) : curve_script(png, scan, plan, result);
  write_file_with(path, [&script](const std::filesystem::path& temporary) { run_gnuplot(script, temporary); });
}

}  // namespace goniofit
