#include "geometry/angles.h"

#include <cmath>

namespace goniofit {

double wrap_deg(double degrees) noexcept {
  if (degrees > -180.0 && degrees <= 180.0) return degrees;  // std::remainder takes longer than the sine
  const double r = std::remainder(degrees, 360.0);           // exact, in [-180, 180]
  return r == -180.0 ? 180.0 : r;
}

namespace {

// Angle in [0, 45] degrees; the table of exact values beyond that is symmetry.
double sin_first_octant(double d) noexcept { return d == 30.0 ? 0.5 : std::sin(radians(d)); }
double cos_first_octant(double d) noexcept { return std::cos(radians(d)); }

double sin_first_quadrant(double d) noexcept { return d <= 45.0 ? sin_first_octant(d) : cos_first_octant(90.0 - d); }
double cos_first_quadrant(double d) noexcept { return d <= 45.0 ? cos_first_octant(d) : sin_first_octant(90.0 - d); }

}  // namespace

double sin_deg(double degrees) noexcept {
  const double w = wrap_deg(degrees);
  const double a = std::fabs(w);
  const double s = a <= 90.0 ? sin_first_quadrant(a) : sin_first_quadrant(180.0 - a);
  return std::copysign(s, w);
}

double cos_deg(double degrees) noexcept {
  const double a = std::fabs(wrap_deg(degrees));
  return a <= 90.0 ? cos_first_quadrant(a) : -cos_first_quadrant(180.0 - a);
}

}  // namespace goniofit
