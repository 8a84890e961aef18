#pragma once
// Directions for tests that look for the corners: the normal, grazing, the mirror and the retro direction are drawn as
// often as anything between them.

#include <cmath>
#include <random>

#include "geometry/direction.h"

namespace goniofit::test {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}

  double uniform(double low, double high) { return low + (high - low) * unit(); }
  double log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  /// 0 ... n - 1.
  int one_of(int n) { return std::min(n - 1, static_cast<int>(unit() * n)); }
  bool chance(double probability) { return unit() < probability; }

  double theta() {
    switch (one_of(6)) {
      case 0:
        return 0.0;
      case 1:
        return log_uniform(1e-12, 1e-2);
      case 2:
        return 90.0 - log_uniform(1e-14, 1.0);
      default:
        return uniform(0.0, 90.0);
    }
  }

  /// Some on the mirror or the retro direction exactly, some next to it, some in the plane of incidence.
  AnglePair angles() {
    AnglePair a{theta(), uniform(-180, 180), theta(), uniform(-180, 180)};
    const int kind = one_of(8);
    const double aside = kind == 1 || kind == 3 ? log_uniform(1e-12, 1.0) : 0.0;
    if (kind <= 3) a.theta_r_deg = std::fabs(a.theta_i_deg - aside);
    if (kind <= 1) a.phi_r_deg = a.phi_i_deg + 180.0 + (chance(0.5) ? aside : 0.0);
    if (kind == 2 || kind == 3) a.phi_r_deg = a.phi_i_deg + (chance(0.5) ? aside : 0.0);
    if (kind == 4) a.phi_r_deg = a.phi_i_deg + (chance(0.5) ? 180.0 : 0.0);
    return a;
  }

  /// As a renderer may have it, with cosines that no angle in degrees reaches: down to 1e-300.
  Direction grazing_direction() {
    const double phi = uniform(-180, 180);
    const double z = log_uniform(1e-300, 1e-8);
    const Direction d = direction_of(90.0, phi);
    return {d.x, d.y, z};
  }

 private:
  double unit() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }

  std::mt19937_64 random_;
};

}  // namespace goniofit::test
