// The bars of a comparison, drawn by gnuplot.

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "report/comparison_report.h"
#include "report/gnuplot.h"
#include "report/number_text.h"
#include "support/error.h"
#include "support/output_file.h"

namespace goniofit {
namespace {

constexpr double width = 760.0, bar_height = 24.0, margins = 110.0;
constexpr double log_above = 10.0;

std::string terminal(bool png, double height) {
  const char* const kind = png ? "pngcairo" : "svg";
  return fmt::format("set terminal {} size {:.0f},{:.0f} font 'sans-serif,{}' background '#FFFFFF'\n", kind, width,
                     height, png ? 10 : 13);
}

struct Axis {
  double low, high;
  bool log;
};

Axis axis_of(const Comparison& comparison) {
  double lowest = comparison.rows.front().fit.rms;
  double highest = lowest;
  for (const ComparedFit& row : comparison.rows) {
    lowest = std::min(lowest, row.fit.rms);
    highest = std::max(highest, row.fit.rms);
  }
  if (highest <= 0.0) return {0.0, 1.0, false};
  // An exact fit has no place on a logarithmic axis; its bar has no length.
  const double least = std::max(lowest, 1e-9 * highest);
  if (highest > log_above * least) return {0.5 * least, 3.0 * highest, true};
  return {0.0, 1.2 * highest, false};
}

// Best on top, which is the last of gnuplot's axis.
std::string bars(const Comparison& comparison, const Axis& axis) {
  std::string out = "$bars << EOD\n";
  const std::size_t count = comparison.rows.size();
  for (std::size_t i = 0; i < count; ++i) {
    const double end = std::max(comparison.rows[i].fit.rms, axis.low);
    out += fmt::format("{:.8g} {} {:.8g}\n", axis.low, count - i, end);
  }
  return out + "EOD\n";
}

std::string labels(const Comparison& comparison, const Axis& axis) {
  std::string tics;
  std::string out;
  const std::size_t count = comparison.rows.size();
  for (std::size_t i = 0; i < count; ++i) {
    const ComparedFit& row = comparison.rows[i];
    tics += fmt::format("{}{} {}", i == 0 ? "" : ", ", gnuplot_quoted(row.model), count - i);
    out += fmt::format("set label {} {} at {:.8g},{} left offset 0.5,0 noenhanced\n", i + 1,
                       gnuplot_quoted(fmt::format("{:.3g}  ({}){}", row.fit.rms, row.free_parameters,
                                                  row.fit.converged ? "" : "  did not converge")),
                       std::max(row.fit.rms, axis.low), count - i);
  }
  return out + "set ytics (" + tics + ") nomirror noenhanced scale 0\n";
}

}  // namespace

void plot_comparison(const std::filesystem::path& path, const Comparison& comparison, const Scan& scan) {
  const bool png = is_png(path);
  if (comparison.rows.empty()) throw usage_error(path.string() + ": there is no model to draw");
  const Axis axis = axis_of(comparison);
  const auto count = static_cast<double>(comparison.rows.size());
  std::string script = "set encoding utf8\n" + terminal(png, margins + bar_height * count) + bars(comparison, axis);
  script += fmt::format("set title {} noenhanced\n", gnuplot_quoted(scan.name.empty() ? scan.source : scan.name));
  script += fmt::format("set xrange [{:.8g}:{:.8g}]\nset yrange [0.3:{}]\n", axis.low, axis.high, count + 0.7);
  if (axis.log) script += "set logscale x\nset format x '10^{%T}'\n";
  script += "set xlabel 'RMS of the weighted residuals / sr⁻¹  (free parameters)' noenhanced\nset border 3\n";
  script += labels(comparison, axis);
  script +=
      "set xtics nomirror out\nunset key\nset style fill solid 0.8 noborder\n"
      "plot $bars using 3:2:1:3:($2-0.35):($2+0.35) with boxxyerror lc rgb '#0072B2'\n";
  write_file_with(path, [&script](const std::filesystem::path& temporary) { run_gnuplot(script, temporary); });
}

}  // namespace goniofit
