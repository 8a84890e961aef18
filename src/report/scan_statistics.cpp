#include "report/scan_statistics.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>

#include "geometry/angles.h"
#include "geometry/pair.h"
#include "scan/arrangement.h"

namespace goniofit {

namespace {

double quantile(std::vector<double>& values, double q) {
  const auto at = values.begin() + std::llround(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

std::optional<RatioStatistics> reciprocity_of(const ScanChannel& channel, const SwappedRows& pairs) {
  std::vector<double> ratios = swapped_ratios(channel.values, pairs);
  if (ratios.empty()) return std::nullopt;
  return RatioStatistics{quantile(ratios, 0.5), {quantile(ratios, 0.05), quantile(ratios, 0.95)}};
}

std::optional<double> repeat_spread_of(const ScanChannel& channel, const RowGroups& repeats) {
  double squares = 0.0;
  std::size_t degrees_of_freedom = 0;
  for (std::size_t g = 0; g < repeats.size(); ++g) {
    const std::span<const std::size_t> group = repeats[g];
    const double mean = mean_of(channel.values, group);
    if (!(mean > 0.0)) continue;
    for (const std::size_t row : group) squares += std::pow(channel.values[row] / mean - 1.0, 2);
    degrees_of_freedom += group.size() - 1;
  }
  if (degrees_of_freedom == 0) return std::nullopt;
  return std::sqrt(squares / static_cast<double>(degrees_of_freedom));
}

std::optional<double> relative_u_of(const ScanChannel& channel) {
  std::vector<double> parts;
  for (std::size_t row = 0; row < channel.u.size(); ++row) {
    if (channel.values[row] > 0.0) parts.push_back(channel.u[row] / channel.values[row]);
  }
  if (parts.empty()) return std::nullopt;
  return quantile(parts, 0.5);
}

ChannelStatistics channel_statistics(const ScanChannel& channel, const SwappedRows& pairs, const RowGroups& repeats) {
  std::vector<double> values = channel.values;
  const auto [min, max] = std::minmax_element(values.begin(), values.end());
  ChannelStatistics out;
  out.value = {*min, *max};
  out.negative =
      static_cast<std::size_t>(std::count_if(values.begin(), values.end(), [](double v) { return v < 0.0; }));
  out.zero = static_cast<std::size_t>(std::count(values.begin(), values.end(), 0.0));
  out.median = quantile(values, 0.5);
  out.relative_u = relative_u_of(channel);
  out.reciprocity = reciprocity_of(channel, pairs);
  out.repeat_spread = repeat_spread_of(channel, repeats);
  return out;
}

// theta_r as the file has it.
double written_theta_r(const Scan& scan, std::size_t row) {
  const bool retro = scan.geometry == ScanGeometry::incidence_plane && std::fabs(delta_phi_deg(scan, row)) < 90.0;
  return retro ? -scan.theta_r_deg[row] : scan.theta_r_deg[row];
}

void widen(ValueRange& range, double value) { range = {std::min(range.min, value), std::max(range.max, value)}; }

std::vector<IncidenceStatistics> incidence_statistics(const Scan& scan) {
  std::map<std::int64_t, IncidenceStatistics> by_angle;
  for (std::size_t row = 0; row < scan.size(); ++row) {
    const Pair pair = make_pair(scan.angles(row));
    const double mirror = from_mirror_deg(pair);
    const double retro = from_retro_deg(pair);
    const double theta_r = written_theta_r(scan, row);
    const auto [entry, is_new] =
        by_angle.try_emplace(centidegrees(scan.theta_i_deg[row]),
                             IncidenceStatistics{scan.theta_i_deg[row], 0, {theta_r, theta_r}, mirror, retro});
    IncidenceStatistics& incidence = entry->second;
    ++incidence.readings;
    widen(incidence.theta_r_deg, theta_r);
    incidence.nearest_mirror_deg = std::min(incidence.nearest_mirror_deg, mirror);
    incidence.nearest_retro_deg = std::min(incidence.nearest_retro_deg, retro);
  }
  std::vector<IncidenceStatistics> out;
  for (const auto& [angle, incidence] : by_angle) out.push_back(incidence);
  return out;
}

std::optional<AzimuthGap> azimuth_gap(const Scan& scan) {
  if (scan.geometry != ScanGeometry::hemispherical) return std::nullopt;
  std::vector<double> azimuths{0.0, 180.0};
  for (std::size_t row = 0; row < scan.size(); ++row) {
    if (!is_polar(scan, row)) azimuths.push_back(std::fabs(delta_phi_deg(scan, row)));
  }
  if (azimuths.size() == 2) return std::nullopt;
  std::sort(azimuths.begin(), azimuths.end());
  AzimuthGap largest;
  for (std::size_t i = 1; i < azimuths.size(); ++i) {
    if (azimuths[i] - azimuths[i - 1] > largest.to_deg - largest.from_deg) largest = {azimuths[i - 1], azimuths[i]};
  }
  return largest;
}

void count_sides(const Scan& scan, ScanStatistics& out) {
  for (std::size_t row = 0; row < scan.size(); ++row) {
    out.at_horizon += scan.theta_i_deg[row] == 90.0 || scan.theta_r_deg[row] == 90.0 ? 1 : 0;
    if (is_polar(scan, row)) continue;
    const int side = scan.plane_side(row);
    out.forward += side > 0 ? 1 : 0;
    out.retro += side < 0 ? 1 : 0;
    if (side == 0) ++(delta_phi_deg(scan, row) > 0.0 ? out.left : out.right);
  }
}

ValueRange range_of(const std::vector<double>& values) {
  const auto [min, max] = std::minmax_element(values.begin(), values.end());
  return {*min, *max};
}

}  // namespace

ScanStatistics scan_statistics(const Scan& scan) {
  ScanStatistics out;
  out.theta_i_deg = range_of(scan.theta_i_deg);
  out.incidences = incidence_statistics(scan);
  out.theta_r_deg = out.incidences.front().theta_r_deg;
  for (const IncidenceStatistics& incidence : out.incidences) {
    widen(out.theta_r_deg, incidence.theta_r_deg.min);
    widen(out.theta_r_deg, incidence.theta_r_deg.max);
  }
  out.azimuth_gap = azimuth_gap(scan);
  count_sides(scan, out);

  const RowGroups repeats = repeated_rows(scan);
  const SwappedRows pairs = swapped_rows(scan);
  out.reciprocal_pairs = pairs.size();
  out.repeated_directions = repeats.size();
  out.repeated_readings = repeats.rows.size();
  for (const ScanChannel& channel : scan.channels) out.channels.push_back(channel_statistics(channel, pairs, repeats));
  return out;
}

}  // namespace goniofit
