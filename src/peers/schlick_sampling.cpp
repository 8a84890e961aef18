#include "peers/schlick_sampling.h"

#include <cmath>

#include "geometry/angles.h"

namespace goniofit {

double schlick_facet_tan2(double a, double r) noexcept { return r * (1.0 - a) / a; }

double schlick_facet_azimuth(double b, double p) noexcept {
  const double quarter = 0.5 * pi * b;
  return std::atan2(std::sin(quarter), p * std::cos(quarter));
}

double schlick_facet_azimuth_printed(double b, double p) noexcept {
  const double pb = p * b;
  return 0.5 * pi * pb / std::sqrt(1.0 - b * b + pb * pb);
}

// b = x/sqrt(p² + (1 - p²) x²) with x = phi/(pi/2), differentiated.
double schlick_facet_azimuth_printed_density(double phi, double p) noexcept {
  const double x = phi / (0.5 * pi);
  const double below = p * p + (1.0 - p * p) * x * x;
  return p * p / (below * std::sqrt(below)) / (0.5 * pi);
}

double schlick_azimuth_normalised(double phi, double p) noexcept {
  const double c = std::cos(phi);
  const double s = std::sin(phi);
  return p / (p * p * s * s + c * c);
}

double schlick_azimuth_printed(double phi, double p) noexcept { return std::sqrt(schlick_azimuth_normalised(phi, p)); }

std::optional<SchlickSample> sample_schlick_lobe(const HemispherePoint& viewer, double a, double b, double r,
                                                 double p) noexcept {
  const double quadrant = std::floor(4.0 * b);
  const double phi = schlick_facet_azimuth(4.0 * b - quadrant, p);
  const double cos_phi = quadrant == 1.0 || quadrant == 2.0 ? -std::cos(phi) : std::cos(phi);
  const double sin_phi = quadrant >= 2.0 ? -std::sin(phi) : std::sin(phi);
  const double tan2 = schlick_facet_tan2(a, r);
  const double t = 1.0 / std::sqrt(1.0 + tan2);
  const double horizontal = std::sqrt(tan2) * t;

  const double sin_v = sin_deg(viewer.theta_deg);
  const double v_x = sin_v * cos_deg(viewer.phi_deg);
  const double v_y = sin_v * sin_deg(viewer.phi_deg);
  const double v_z = cos_deg(viewer.theta_deg);
  const double u = v_x * horizontal * cos_phi + v_y * horizontal * sin_phi + v_z * t;
  const double l_x = 2.0 * u * horizontal * cos_phi - v_x;
  const double l_y = 2.0 * u * horizontal * sin_phi - v_y;
  const double l_z = 2.0 * u * t - v_z;
  if (!(u > 0.0) || !(l_z > 0.0)) return std::nullopt;

  const double azimuth = schlick_azimuth_normalised(phi, p);
  const double zenith = r * (1.0 + tan2) * (1.0 + tan2) / ((tan2 + r) * (tan2 + r));
  return SchlickSample{{degrees(std::atan2(std::hypot(l_x, l_y), l_z)), degrees(std::atan2(l_y, l_x))},
                       zenith * azimuth * t / (4.0 * pi * u),
                       1.0 / std::sqrt(azimuth)};
}

}  // namespace goniofit
