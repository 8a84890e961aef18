#pragma once
// Whether directions were drawn from a density: Pearson's test over cells in polar coordinates about the mirror
// direction, narrow near it (and with an edge where the mirror cone ends), expected counts by quadrature.

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "geometry/angles.h"
#include "geometry/direction.h"

namespace goniofit::test {

/// Polar coordinates about the mirror direction of l; the azimuth is 0 towards N.
class MirrorFrame {
 public:
  explicit MirrorFrame(const Direction& l) : mirror_(mirrored(l)) {
    const double sin_theta = std::hypot(mirror_.x, mirror_.y);
    const double cos_phi = sin_theta > 0.0 ? mirror_.x / sin_theta : 1.0;
    const double sin_phi = sin_theta > 0.0 ? mirror_.y / sin_theta : 0.0;
    up_ = {-mirror_.z * cos_phi, -mirror_.z * sin_phi, sin_theta};
    across_ = {-sin_phi, cos_phi, 0.0};
  }
  [[nodiscard]] double distance(const Direction& v) const {
    const double chord = std::hypot(v.x - mirror_.x, v.y - mirror_.y, v.z - mirror_.z);
    return 2.0 * std::asin(std::min(1.0, 0.5 * chord));
  }
  [[nodiscard]] double azimuth(const Direction& v) const { return std::atan2(dot(v, across_), dot(v, up_)); }
  [[nodiscard]] Direction at(double distance, double azimuth) const {
    const double c = std::cos(distance);
    const double a = std::sin(distance) * std::cos(azimuth);
    const double b = std::sin(distance) * std::sin(azimuth);
    return {c * mirror_.x + a * up_.x + b * across_.x, c * mirror_.y + a * up_.y + b * across_.y,
            c * mirror_.z + a * up_.z + b * across_.z};
  }
  /// Where the great circle of this azimuth meets the horizon.
  [[nodiscard]] double horizon(double azimuth) const {
    return 0.5 * pi + std::atan2(up_.z * std::cos(azimuth), mirror_.z);
  }

 private:
  Direction mirror_, up_, across_;
};

class HemisphereCells {
 public:
  HemisphereCells(const Direction& l, double solid_angle_sr) : frame_(l) {
    const double cone = std::acos(1.0 - solid_angle_sr / (2.0 * pi));
    edges_ = {0.0, 0.5 * cone, cone};
    const double ratio = std::pow(pi / cone, 1.0 / far_rings);
    for (int i = 1; i <= far_rings; ++i) edges_.push_back(i == far_rings ? pi : cone * std::pow(ratio, i));
  }

  /// Integrals of the density over the cells.
  [[nodiscard]] std::vector<double> integrals(const std::function<double(const Direction&)>& density) const {
    using Rule = boost::math::quadrature::gauss<double, 10>;
    std::vector<double> result;
    for (std::size_t ring = 0; ring + 1 < edges_.size(); ++ring) {
      for (std::size_t sector = 0; sector < sectors; ++sector) {
        const double from = -pi + width * static_cast<double>(sector);
        const auto along_ray = [&](double azimuth) {
          const double end = std::min(edges_[ring + 1], frame_.horizon(azimuth));
          if (end <= edges_[ring]) return 0.0;
          const auto f = [&](double t) { return density(frame_.at(t, azimuth)) * std::sin(t); };
          return Rule::integrate(f, edges_[ring], end);
        };
        result.push_back(Rule::integrate(along_ray, from, from + width));
      }
    }
    return result;
  }

  [[nodiscard]] std::size_t cell_of(const Direction& v) const {
    const double t = frame_.distance(v);
    std::size_t ring = 0;
    while (ring + 2 < edges_.size() && t >= edges_[ring + 1]) ++ring;
    const double sector = (frame_.azimuth(v) + pi) / width;
    return ring * sectors + std::min(static_cast<std::size_t>(sector), sectors - 1);
  }
  [[nodiscard]] std::size_t size() const { return (edges_.size() - 1) * sectors; }

 private:
  static constexpr int far_rings = 20;
  static constexpr std::size_t sectors = 20;
  static constexpr double width = 2.0 * pi / sectors;
  MirrorFrame frame_;
  std::vector<double> edges_;
};

/// The probability of a chi² as large as this or larger when the counts follow the expected ones. Cells are merged in
/// their order until at least 5 are expected; what is left at the end joins the last.
inline double chi_square_p(const std::vector<double>& expected, const std::vector<double>& counted) {
  struct Cell {
    double expected = 0.0, counted = 0.0;
  };
  std::vector<Cell> cells(1);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (cells.back().expected >= 5.0) cells.emplace_back();
    cells.back().expected += expected[i];
    cells.back().counted += counted[i];
  }
  if (cells.size() > 1 && cells.back().expected < 5.0) {
    const Cell rest = cells.back();
    cells.pop_back();
    cells.back().expected += rest.expected;
    cells.back().counted += rest.counted;
  }
  double chi2 = 0.0;
  for (const Cell& c : cells) chi2 += (c.counted - c.expected) * (c.counted - c.expected) / c.expected;
  return boost::math::gamma_q(0.5 * static_cast<double>(cells.size() - 1), 0.5 * chi2);
}

}  // namespace goniofit::test
