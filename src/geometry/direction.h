#pragma once
// Directions as unit vectors: what a renderer has. N = +z; x is azimuth 0, as in AnglePair.

#include "pair.h"

namespace goniofit {

/// A unit vector (to rounding: nothing here normalises) that points away from the surface.
struct Direction {
  double x = 0.0, y = 0.0, z = 1.0;
  friend bool operator==(const Direction&, const Direction&) = default;
};

[[nodiscard]] constexpr double dot(const Direction& a, const Direction& b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// Where a mirror in the plane of the surface sends light from l.
[[nodiscard]] constexpr Direction mirrored(const Direction& l) noexcept { return {-l.x, -l.y, l.z}; }

[[nodiscard]] Direction direction_of(double theta_deg, double phi_deg) noexcept;

/// Nearer to the horizon the factors of f leave the range of doubles though f does not: at double grazing dd has sec⁴
/// of the half vector, cos^-4, and S/(cos_i cos_r). No angle in degrees but 90 itself comes closer than 1.2e-16.
inline constexpr double least_cosine = 1e-50;

/// The angles of both, azimuths in (-180, 180], 0 at the normal.
[[nodiscard]] AnglePair angles_of(const Direction& l, const Direction& v) noexcept;

/// The pair without the way through degrees. Each part is formed from L + V, L - V and the cosines, so that nothing
/// cancels but the components' own rounding: sums and differences of components are good to about 1e-16 absolute
/// where the pair of angles has 1e-16 relative, that is s_h2, tan2_b and mirror_distance2 to about 1e-16 * |s_h| near
/// the mirror (a lobe of slope 1e-6 is still resolved to 1e-10 of its width), and 1 - cos_h likewise near the retro
/// direction. At L = N there is no forward side (fs is 0 there), and the azimuth of N is 0.
///
/// A cosine above 0 but below `least_cosine` counts as that.
[[nodiscard]] Pair make_pair(const Direction& l, const Direction& v) noexcept;

}  // namespace goniofit
