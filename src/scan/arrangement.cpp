#include "scan/arrangement.h"

#include <algorithm>
#include <cmath>

#include "geometry/angles.h"
#include "support/radix_sort.h"

namespace goniofit {

namespace {

// Four angles in centidegrees within (-18000, 18000], in one number of the same order.
using Key = std::uint64_t;
Key key_of(std::int64_t a, std::int64_t b, std::int64_t c, std::int64_t d) {
  constexpr std::int64_t origin = 18000;
  const auto part = [](std::int64_t angle) { return static_cast<std::uint64_t>(angle + origin) & 0xffffU; };
  return part(a) << 48U | part(b) << 32U | part(c) << 16U | part(d);
}

// The direction itself. At the normal an azimuth means nothing: only what is left of it counts.
Key direction_key(const Scan& scan, std::size_t row) {
  const std::int64_t theta_i = centidegrees(scan.theta_i_deg[row]);
  const std::int64_t theta_r = centidegrees(scan.theta_r_deg[row]);
  if (theta_i == 0 && theta_r == 0) return key_of(0, 0, 0, 0);
  if (theta_i == 0) return key_of(0, 0, theta_r, centidegrees(wrap_deg(scan.phi_r_deg[row])));
  const std::int64_t phi_i = centidegrees(wrap_deg(scan.phi_i_deg[row]));
  return key_of(theta_i, phi_i, theta_r, theta_r == 0 ? 0 : centidegrees(delta_phi_deg(scan, row)));
}

// What a direction and its swapped pair share on an isotropic surface.
Key unordered_key(const Scan& scan, std::size_t row) {
  const std::int64_t theta_i = centidegrees(scan.theta_i_deg[row]);
  const std::int64_t theta_r = centidegrees(scan.theta_r_deg[row]);
  const std::int64_t delta = is_polar(scan, row) ? 0 : centidegrees(std::fabs(delta_phi_deg(scan, row)));
  return key_of(std::min(theta_i, theta_r), std::max(theta_i, theta_r), delta, 0);
}

// Incidence, the plane by the azimuth of its half in (0, 180], and the signed theta_r: positive in that half.
Key line_key(const Scan& scan, std::size_t row) {
  constexpr std::int64_t half_turn = 18000;
  const std::int64_t theta_i = centidegrees(scan.theta_i_deg[row]);
  const std::int64_t theta_r = centidegrees(scan.theta_r_deg[row]);
  const std::int64_t phi_i = theta_i == 0 ? 0 : centidegrees(wrap_deg(scan.phi_i_deg[row]));
  std::int64_t azimuth = centidegrees(theta_i == 0 ? wrap_deg(scan.phi_r_deg[row]) : delta_phi_deg(scan, row));
  if (azimuth == -half_turn) azimuth = half_turn;  // by rounding
  if (azimuth > 0) return key_of(theta_i, phi_i, azimuth, theta_r);
  return key_of(theta_i, phi_i, azimuth + half_turn, -theta_r);
}

template <class KeyOf>
std::vector<KeyedRow> sorted_by(const Scan& scan, KeyOf&& key) {
  std::vector<KeyedRow> keyed(scan.size());
  for (std::size_t row = 0; row < scan.size(); ++row) keyed[row] = {key(scan, row), row};
  radix_sort(keyed);
  return keyed;
}

// f(first, end) of the runs of rows whose keys agree but for their last `open` bits.
template <class F>
void for_each_run(const std::vector<KeyedRow>& keyed, unsigned open, const F& f) {
  for (std::size_t first = 0; first < keyed.size();) {
    std::size_t end = first + 1;
    while (end < keyed.size() && keyed[end].key >> open == keyed[first].key >> open) ++end;
    f(first, end);
    first = end;
  }
}

RowGroups grouped(const std::vector<KeyedRow>& keyed, unsigned open, std::size_t fewest) {
  RowGroups out;
  if (fewest == 1) out.rows.reserve(keyed.size());
  for_each_run(keyed, open, [&](std::size_t first, std::size_t end) {
    if (end - first < fewest) return;
    for (std::size_t i = first; i < end; ++i) out.rows.push_back(keyed[i].row);
    out.ends.push_back(out.rows.size());
  });
  return out;
}

// The angle between unit vectors that are sqrt(distance2) apart.
double angle_deg(double distance2) { return degrees(2.0 * std::asin(std::min(1.0, 0.5 * std::sqrt(distance2)))); }

}  // namespace

// As llround, without a call: any reading's angles are exact to more than a tie needs.
std::int64_t centidegrees(double degrees) {
  const double scaled = 100.0 * degrees;
  return static_cast<std::int64_t>(scaled + std::copysign(0.5, scaled));
}

double delta_phi_deg(const Scan& scan, std::size_t row) { return wrap_deg(scan.phi_r_deg[row] - scan.phi_i_deg[row]); }

bool is_polar(const Scan& scan, std::size_t row) {
  return centidegrees(scan.theta_i_deg[row]) == 0 || centidegrees(scan.theta_r_deg[row]) == 0;
}

double from_mirror_deg(const Pair& pair) { return angle_deg(pair.mirror_distance2); }

double from_retro_deg(const Pair& pair) { return angle_deg(4.0 * pair.one_minus_cos_h * (1.0 + pair.cos_h)); }

RowGroups repeated_rows(const Scan& scan) { return grouped(sorted_by(scan, direction_key), 0, 2); }

SwappedRows swapped_rows(const Scan& scan) {
  const std::vector<KeyedRow> keyed = sorted_by(scan, unordered_key);
  SwappedRows pairs;
  RowGroups& to = pairs.groups;
  Rows flatter;
  for_each_run(keyed, 0, [&](std::size_t first, std::size_t end) {
    const std::size_t before = to.rows.size();
    flatter.clear();
    for (std::size_t i = first; i < end; ++i) {
      const std::size_t row = keyed[i].row;
      const std::int64_t difference = centidegrees(scan.theta_r_deg[row]) - centidegrees(scan.theta_i_deg[row]);
      if (difference != 0) (difference > 0 ? to.rows : flatter).push_back(row);
    }
    if (to.rows.size() == before || flatter.empty()) return to.rows.resize(before);
    to.ends.push_back(to.rows.size());
    to.rows.insert(to.rows.end(), flatter.begin(), flatter.end());
    to.ends.push_back(to.rows.size());
  });
  return pairs;
}

double mean_of(const std::vector<double>& values, std::span<const std::size_t> rows) {
  double sum = 0.0;
  for (const std::size_t row : rows) sum += values[row];
  return sum / static_cast<double>(rows.size());
}

std::vector<double> swapped_ratios(const std::vector<double>& values, const SwappedRows& pairs) {
  std::vector<double> ratios;
  ratios.reserve(pairs.size());
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const double steeper = mean_of(values, pairs.groups[2 * p]);
    const double flatter = mean_of(values, pairs.groups[2 * p + 1]);
    if (steeper > 0.0 && flatter > 0.0) ratios.push_back(steeper / flatter);
  }
  return ratios;
}

RowGroups detector_lines(const Scan& scan) { return grouped(sorted_by(scan, line_key), 16, 1); }

}  // namespace goniofit
