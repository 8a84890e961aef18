#pragma once
// Directional albedos of lobes, narrow ones included.

#include <array>
#include <cmath>

#include "peer_support.h"

namespace goniofit::test {

/// The integral of f cos over the directions, light at theta_i and azimuth 0, by the midpoint rule over the half
/// vectors: tan²theta_h = width² a/(1 - a) puts as many points in a lobe of that width as in its tail. Good to about
/// 1e-3 with 160 x 160 points.
template <class Function>  // double f(const Pair&)
[[nodiscard]] double directional_albedo(const Function& f, double theta_i_deg, double width, int n = 160) {
  const double l_x = sin_deg(theta_i_deg);
  const double l_z = cos_deg(theta_i_deg);
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    const double a = (i + 0.5) / n;
    const double tan2 = width * width * a / (1.0 - a);
    const double t = 1.0 / std::sqrt(1.0 + tan2);
    const double horizontal = t * std::sqrt(tan2);
    // d omega_h = 2 pi/n sin dtheta; d(tan²) = width²/(1-a)² da = 2 tan sec² dtheta.
    const double solid_angle =
        2.0 * pi / (n * static_cast<double>(n)) * 0.5 * width * width / ((1.0 - a) * (1.0 - a)) * t * t * t;
    for (int j = 0; j < n; ++j) {
      const double phi = 2.0 * pi * (j + 0.5) / n;
      const double h_x = horizontal * std::cos(phi);
      const double h_y = horizontal * std::sin(phi);
      const double u = l_x * h_x + l_z * t;
      const double v_z = 2.0 * u * t - l_z;
      if (u <= 0.0 || v_z <= 0.0) continue;
      const double v_x = 2.0 * u * h_x - l_x;
      const double v_y = 2.0 * u * h_y;
      const AnglePair angles{theta_i_deg, 0.0, degrees(std::atan2(std::hypot(v_x, v_y), v_z)),
                             degrees(std::atan2(v_y, v_x))};
      sum += f(make_pair(angles)) * v_z * 4.0 * u * solid_angle;
    }
  }
  return sum;
}

/// The same for what is as broad as the hemisphere: midpoint over its cosine and azimuth, good to 1e-3.
template <class Function>
[[nodiscard]] double broad_albedo(const Function& f, double theta_i_deg, int n = 200) {
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    const double cos_r = (i + 0.5) / n;
    for (int j = 0; j < n; ++j)
      sum += cos_r * f(make_pair({theta_i_deg, 0.0, degrees(std::acos(cos_r)), 360.0 * (j + 0.5) / n}));
  }
  return sum * 2.0 * pi / (n * static_cast<double>(n));
}

}  // namespace goniofit::test
