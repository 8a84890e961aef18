#pragma once
// How the readings of a scan lie to each other: which are of the same direction, of swapped directions, on one line.
// Angles are the same where they agree when rounded to 0.01°: finer than any instrument points, coarser than what
// formats round.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scan.h"

namespace goniofit {

using Rows = std::vector<std::size_t>;

[[nodiscard]] std::int64_t centidegrees(double degrees);
/// phi_r - phi_i in (-180, 180].
[[nodiscard]] double delta_phi_deg(const Scan& scan, std::size_t row);
/// Whether one of the directions is the normal, where azimuths mean nothing.
[[nodiscard]] bool is_polar(const Scan& scan, std::size_t row);

[[nodiscard]] double mean_of(const std::vector<double>& values, const Rows& rows);

/// Angle between V and the mirror direction of L, and between V and L.
[[nodiscard]] double from_mirror_deg(const Pair& pair);
[[nodiscard]] double from_retro_deg(const Pair& pair);

/// Directions read more than once. O(n log n), as all of these.
[[nodiscard]] std::vector<Rows> repeated_rows(const Scan& scan);

/// Readings of i -> r and of r -> i, |phi_r - phi_i| alike: equal on an isotropic surface that keeps Helmholtz's law.
struct SwappedRows {
  Rows steeper, flatter;  ///< theta_i < theta_r, theta_i > theta_r
};
[[nodiscard]] std::vector<SwappedRows> swapped_rows(const Scan& scan);
/// f(steeper) / f(flatter) of every pair, repeats averaged, where both are above 0.
[[nodiscard]] std::vector<double> swapped_ratios(const std::vector<double>& values,
                                                 const std::vector<SwappedRows>& pairs);

/// Sweeps of the detector: readings of one incidence in one plane through the normal, in the order of the signed
/// theta_r. Lines of a single reading are among them.
[[nodiscard]] std::vector<Rows> detector_lines(const Scan& scan);

}  // namespace goniofit
