#include "geometry/direction.h"

#include <algorithm>
#include <cmath>

#include "geometry/angles.h"

namespace goniofit {

namespace {

double square(double x) noexcept { return x * x; }

// 1 - z by the two other components where the difference would cancel.
double one_minus_z(const Direction& d) noexcept {
  return d.z > 0.5 ? (square(d.x) + square(d.y)) / (1.0 + d.z) : 1.0 - d.z;
}

double log_one_minus(double cos, double one_minus_cos) noexcept {
  if (cos < 0.5) return std::log1p(-cos);
  return one_minus_cos > 0.0 ? std::log(one_minus_cos) : log_of_zero;
}

struct Azimuth {
  double cos2, sin2;
};
Azimuth azimuth(const Direction& d, double sin2) noexcept {
  return sin2 > 0.0 ? Azimuth{square(d.x) / sin2, square(d.y) / sin2} : Azimuth{1.0, 0.0};
}

Direction off_the_horizon(const Direction& d) noexcept {
  return {d.x, d.y, d.z > 0.0 ? std::max(d.z, least_cosine) : d.z};
}

double degrees_from_normal(const Direction& d) noexcept { return degrees(std::atan2(std::hypot(d.x, d.y), d.z)); }
// atan2 tells zeros by their signs; the normal's azimuth is 0 whatever they are.
double azimuth_deg(const Direction& d) noexcept {
  return d.x == 0.0 && d.y == 0.0 ? 0.0 : wrap_deg(degrees(std::atan2(d.y, d.x)));
}

}  // namespace

Direction direction_of(double theta_deg, double phi_deg) noexcept {
  const double sin_theta = sin_deg(theta_deg);
  return {sin_theta * cos_deg(phi_deg), sin_theta * sin_deg(phi_deg), cos_deg(theta_deg)};
}

AnglePair angles_of(const Direction& l, const Direction& v) noexcept {
  return {degrees_from_normal(l), azimuth_deg(l), degrees_from_normal(v), azimuth_deg(v)};
}

Pair make_pair(const Direction& towards_light, const Direction& towards_viewer) noexcept {
  const Direction l = off_the_horizon(towards_light);
  const Direction v = off_the_horizon(towards_viewer);
  const double sin2_i = square(l.x) + square(l.y);
  const double sin2_r = square(v.x) + square(v.y);
  Pair p{};
  p.cos_i = l.z;
  p.cos_r = v.z;
  p.one_minus_cos_i = one_minus_z(l);
  p.one_minus_cos_r = one_minus_z(v);
  p.log_one_minus_cos_i = log_one_minus(p.cos_i, p.one_minus_cos_i);
  p.log_one_minus_cos_r = log_one_minus(p.cos_r, p.one_minus_cos_r);
  p.s_z = l.z + v.z;
  p.s_x2 = square(l.x + v.x);
  p.s_y2 = square(l.y + v.y);
  p.s_h2 = p.s_x2 + p.s_y2;
  p.cos_h = std::min(1.0, 0.5 * std::sqrt(p.s_h2 + square(p.s_z)));
  p.one_minus_cos_h = (square(l.x - v.x) + square(l.y - v.y) + square(l.z - v.z)) / (4.0 * (1.0 + p.cos_h));
  p.tan2_b = p.s_h2 / square(p.s_z);
  p.mirror_distance2 = p.s_h2 + square(v.z - l.z);
  p.dot_h = l.x * v.x + l.y * v.y;
  // LT's theta_f lies between V and -L_h/|L_h|: its tangent is V's part across that axis over the part along it.
  // Where the square underflows, L or V is the normal and fs is 0.
  const double along2 = square(p.dot_h);
  p.forward = p.dot_h < 0.0 && along2 > 0.0;
  if (p.forward) {
    const double across2 = square(l.x * v.y - l.y * v.x);
    p.tan2_f = (square(v.z) * sin2_i + across2) / along2;
    p.tan2_f_swapped = (square(l.z) * sin2_r + across2) / along2;
  }
  const Azimuth of_l = azimuth(l, sin2_i);
  const Azimuth of_v = azimuth(v, sin2_r);
  p.cos2_phi_i = of_l.cos2;
  p.sin2_phi_i = of_l.sin2;
  p.cos2_phi_r = of_v.cos2;
  p.sin2_phi_r = of_v.sin2;
  return p;
}

}  // namespace goniofit
