#pragma once
// Scans as large as the tabulated ones, on a grid of half angles as MERL's.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <random>
#include <string>

#include "brdf/evaluator.h"
#include "fit/settings.h"
#include "geometry/angles.h"
#include "scan/scan.h"
#include "support/materials.h"

namespace goniofit::test {

/// The pair of directions of an isotropic half-angle parametrisation, L's azimuth 0.
[[nodiscard]] inline AnglePair of_half_angles(double theta_h, double theta_d, double phi_d) {
  const double x = std::sin(theta_d) * std::cos(phi_d);
  const double y = std::sin(theta_d) * std::sin(phi_d);
  const double z = std::cos(theta_d);
  const double l_x = std::cos(theta_h) * x + std::sin(theta_h) * z;
  const double l_z = std::cos(theta_h) * z - std::sin(theta_h) * x;
  const double v_x = 2.0 * z * std::sin(theta_h) - l_x;
  const double v_z = 2.0 * z * std::cos(theta_h) - l_z;
  const double azimuth = degrees(std::atan2(-y, v_x) - std::atan2(y, l_x));
  return {degrees(std::acos(std::clamp(l_z, -1.0, 1.0))), 0.0, degrees(std::acos(std::clamp(v_z, -1.0, 1.0))),
          wrap_deg(azimuth)};
}

/// Some `readings` of a material with relative noise, up to 85°: MERL's steps of theta_h, which are dense at the
/// mirror.
[[nodiscard]] inline Scan half_angle_scan(const Material& material, std::size_t readings, double noise) {
  constexpr int steps = 90;
  const int turns = static_cast<int>(static_cast<double>(readings) / (0.685 * steps * steps));  // the rest is below 85°
  const Evaluator evaluator(material);
  Scan scan;
  scan.name = "half angles";
  for (const MaterialChannel& c : material.channels) scan.channels.push_back({c.name, c.wavelength_um, {}, {}, {}, {}});
  std::mt19937_64 bits(1);
  std::normal_distribution<double> normal;
  for (int h = 0; h < steps; ++h) {
    for (int d = 0; d < steps; ++d) {
      for (int p = 0; p < turns; ++p) {
        const double half = radians(90.0) * std::pow((h + 0.5) / steps, 2);
        const AnglePair a = of_half_angles(half, radians(90.0) * (d + 0.5) / steps, pi * (p + 0.5) / turns);
        if (std::max(a.theta_i_deg, a.theta_r_deg) > 85.0) continue;
        scan.theta_i_deg.push_back(a.theta_i_deg);
        scan.phi_i_deg.push_back(a.phi_i_deg);
        scan.theta_r_deg.push_back(a.theta_r_deg);
        scan.phi_r_deg.push_back(a.phi_r_deg);
        const Pair pair = make_pair(a);
        for (std::size_t c = 0; c < scan.channels.size(); ++c)
          scan.channels[c].values.push_back(evaluator.value(pair, c) * (1.0 + noise * normal(bits)));
      }
    }
  }
  for (ScanChannel& c : scan.channels) c.values.shrink_to_fit();
  for (auto* angles : {&scan.theta_i_deg, &scan.phi_i_deg, &scan.theta_r_deg, &scan.phi_r_deg}) angles->shrink_to_fit();
  return scan;
}

/// What such scans of the laser paper are fitted with.
[[nodiscard]] inline FitSettings paper_settings() {
  FitSettings s;
  s.components = EffectSet{Effect::dd, Effect::uds, Effect::fs};
  s.n = {1.5};
  return s;
}

[[nodiscard]] inline Material paper_with_slope(double slope) {
  Material m = laser_paper_73();
  m.surface = {};
  m.surface.slope = slope;
  return m;
}

/// Of this process, in bytes, by its key in /proc/self/status ("VmHWM:"); 0 where the kernel does not tell.
[[nodiscard]] inline double process_memory(const std::string& key) {
  std::ifstream in("/proc/self/status");
  for (std::string word; in >> word;) {
    double kilobytes = 0.0;
    if (word == key && in >> kilobytes) return 1024.0 * kilobytes;
  }
  return 0.0;
}

}  // namespace goniofit::test
