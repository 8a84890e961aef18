#include "geometry/samplings.h"

#include <algorithm>
#include <cmath>

#include "geometry/angles.h"

namespace goniofit {

HemispherePoint square_to_hemisphere(SquarePoint p) noexcept {
  const double x = 2.0 * p.u - 1.0;
  const double y = 2.0 * p.v - 1.0;
  if (x == 0.0 && y == 0.0) return {0.0, 0.0};
  // Each of the four triangles of the square becomes a quarter of the disc; |r| is the distance in the maximum norm.
  const bool wide = std::fabs(x) > std::fabs(y);
  const double r = wide ? x : y;
  double phi_deg = wide ? 45.0 * (y / x) : 90.0 - 45.0 * (x / y);
  if (r < 0.0) phi_deg += 180.0;
  // Equal area on the disc is equal solid angle with z = 1 - r²; 1 - z = 2 sin²(theta/2).
  const double theta = 2.0 * std::asin(std::min(1.0, std::fabs(r) / std::sqrt(2.0)));
  return {degrees(theta), wrap_deg(phi_deg)};
}

SquarePoint hemisphere_to_square(HemispherePoint p) noexcept {
  const double r = std::sqrt(2.0) * sin_deg(0.5 * p.theta_deg);
  // Into [-45, 315): which triangle, and where across it.
  double phi = wrap_deg(p.phi_deg);
  if (phi < -45.0) phi += 360.0;
  double x = 0.0;
  double y = 0.0;
  if (phi < 45.0) {
    x = r;
    y = r * (phi / 45.0);
  } else if (phi < 135.0) {
    y = r;
    x = r * ((90.0 - phi) / 45.0);
  } else if (phi < 225.0) {
    x = -r;
    y = -r * ((phi - 180.0) / 45.0);
  } else {
    y = -r;
    x = r * ((phi - 270.0) / 45.0);
  }
  return {0.5 * (x + 1.0), 0.5 * (y + 1.0)};
}

std::vector<HemispherePoint> square_cell_centres(std::size_t n) {
  std::vector<HemispherePoint> points;
  points.reserve(n * n);
  const auto cells = static_cast<double>(n);
  for (std::size_t row = 0; row < n; ++row) {
    for (std::size_t column = 0; column < n; ++column) {
      points.push_back(square_to_hemisphere(
          {(static_cast<double>(column) + 0.5) / cells, (static_cast<double>(row) + 0.5) / cells}));
    }
  }
  return points;
}

std::vector<AnglePair> incidence_plane_sampling() {
  std::vector<AnglePair> pairs;
  for (const double theta_i : {15.0, 30.0, 45.0, 60.0, 75.0}) {
    std::vector<double> theta_r;
    // A coarse sweep of the plane, finer steps within 15 degrees of the mirror direction, finest within 4.
    for (int d = -85; d <= 85; d += 5) theta_r.push_back(d);
    for (int k = -15; k <= 15; ++k) theta_r.push_back(theta_i + k);
    for (int k = -8; k <= 8; ++k) theta_r.push_back(theta_i + 0.5 * k);
    std::erase_if(theta_r, [](double d) { return std::fabs(d) > 85.0; });
    std::sort(theta_r.begin(), theta_r.end());
    theta_r.erase(std::unique(theta_r.begin(), theta_r.end()), theta_r.end());
    for (const double d : theta_r) pairs.push_back(in_plane(theta_i, d));
  }
  return pairs;
}

std::vector<AnglePair> hemisphere_sampling(bool with_mirror) {
  const std::vector<HemispherePoint> cells = square_cell_centres(21);
  std::vector<AnglePair> pairs;
  pairs.reserve(8 * (cells.size() + 1));
  for (int theta_i = 10; theta_i <= 80; theta_i += 10) {
    for (const HemispherePoint& p : cells) {
      pairs.push_back({static_cast<double>(theta_i), 0.0, p.theta_deg, p.phi_deg});
    }
    if (with_mirror) pairs.push_back(in_plane(theta_i, theta_i));
  }
  return pairs;
}

}  // namespace goniofit
