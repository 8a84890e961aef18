#pragma once
// How the readings of a scan lie to each other: which are of the same direction, of swapped directions, on one line.
// Angles are the same where they agree when rounded to 0.01°: finer than any instrument points, coarser than what
// formats round.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "scan.h"

namespace goniofit {

using Rows = std::vector<std::size_t>;

/// Rows in groups, one after the other.
struct RowGroups {
  Rows rows{};
  std::vector<std::size_t> ends{};  ///< of each group in `rows`

  [[nodiscard]] std::size_t size() const noexcept { return ends.size(); }
  [[nodiscard]] std::span<const std::size_t> operator[](std::size_t group) const noexcept {
    const std::size_t first = group == 0 ? 0 : ends[group - 1];
    return std::span(rows).subspan(first, ends[group] - first);
  }
};

[[nodiscard]] std::int64_t centidegrees(double degrees);
/// phi_r - phi_i in (-180, 180].
[[nodiscard]] double delta_phi_deg(const Scan& scan, std::size_t row);
/// Whether one of the directions is the normal, where azimuths mean nothing.
[[nodiscard]] bool is_polar(const Scan& scan, std::size_t row);

[[nodiscard]] double mean_of(const std::vector<double>& values, std::span<const std::size_t> rows);

/// Angle between V and the mirror direction of L, and between V and L.
[[nodiscard]] double from_mirror_deg(const Pair& pair);
[[nodiscard]] double from_retro_deg(const Pair& pair);

/// Directions read more than once. O(n), as all of these.
[[nodiscard]] RowGroups repeated_rows(const Scan& scan);

/// Readings of i -> r and of r -> i, |phi_r - phi_i| alike: equal on an isotropic surface that keeps Helmholtz's law.
/// Pair p: group 2p those of theta_i < theta_r, group 2p + 1 those of theta_i > theta_r.
struct SwappedRows {
  RowGroups groups{};

  [[nodiscard]] std::size_t size() const noexcept { return groups.size() / 2; }
};
[[nodiscard]] SwappedRows swapped_rows(const Scan& scan);
/// f(theta_i < theta_r) / f(theta_i > theta_r) of every pair, repeats averaged, where both are above 0.
[[nodiscard]] std::vector<double> swapped_ratios(const std::vector<double>& values, const SwappedRows& pairs);

/// Sweeps of the detector: readings of one incidence in one plane through the normal, in the order of the signed
/// theta_r. Lines of a single reading are among them.
[[nodiscard]] RowGroups detector_lines(const Scan& scan);

}  // namespace goniofit
