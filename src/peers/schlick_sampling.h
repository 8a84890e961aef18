#pragma once
// Importance sampling of Schlick 1994's lobe Z(t) A(w)/(4 pi v v'): facets first, by (29), then the mirror reflection
// of the viewer in the facet.
//
// t of (29) samples 2 t Z(t) exactly. Its azimuth samples neither form of A: with phi from the tangent (w = cos phi) it
// is densest along the grooves, where A is least. phi = atan(tan(pi b/2)/p) samples the normalised A exactly, and with
// a weight the printed one.

#include <optional>

#include "../geometry/samplings.h"

namespace goniofit {

/// tan² of the facet's zenith angle for a in (0, 1]: t = sqrt(a/(r - a r + a)) of (29), in the form that keeps the
/// digits of narrow lobes.
[[nodiscard]] double schlick_facet_tan2(double a, double r) noexcept;

/// phi in [0, pi/2] for b in [0, 1): the form that samples the normalised A(w), of density (2/pi) A(cos phi).
[[nodiscard]] double schlick_facet_azimuth(double b, double p) noexcept;
/// phi of (29) as printed, (pi/2) sqrt(p² b²/(1 - b² + p² b²)), and its density on [0, pi/2].
[[nodiscard]] double schlick_facet_azimuth_printed(double b, double p) noexcept;
[[nodiscard]] double schlick_facet_azimuth_printed_density(double phi, double p) noexcept;

/// A(w) at w = cos phi, normalised and as printed (its root).
[[nodiscard]] double schlick_azimuth_normalised(double phi, double p) noexcept;
[[nodiscard]] double schlick_azimuth_printed(double phi, double p) noexcept;

struct SchlickSample {
  HemispherePoint light;
  double density;         ///< of the light's direction per steradian: Z(t) A(w) t/(4 pi u), A normalised
  double printed_weight;  ///< A printed / A normalised: what the printed model multiplies its value by
};

/// A direction for the viewer's, from two uniform numbers a in (0, 1] and b in [0, 1), over all four quadrants of the
/// facet's azimuth; x is the tangent. nullopt where the reflection goes below the surface: a sample of value 0.
[[nodiscard]] std::optional<SchlickSample> sample_schlick_lobe(const HemispherePoint& viewer, double a, double b,
                                                               double r, double p) noexcept;

}  // namespace goniofit
