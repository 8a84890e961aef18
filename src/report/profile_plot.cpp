#include "report/profile_plot.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "report/fit_rows.h"
#include "report/gnuplot.h"
#include "report/number_text.h"
#include "report/plot_page.h"
#include "support/error.h"
#include "support/output_file.h"

namespace goniofit {
namespace {

constexpr std::size_t most_panels = 12;
constexpr double highest = 2.6;  // of the root of Δ
constexpr const char* curve_color = "#0072B2";
constexpr const char* line_color = "#909090";
constexpr const char* limit_color = "#D55E00";

// What a reader most wants to see comes first: an interval that value ± k u gets wrong.
double oddity(const LikelihoodProfile& p) {
  if (p.lower_loss) return 1e3;
  const bool special = p.lower_end != ProfileEnd::crossed || p.upper_end != ProfileEnd::crossed || p.two_dips;
  return (special ? 10.0 : 0.0) + std::min(p.asymmetry(), 9.0);
}

std::vector<const LikelihoodProfile*> shown(const std::vector<LikelihoodProfile>& profiles) {
  std::vector<const LikelihoodProfile*> out;
  for (const LikelihoodProfile& p : profiles) {
    if (p.points.size() > 1) out.push_back(&p);
  }
  if (out.size() <= most_panels) return out;
  std::vector<const LikelihoodProfile*> odd = out;
  std::stable_sort(odd.begin(), odd.end(), [](const LikelihoodProfile* a, const LikelihoodProfile* b) {
    if (a->channel.empty() != b->channel.empty()) return a->channel.empty();
    return oddity(*a) > oddity(*b);
  });
  odd.resize(most_panels);
  std::erase_if(out, [&](const LikelihoodProfile* p) { return std::find(odd.begin(), odd.end(), p) == odd.end(); });
  return out;
}

struct Axis {
  double low, high;
  bool log;
};

Axis axis_of(const LikelihoodProfile& p) {
  double low = p.points.front().value;
  double high = p.points.back().value;
  if (low > 0.0 && high > 30.0 * low) return {low / 1.2, high * 1.2, true};
  const double margin = 0.06 * (high - low);
  return {low - margin, high + margin, false};
}

// Three or four tics: their numbers are long.
double tic_step(const Axis& axis) {
  const double step = (axis.high - axis.low) / 4.2;
  const double unit = std::pow(10.0, std::floor(std::log10(step)));
  const double part = step / unit;
  return unit * (part <= 1.0 ? 1.0 : part <= 2.0 ? 2.0 : part <= 5.0 ? 5.0 : 10.0);
}

std::string title_of(const LikelihoodProfile& p) {
  std::string text = p.key();
  if (!p.determined) return text + " (not determined)";
  if (p.u) {
    const ValueText value = value_text(p.value, *p.u);
    text += " = " + value.value + " ± " + value.uncertainty;
  } else {
    text += " = " + number_text(p.value);
  }
  return text + (p.unit.empty() ? "" : " " + unit_text(p.unit));
}

// The root of Δ is all but straight between neighbours, so a line through the points is the curve.
std::string data_block(const LikelihoodProfile& p, std::size_t panel) {
  std::string out = fmt::format("$p{} << EOD\n", panel);
  for (const ProfilePoint& at : p.points) out += fmt::format("{:.10g} {:.7g}\n", at.value, std::sqrt(at.delta));
  return out + "EOD\n";
}

std::string vertical(double x) {
  return fmt::format(
      "set arrow from first {0:.10g}, graph 0 to first {0:.10g}, graph 1 nohead lc rgb '{1}' lw 1.2 dt 2\n", x,
      limit_color);
}

std::string limits(const LikelihoodProfile& p) {
  std::string out;
  if (!p.interval_95) return out;
  if (p.lower_end == ProfileEnd::crossed) out += vertical(p.interval_95->lower);
  if (p.upper_end == ProfileEnd::crossed) out += vertical(p.interval_95->upper);
  return out;
}

std::string panel_commands(const PanelGrid& grid, const PlotPage& page, const LikelihoodProfile& p, std::size_t panel) {
  const Axis axis = axis_of(p);
  std::string out = "unset label\nunset arrow\nunset logscale\n";
  out += page.margins(grid.x(panel), grid.y(panel), grid.panel_width, grid.panel_height);
  out +=
      page.label(1, title_of(p), grid.x(panel), grid.y(panel) - 26.0, fmt::format("left font '{}'", page.font(12.5)));
  out += page.label(2, p.remark(), grid.x(panel), grid.y(panel) - 10.0,
                    fmt::format("left font '{}' textcolor rgb '{}'", page.font(11.5), limit_color));
  out += fmt::format("set xrange [{:.10g}:{:.10g}]\nset yrange [0:{}]\n", axis.low, axis.high,
                     highest * p.coverage_factor / 1.96);
  out += axis.log ? "set logscale x\nset xtics autofreq\n"
                  : fmt::format("set xtics {:.3g} nomirror out\n", tic_step(axis));
  const bool labelled = panel % grid.columns == 0;
  out += fmt::format("set ytics ('{}' 0, '{}' 1, '{}' {:.4g}) nomirror out\n", labelled ? "0" : "",
                     labelled ? "68 %%" : "", labelled ? "95 %%" : "", p.coverage_factor);
  for (const double level : {1.0, p.coverage_factor})
    out +=
        fmt::format("set arrow from graph 0, first {0:.4g} to graph 1, first {0:.4g} nohead lc rgb '#D0D0D0'\n", level);
  out += limits(p) + "plot ";
  if (p.u) out += fmt::format("abs(x-{:.10g})/{:.10g} with lines lc rgb '{}' lw 1.2 dt 4, ", p.value, *p.u, line_color);
  return out + fmt::format(
                   "$p{0} using 1:2 with lines lc rgb '{1}' lw 1.8, $p{0} using 1:2 with points lc rgb '{1}' pt "
                   "7 ps 0.35\n",
                   panel, curve_color);
}

std::string page_texts(const PlotPage& page, const FitResult& result, const Scan& scan, std::size_t panels) {
  const std::string& name = result.material.name.empty() ? scan.name : result.material.name;
  std::string out = page.label(11, name + ": profile likelihoods", 0.5 * page.width, 18.0,
                               fmt::format("center font '{}'", page.font(16.0)));
  std::string text =
      "√Δ, the distance from the best fit in standard uncertainties; dashed grey: as value ± k u has it; orange: "
      "limits "
      "of 95 %";
  if (panels < result.profiles.size())
    text += fmt::format("; {} of {} parameters, the least parabolic", panels, result.profiles.size());
  return out + page.label(12, text, 0.5 * page.width, 38.0,
                          fmt::format("center font '{}' textcolor rgb '#606060'", page.font(11.5)));
}

}  // namespace

void plot_profiles(const std::filesystem::path& path, const FitResult& result, const Scan& scan) {
  const bool png = is_png(path);
  const std::vector<const LikelihoodProfile*> panels = shown(result.profiles);
  if (panels.empty()) throw usage_error(path.string() + ": there is no profile to draw");
  const PanelGrid grid{.panels = panels.size(),
                       .columns = std::clamp<std::size_t>(panels.size(), 3, 4),
                       .panel_width = 240.0,
                       .panel_height = 170.0,
                       .gap_x = 22.0,
                       .gap_y = 72.0,
                       .left = 56.0,
                       .top = 96.0,
                       .right = 24.0,
                       .bottom = 34.0};
  const PlotPage page = grid.page(png);
  std::string script = page.terminal();
  for (std::size_t i = 0; i < panels.size(); ++i) script += data_block(*panels[i], i);
  script += "set samples 400\nset border 3\nunset key\nset multiplot\n";
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const std::string commands = panel_commands(grid, page, *panels[i], i);
    const std::size_t plot = commands.rfind("plot ");
    script += i > 0 ? commands
                    : commands.substr(0, plot) + page_texts(page, result, scan, panels.size()) + commands.substr(plot);
  }
  script += "unset multiplot\n";
  write_file_with(path, [&script](const std::filesystem::path& temporary) { run_gnuplot(script, temporary); });
}

}  // namespace goniofit
