#include "scan/arrangement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "geometry/angles.h"

namespace goniofit {

namespace {

using Key = std::array<std::int64_t, 4>;

// The direction itself. At the normal an azimuth means nothing: only what is left of it counts.
Key direction_key(const Scan& scan, std::size_t row) {
  const std::int64_t theta_i = centidegrees(scan.theta_i_deg[row]);
  const std::int64_t theta_r = centidegrees(scan.theta_r_deg[row]);
  if (theta_i == 0 && theta_r == 0) return {};
  if (theta_i == 0) return {0, 0, theta_r, centidegrees(wrap_deg(scan.phi_r_deg[row]))};
  const std::int64_t phi_i = centidegrees(wrap_deg(scan.phi_i_deg[row]));
  return {theta_i, phi_i, theta_r, theta_r == 0 ? 0 : centidegrees(delta_phi_deg(scan, row))};
}

// What a direction and its swapped pair share on an isotropic surface.
Key unordered_key(const Scan& scan, std::size_t row) {
  const std::int64_t theta_i = centidegrees(scan.theta_i_deg[row]);
  const std::int64_t theta_r = centidegrees(scan.theta_r_deg[row]);
  const std::int64_t delta = is_polar(scan, row) ? 0 : centidegrees(std::fabs(delta_phi_deg(scan, row)));
  return {std::min(theta_i, theta_r), std::max(theta_i, theta_r), delta, 0};
}

// Incidence, the plane by the azimuth of its half in (0, 180], and the signed theta_r: positive in that half.
Key line_key(const Scan& scan, std::size_t row) {
  constexpr std::int64_t half_turn = 18000;
  const std::int64_t theta_i = centidegrees(scan.theta_i_deg[row]);
  const std::int64_t theta_r = centidegrees(scan.theta_r_deg[row]);
  const std::int64_t phi_i = theta_i == 0 ? 0 : centidegrees(wrap_deg(scan.phi_i_deg[row]));
  std::int64_t azimuth = centidegrees(theta_i == 0 ? wrap_deg(scan.phi_r_deg[row]) : delta_phi_deg(scan, row));
  if (azimuth == -half_turn) azimuth = half_turn;  // by rounding
  if (azimuth > 0) return {theta_i, phi_i, azimuth, theta_r};
  return {theta_i, phi_i, azimuth + half_turn, -theta_r};
}

template <class KeyOf>
std::vector<std::pair<Key, std::size_t>> sorted_by(const Scan& scan, KeyOf&& key_of) {
  std::vector<std::pair<Key, std::size_t>> keyed(scan.size());
  for (std::size_t row = 0; row < scan.size(); ++row) keyed[row] = {key_of(scan, row), row};
  std::sort(keyed.begin(), keyed.end());
  return keyed;
}

// Rows in groups that agree in the first `parts` of their keys.
template <class KeyOf>
std::vector<Rows> grouped(const Scan& scan, KeyOf&& key_of, std::ptrdiff_t parts = 4) {
  const auto keyed = sorted_by(scan, key_of);
  std::vector<Rows> groups;
  for (std::size_t i = 0; i < keyed.size(); ++i) {
    const bool same =
        i > 0 && std::equal(keyed[i].first.begin(), keyed[i].first.begin() + parts, keyed[i - 1].first.begin());
    if (!same) groups.emplace_back();
    groups.back().push_back(keyed[i].second);
  }
  return groups;
}

// The angle between unit vectors that are sqrt(distance2) apart.
double angle_deg(double distance2) { return degrees(2.0 * std::asin(std::min(1.0, 0.5 * std::sqrt(distance2)))); }

}  // namespace

std::int64_t centidegrees(double degrees) { return std::llround(100.0 * degrees); }

double delta_phi_deg(const Scan& scan, std::size_t row) { return wrap_deg(scan.phi_r_deg[row] - scan.phi_i_deg[row]); }

bool is_polar(const Scan& scan, std::size_t row) {
  return centidegrees(scan.theta_i_deg[row]) == 0 || centidegrees(scan.theta_r_deg[row]) == 0;
}

double from_mirror_deg(const Pair& pair) { return angle_deg(pair.mirror_distance2); }

double from_retro_deg(const Pair& pair) { return angle_deg(4.0 * pair.one_minus_cos_h * (1.0 + pair.cos_h)); }

std::vector<Rows> repeated_rows(const Scan& scan) {
  std::vector<Rows> repeats = grouped(scan, direction_key);
  std::erase_if(repeats, [](const Rows& group) { return group.size() < 2; });
  return repeats;
}

std::vector<SwappedRows> swapped_rows(const Scan& scan) {
  std::vector<SwappedRows> pairs;
  for (const Rows& group : grouped(scan, unordered_key)) {
    SwappedRows pair;
    for (const std::size_t row : group) {
      const std::int64_t difference = centidegrees(scan.theta_r_deg[row]) - centidegrees(scan.theta_i_deg[row]);
      if (difference != 0) (difference > 0 ? pair.steeper : pair.flatter).push_back(row);
    }
    if (!pair.steeper.empty() && !pair.flatter.empty()) pairs.push_back(std::move(pair));
  }
  return pairs;
}

double mean_of(const std::vector<double>& values, const Rows& rows) {
  double sum = 0.0;
  for (const std::size_t row : rows) sum += values[row];
  return sum / static_cast<double>(rows.size());
}

std::vector<double> swapped_ratios(const std::vector<double>& values, const std::vector<SwappedRows>& pairs) {
  std::vector<double> ratios;
  for (const SwappedRows& pair : pairs) {
    const double steeper = mean_of(values, pair.steeper);
    const double flatter = mean_of(values, pair.flatter);
    if (steeper > 0.0 && flatter > 0.0) ratios.push_back(steeper / flatter);
  }
  return ratios;
}

std::vector<Rows> detector_lines(const Scan& scan) { return grouped(scan, line_key, 3); }

}  // namespace goniofit
