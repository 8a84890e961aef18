#pragma once
// What can be said of a scan before any fit: where it has readings, where it has none, how well it agrees with itself.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "../scan/scan.h"

namespace goniofit {

struct ValueRange {
  double min = 0.0, max = 0.0;
};

/// Readings of one incidence angle (to 0.01°).
struct IncidenceStatistics {
  double theta_i_deg = 0.0;
  std::size_t readings = 0;
  ValueRange theta_r_deg;           ///< signed in an incidence-plane scan
  double nearest_mirror_deg = 0.0;  ///< angle between the mirror direction and the reading next to it
  double nearest_retro_deg = 0.0;
};

/// Of ratios: the middle and the range that holds nine of ten.
struct RatioStatistics {
  double median = 1.0;
  ValueRange inner_90;
};

struct ChannelStatistics {
  ValueRange value;
  double median = 0.0;
  std::size_t negative = 0, zero = 0;
  std::optional<double> relative_u;  ///< median of u / value where the value is above 0; none without uncertainties
  /// f(theta_i < theta_r) / f of the swapped pair, where both are above 0.
  std::optional<RatioStatistics> reciprocity;
  /// Relative standard deviation of readings of the same direction, pooled over the directions read more than once.
  std::optional<double> repeat_spread;
};

/// Largest interval of |phi_r - phi_i| without a reading, left and right being alike for an isotropic surface.
struct AzimuthGap {
  double from_deg = 0.0, to_deg = 0.0;
};

struct ScanStatistics {
  ValueRange theta_i_deg, theta_r_deg;          ///< theta_r signed in an incidence-plane scan
  std::vector<IncidenceStatistics> incidences;  ///< ascending
  std::vector<ChannelStatistics> channels;      ///< as in the scan
  std::size_t at_horizon = 0;                   ///< theta_i or theta_r exactly 90°: left out of fits
  std::size_t forward = 0, retro = 0;           ///< in the plane of incidence
  std::size_t left = 0, right = 0;              ///< out of it: phi_r - phi_i in (0, 180), in (-180, 0)
  std::optional<AzimuthGap> azimuth_gap;        ///< hemispherical scans only
  std::size_t reciprocal_pairs = 0;             ///< directions whose swapped pair was read too, |phi_r - phi_i| alike
  std::size_t repeated_directions = 0;          ///< directions read more than once
  std::size_t repeated_readings = 0;            ///< readings of them
};

/// Directions are the same where their angles agree when rounded to 0.01°. Expects at least one reading. O(n log n).
[[nodiscard]] ScanStatistics scan_statistics(const Scan& scan);

/// What a person should know before fitting, a sentence each: gaps, negatives, readings that fits leave out.
[[nodiscard]] std::vector<std::string> scan_notes(const Scan& scan, const ScanStatistics& statistics);

}  // namespace goniofit
