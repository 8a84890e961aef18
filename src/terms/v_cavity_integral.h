#pragma once
// Rough Lambertian surfaces, Oren & Nayar 1994 (13): the integral that their functional and qualitative forms
// (oren_nayar.h) approximate. Facets' slope angles have the density P(theta_a) ~ exp(-theta_a²/(2 facet_slope²)) over
// area, in [0, pi/2], with the integral of P sin(theta_a) equal to 1 and the mean over azimuth of (12).

#include <array>
#include <vector>

#include "../geometry/pair.h"
#include "v_cavity.h"

namespace goniofit {

/// f = rho/pi direct + rho²/pi interreflection. Two bounces: with rho = 1 the two reflect at most 1.
struct VCavities {
  double direct = 0.0, interreflection = 0.0;
  double direct_by_facet_slope = 0.0, interreflection_by_facet_slope = 0.0;  ///< per radian
  double error_estimate = 0.0;  ///< relative, the largest of the four; cautious by orders of magnitude
};

/// Adaptive Gauss-Kronrod over theta_a, split where facets begin to turn away and where the order of the kinks in
/// azimuth changes. The density alone knows facet_slope: both derivatives come from the same facets.
/// facet_slope: radians, >= 0, any; at 0 Lambert exactly. tolerance: relative, of both values, and of both derivatives
/// against the integral of their absolute integrand; at least 1e-9. The direct part has an absolute error of 1e-15
/// besides, which is felt at double forward grazing: it vanishes there. About 0.3 ms at 1e-6, 3 ms with both directions
/// at 89.9999°. Zeros for a pair outside the domain.
[[nodiscard]] VCavities gaussian_cavities(const Pair& pair, double facet_slope, double tolerance = 1e-6);

/// Fifteen slope angles of the quadrature: what they reflect does not depend on facet_slope.
struct CavityPanel {
  double from, to;       ///< in the unit interval of its segment
  double first, length;  ///< the segment in theta_a
  std::array<double, 15> theta, measure, direct_minus_one, interreflection;
};

/// The integral of one pair for many facet slopes, as a fit asks for it: the facets are computed once, fine enough for
/// every facet slope of a range. Some microseconds a value.
class VCavityTable {
 public:
  /// 0 < smallest <= largest, radians; tolerance as above. Costs two or three calls of gaussian_cavities.
  VCavityTable(const Pair& pair, double smallest_facet_slope, double largest_facet_slope, double tolerance = 1e-6);

  /// As gaussian_cavities, to the tolerance; integrated afresh outside the range.
  [[nodiscard]] VCavities at(double facet_slope) const;

 private:
  Pair pair_;
  double smallest_, largest_, tolerance_;
  std::vector<CavityPanel> panels_;
};

}  // namespace goniofit
