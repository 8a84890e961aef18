#include "report/plot_plan.h"
#include "report/number_text.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "geometry/angles.h"
#include "report/fit_rows.h"
#include "support/error.h"

namespace goniofit {
namespace {

// Fewer than this are no curve. Readings that are not where they are said to be had better be many.
constexpr std::size_t enough_readings = 5, enough_near_readings = 12;
constexpr double log_above = 30.0;
constexpr double most_decades_factor = 1e7;  // further down nothing is measured, and simulated scans go to 1e-250
constexpr double wide_bin_deg = 10.0;

struct PlaneReading {
  double theta_i_deg, signed_theta_r_deg;
  std::size_t row;
};

std::vector<PlaneReading> readings_near_plane(const Scan& scan, double tolerance_deg) {
  std::vector<PlaneReading> readings;
  for (std::size_t row = 0; row < scan.size(); ++row) {
    const int side = scan.plane_side(row, tolerance_deg);
    if (side == 0 || scan.theta_i_deg[row] >= 90.0 || scan.theta_r_deg[row] >= 90.0) continue;
    readings.push_back({scan.theta_i_deg[row], side * scan.theta_r_deg[row], row});
  }
  std::stable_sort(readings.begin(), readings.end(),
                   [](const PlaneReading& a, const PlaneReading& b) { return a.theta_i_deg < b.theta_i_deg; });
  return readings;
}

// Sorted readings cut into runs of theta_i no wider than `width_deg`.
std::vector<PlottedIncidence> grouped(const std::vector<PlaneReading>& readings, double width_deg) {
  std::vector<PlottedIncidence> groups;
  double start = -std::numeric_limits<double>::infinity();
  for (const PlaneReading& reading : readings) {
    if (reading.theta_i_deg - start > width_deg) {
      groups.emplace_back();
      start = reading.theta_i_deg;
    }
    PlottedIncidence& group = groups.back();
    group.theta_i_deg += reading.theta_i_deg;
    group.rows.push_back(reading.row);
    group.signed_theta_r_deg.push_back(reading.signed_theta_r_deg);
  }
  for (PlottedIncidence& group : groups) group.theta_i_deg /= static_cast<double>(group.rows.size());
  return groups;
}

std::size_t most_readings(const std::vector<PlottedIncidence>& groups) {
  std::size_t most = 0;
  for (const PlottedIncidence& group : groups) most = std::max(most, group.rows.size());
  return most;
}

// The narrowest azimuth, then the narrowest range of theta_i, that gives a curve; else the widest of both.
void group_readings(const Scan& scan, PlotPlan& plan) {
  for (const double azimuth : {0.5, 2.0, 5.0, 10.0}) {
    for (const double width : {0.5, wide_bin_deg}) {
      const std::vector<PlaneReading> readings = readings_near_plane(scan, azimuth);
      plan.azimuth_tolerance_deg = azimuth;
      plan.incidence_width_deg = width;
      plan.incidences = grouped(readings, width);
      const bool exact = azimuth == 0.5 && width == 0.5;
      if (most_readings(plan.incidences) >= (exact ? enough_readings : enough_near_readings)) return;
    }
  }
}

bool is_multiple(double angle, double step) { return std::fabs(angle / step - std::round(angle / step)) * step < 0.05; }

// Round angles (multiples of 10°, say) where the scan has enough of them, else evenly spaced ones.
std::vector<PlottedIncidence> thinned(const std::vector<PlottedIncidence>& all, std::size_t most) {
  if (all.size() <= most) return all;
  for (const double step : {5.0, 10.0, 15.0, 20.0, 30.0}) {
    std::vector<PlottedIncidence> round;
    std::copy_if(all.begin(), all.end(), std::back_inserter(round),
                 [step](const PlottedIncidence& g) { return is_multiple(g.theta_i_deg, step); });
    if (round.size() >= 3 && round.size() <= most) return round;
  }
  std::vector<PlottedIncidence> even;
  for (const std::size_t i : evenly_chosen(all.size(), most)) even.push_back(all[i]);
  return even;
}

void choose_incidences(PlotPlan& plan, std::size_t most) {
  const std::size_t needed = (most_readings(plan.incidences) + 1) / 2;
  std::vector<PlottedIncidence> full;
  std::copy_if(plan.incidences.begin(), plan.incidences.end(), std::back_inserter(full),
               [needed](const PlottedIncidence& g) { return g.rows.size() >= needed; });
  plan.incidences_available = plan.incidences.size();
  plan.incidences = thinned(full, most);
}

std::vector<double> shown_values(const Scan& scan, const PlotPlan& plan) {
  std::vector<double> values;
  for (const std::size_t channel : plan.channels) {
    for (const PlottedIncidence& group : plan.incidences) {
      for (const std::size_t row : group.rows) values.push_back(scan.channels[channel].values[row]);
    }
  }
  return values;
}

void choose_axes(const Scan& scan, PlotAxis axis, PlotPlan& plan) {
  std::vector<double> values = shown_values(scan, plan);
  std::sort(values.begin(), values.end());
  const auto positive = std::upper_bound(values.begin(), values.end(), 0.0);
  plan.highest = values.back();
  plan.lowest = values.front();
  if (positive == values.end()) return;  // all noise: a linear axis
  // Noise around zero, and clamped values, make the smallest reading meaningless: a low quantile stands for it.
  const double low = *(positive + (values.end() - positive) / 50);
  plan.log = axis == PlotAxis::log || (axis == PlotAxis::automatic && plan.highest > log_above * low);
  if (!plan.log) return;
  plan.lowest = std::max({*positive, low / 2.0, plan.highest / most_decades_factor});
  plan.not_shown =
      static_cast<std::size_t>(std::lower_bound(values.begin(), values.end(), plan.lowest) - values.begin());
}

void choose_range(PlotPlan& plan) {
  constexpr double margin_deg = 4.0;
  double lowest = 90.0;
  double highest = -90.0;
  for (const PlottedIncidence& group : plan.incidences) {
    for (const double theta : group.signed_theta_r_deg) {
      lowest = std::min(lowest, theta);
      highest = std::max(highest, theta);
    }
  }
  plan.theta_min_deg = std::max(-90.0, lowest - margin_deg);
  plan.theta_max_deg = std::min(90.0, highest + margin_deg);
}

}  // namespace

PlotPlan plan_plot(const Scan& scan, const PlotOptions& options) {
  PlotPlan plan;
  plan.channels = evenly_chosen(scan.channels.size(), options.max_panels);
  group_readings(scan, plan);
  if (plan.incidences.empty() || plan.channels.empty()) {
    throw input_error(
        scan.source, 0, "",
        "no reading lies within 10° of the plane of incidence, so there is nothing to plot against theta_r; "
        "leave the plot out");
  }
  choose_incidences(plan, std::max<std::size_t>(options.max_incidences, 2));
  choose_axes(scan, options.axis, plan);
  choose_range(plan);
  return plan;
}

std::vector<std::size_t> rows_at_azimuth(const Scan& scan, double phi_i_deg) {
  constexpr double tolerance_deg = 0.5;
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < scan.size(); ++row) {
    if (std::fabs(wrap_deg(scan.phi_i_deg[row] - phi_i_deg)) <= tolerance_deg) rows.push_back(row);
  }
  return rows;
}

Scan at_azimuth(const Scan& scan, double phi_i_deg) {
  const std::vector<std::size_t> rows = rows_at_azimuth(scan, phi_i_deg);
  const auto keep = [&rows](std::vector<double>& values) {
    if (values.empty()) return;  // a channel without uncertainties
    std::vector<double> kept;
    kept.reserve(rows.size());
    for (const std::size_t row : rows) kept.push_back(values[row]);
    values = std::move(kept);
  };
  Scan out = scan;
  for (auto* angles : {&out.theta_i_deg, &out.phi_i_deg, &out.theta_r_deg, &out.phi_r_deg}) keep(*angles);
  for (ScanChannel& channel : out.channels) {
    keep(channel.values);
    keep(channel.u);
  }
  return out;
}

std::vector<double> curve_angles(const PlotPlan& plan, double theta_i_deg, double lobe_deg) {
  constexpr double step_deg = 1.0;
  constexpr int side_points = 100;
  const double first = std::max(plan.theta_min_deg, -89.9);
  const double last = std::min(plan.theta_max_deg, 89.9);
  std::vector<double> angles{first, last};
  for (double angle = std::ceil(first); angle < last; angle += step_deg) angles.push_back(angle);
  // Distances w sinh(u), u uniform: about w/20 apart at the mirror direction, growing in proportion further out.
  const double width = std::clamp(lobe_deg / 2.0, 0.01, 2.0);
  const double end = std::asinh(180.0 / width);
  for (int i = -side_points; i <= side_points; ++i) {
    const double angle = theta_i_deg + width * std::sinh(end * i / side_points);
    if (angle > first && angle < last) angles.push_back(angle);
  }
  std::sort(angles.begin(), angles.end());
  angles.erase(std::unique(angles.begin(), angles.end()), angles.end());
  return angles;
}

double lobe_width_deg(const Material& material) {
  const double slope_width = degrees(material.surface.slope.value_or(1.0));
  constexpr double cone_deg = 0.7;  // half-angle of the coherent cone of the usual source
  // What a peer's parameters say of its width only the peer knows.
  const bool narrow = material.components.has(Effect::coh) || material.model != surface_model;
  return narrow ? std::min(slope_width, cone_deg) : slope_width;
}

std::string plot_remarks(const PlotPlan& plan) {
  std::vector<std::string> parts;
  if (plan.incidences.size() < plan.incidences_available) {
    parts.push_back(fmt::format("{} of {} incidence angles", plan.incidences.size(), plan.incidences_available));
  }
  if (plan.phi_i_deg) parts.push_back(fmt::format("φᵢ = {}° alone", angle_text(*plan.phi_i_deg)));
  if (plan.azimuth_tolerance_deg > 0.5) {
    parts.push_back(fmt::format("readings within {}° of the plane of incidence", plan.azimuth_tolerance_deg));
  }
  if (plan.incidence_width_deg > 0.5) {
    parts.push_back(fmt::format("θᵢ pooled over {}°", plan.incidence_width_deg));
  }
  if (plan.not_shown > 0) parts.push_back(fmt::format("{} readings ≤ 0 or below the axis not shown", plan.not_shown));
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : "; ") + part;
  return text;
}

}  // namespace goniofit
