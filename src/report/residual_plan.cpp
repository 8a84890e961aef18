#include "report/residual_plan.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "brdf/evaluator.h"
#include "report/fit_rows.h"
#include "support/error.h"

namespace goniofit {
namespace {

constexpr std::size_t most_panels = 9, most_curves = 3;

std::vector<double> fitted_values(const Evaluator& evaluator, const Scan& scan, std::size_t channel) {
  std::vector<double> fitted;
  for (std::size_t row = 0; row < scan.size(); ++row) {
    fitted.push_back(evaluator.value(make_pair(scan.angles(row)), channel));
  }
  return fitted;
}

// Channels by the part of their signal that the fit misses, the most first.
std::vector<std::size_t> worst_first(const Scan& scan, const std::vector<std::vector<double>>& fitted) {
  std::vector<double> missed;
  for (std::size_t c = 0; c < scan.channels.size(); ++c) {
    double residual2 = 0.0;
    double signal2 = 0.0;
    for (std::size_t row = 0; row < scan.size(); ++row) {
      const double f = scan.channels[c].values[row];
      residual2 += (f - fitted[c][row]) * (f - fitted[c][row]);
      signal2 += f * f;
    }
    missed.push_back(signal2 > 0.0 ? residual2 / signal2 : 0.0);
  }
  std::vector<std::size_t> order(missed.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return missed[a] > missed[b]; });
  return order;
}

// Groups of readings of one incidence angle.
std::vector<ResidualPanel> by_incidence(const Scan& scan) {
  constexpr double together_deg = 0.5;
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < scan.size(); ++row) {
    if (scan.theta_i_deg[row] < 90.0 && scan.theta_r_deg[row] < 90.0) rows.push_back(row);
  }
  std::stable_sort(rows.begin(), rows.end(),
                   [&](std::size_t a, std::size_t b) { return scan.theta_i_deg[a] < scan.theta_i_deg[b]; });
  std::vector<ResidualPanel> panels;
  for (const std::size_t row : rows) {
    const double theta = scan.theta_i_deg[row];
    if (panels.empty() || theta > panels.back().theta_i_deg + together_deg) panels.push_back({theta, theta, {}});
    panels.back().theta_i_high_deg = theta;
    panels.back().rows.push_back(row);
  }
  return panels;
}

// 1, 2 or 5 times a power of ten, at least the 98th percentile of the sizes.
double nice_limit(std::vector<double> sizes) {
  if (sizes.empty()) return 1.0;
  const auto at = sizes.begin() + static_cast<std::ptrdiff_t>(0.98 * static_cast<double>(sizes.size() - 1));
  std::nth_element(sizes.begin(), at, sizes.end());
  const double size = std::max(*at, 1e-6);
  const double power = std::pow(10.0, std::floor(std::log10(size)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (size <= step * power) return step * power;
  }
  return 10.0 * power;
}

}  // namespace

std::vector<ResidualPanel> incidence_panels(const Scan& scan, std::size_t most) {
  std::vector<ResidualPanel> all = by_incidence(scan);
  std::size_t readings = 0;
  for (const ResidualPanel& panel : all) readings += panel.rows.size();
  if (all.size() <= most) return all;
  std::vector<ResidualPanel> panels;
  if (readings / all.size() >= 20) {
    for (const std::size_t i : evenly_chosen(all.size(), most)) panels.push_back(std::move(all[i]));
    return panels;
  }
  constexpr double class_deg = 15.0;
  for (ResidualPanel& panel : all) {
    const double from = class_deg * std::floor(panel.theta_i_deg / class_deg);
    if (panels.empty() || panel.theta_i_deg >= panels.back().theta_i_deg + class_deg)
      panels.push_back({from, from, {}});
    ResidualPanel& last = panels.back();
    last.theta_i_high_deg = panel.theta_i_high_deg;
    last.rows.insert(last.rows.end(), panel.rows.begin(), panel.rows.end());
  }
  for (ResidualPanel& panel : panels) panel.theta_i_deg = scan.theta_i_deg[panel.rows.front()];
  return panels;
}

double residual_floor(const Scan& scan, const FitResult& result, const std::vector<std::size_t>& channels) {
  double floor = 0.0;
  for (const std::size_t c : channels) {
    const std::vector<double>& values = scan.channels[c].values;
    if (!values.empty()) floor = std::max(floor, 1e-3 * *std::max_element(values.begin(), values.end()));
    if (result.diagnostics) floor = std::max(floor, result.diagnostics->channels[c].noise_floor);
  }
  return floor > 0.0 ? floor : 1.0;
}

ResidualPlan plan_residuals(const Scan& scan, const FitResult& result) {
  if (result.material.channels.size() != scan.channels.size()) {
    throw usage_error(fmt::format("the material has {} channels and the scan {}: they have no residuals",
                                  result.material.channels.size(), scan.channels.size()));
  }
  ResidualPlan plan;
  std::size_t out_of_plane = 0;
  for (std::size_t row = 0; row < scan.size(); ++row) out_of_plane += scan.plane_side(row) == 0 ? 1 : 0;
  plan.map = 5 * out_of_plane > scan.size();
  const Evaluator evaluator(result.material);
  std::vector<std::vector<double>> fitted;
  for (std::size_t c = 0; c < scan.channels.size(); ++c) fitted.push_back(fitted_values(evaluator, scan, c));
  plan.channels = worst_first(scan, fitted);
  const bool few = !plan.map && plan.channels.size() <= most_curves;
  if (!few) plan.channels.resize(std::min<std::size_t>(plan.channels.size(), 1));
  if (few) std::sort(plan.channels.begin(), plan.channels.end());
  plan.by_u = std::all_of(plan.channels.begin(), plan.channels.end(),
                          [&](std::size_t c) { return !scan.channels[c].u.empty(); });
  plan.floor = residual_floor(scan, result, plan.channels);
  plan.incidences = by_incidence(scan).size();
  plan.panels = incidence_panels(scan, most_panels);
  for (const std::size_t c : plan.channels) {
    std::vector<double>& values = plan.values.emplace_back();
    for (std::size_t row = 0; row < scan.size(); ++row) {
      const double f = scan.channels[c].values[row];
      const double unit = plan.by_u ? scan.channels[c].u[row] : std::max({std::fabs(f), fitted[c][row], plan.floor});
      values.push_back((f - fitted[c][row]) / unit);
    }
  }
  std::vector<double> sizes;
  for (const std::vector<double>& values : plan.values) {
    for (const ResidualPanel& panel : plan.panels) {
      for (const std::size_t row : panel.rows) sizes.push_back(std::fabs(values[row]));
    }
  }
  plan.limit = nice_limit(sizes);
  if (!plan.by_u) plan.limit = std::min(plan.limit, 1.0);
  plan.beyond = static_cast<std::size_t>(
      std::count_if(sizes.begin(), sizes.end(), [&](double size) { return size > plan.limit; }));
  return plan;
}

}  // namespace goniofit
