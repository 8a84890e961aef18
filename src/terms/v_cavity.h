#pragma once
// The surface of Oren & Nayar 1994: Lambertian facets in long symmetric V-cavities. A facet's normal a stands at the
// zenith angle theta_a and the azimuth phi_a, the other side of its groove at theta_a and phi_a + pi. All values are
// factors of the BRDF, f = rho/pi direct + rho²/pi interreflection, so that 1 and 0 are Lambert's.
//
// With A = <s,a>/(<s,n><a,n>) = 1 + tan(theta_a) tan(theta_i) cos(phi_a - phi_i), and B the same for the viewer, (5)
// reads direct = cos(theta_a) A B GAF and GAF = min(1, 2/A, 2/B); A + A' = 2 for the two sides of a groove.

#include "../geometry/pair.h"

namespace goniofit {

struct FacetReflectance {
  double direct = 0.0, interreflection = 0.0;
};

/// What the cavities read of a pair. Both cosines must be > 0.
struct CavityView {
  double tan_i, tan_r;
  double cos_delta, sin_delta, delta;  ///< of the azimuth from L to V, folded into [0, pi]
};
[[nodiscard]] CavityView make_cavity_view(const Pair& pair) noexcept;

/// The geometric attenuation factor (5), max(0, min(1, 2/A, 2/B)): with the inner Max as printed a facet would be
/// attenuated by the lesser of shadowing and masking. 0 for a facet that faces away from either.
[[nodiscard]] double geometric_attenuation(double a, double b) noexcept;

/// The interreflection factor of (9)-(11) divided by pi and by both exposed widths: integral of the kernel (7) from
/// the groove's hidden widths to 1, 1/2 [d(1,m_v) + d(1,m_s) - d(m_s,m_v) - d(1,1)] / ((1-m_s)(1-m_v)), d(x,y) =
/// sqrt(x² + 2xy cos(2 theta_a) + y²). The widths `lit` = 1-m_s and `seen` = 1-m_v lie in (0, 1]. No differences of
/// near equals: all four d meet where a groove is nearly hidden.
[[nodiscard]] double interreflection_density(double cos_a, double lit, double seen) noexcept;

/// One facet, (5) and (9): its own light, and that which it receives from the other side of its groove. phi_a is the
/// azimuth from that of L, turning towards V. A uni-directional single-slope surface is the mean of phi_a and
/// phi_a + pi. theta_a in [0, pi/2). 0 for a pair outside the domain.
[[nodiscard]] FacetReflectance uni_directional_facet(const Pair& pair, double theta_a, double phi_a) noexcept;

/// (12): the mean over phi_a, cavities of one slope in every direction. Split at every angle where a facet turns its
/// back or GAF switches; direct in closed form, interreflection by Gauss-Legendre where a groove is partly hidden.
/// Errors against long doubles with three times the points, directions up to 89.99° and every theta_a: direct 5e-15
/// relative (absolute below 1), interreflection 4e-9 of values up to 0.5.
[[nodiscard]] FacetReflectance isotropic_single_slope(const Pair& pair, double theta_a) noexcept;

/// The same as direct - 1 (accurate for small theta_a) and interreflection.
struct CavityDeviation {
  double direct_minus_one, interreflection;
};
[[nodiscard]] CavityDeviation isotropic_deviation(const CavityView& view, double theta_a) noexcept;

}  // namespace goniofit
