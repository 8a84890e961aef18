#pragma once
// What the tests of the peers share.

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <random>
#include <string_view>
#include <vector>

#include "basis/optics.h"
#include "geometry/angles.h"
#include "peers/peers.h"

namespace goniofit::test {

using Big = boost::multiprecision::cpp_bin_float_50;

/// The same geometry in 50 digits: what differs afterwards is round-off of the formula alone.
[[nodiscard]] inline BasicPair<Big> wide(const Pair& p) {
  return {p.cos_i,
          p.cos_r,
          p.one_minus_cos_i,
          p.one_minus_cos_r,
          p.log_one_minus_cos_i,
          p.log_one_minus_cos_r,
          p.s_z,
          p.s_h2,
          p.cos_h,
          p.one_minus_cos_h,
          p.tan2_b,
          p.mirror_distance2,
          p.tan2_f,
          p.tan2_f_swapped,
          p.dot_h,
          p.s_x2,
          p.s_y2,
          p.cos2_phi_i,
          p.sin2_phi_i,
          p.cos2_phi_r,
          p.sin2_phi_r,
          p.forward};
}

/// The sum over columns, one channel. No peer has a squared coefficient or reads the wavelength.
[[nodiscard]] inline double value(const Basis& basis, const Pair& p, const std::vector<double>& z,
                                  const std::vector<double>& coefficients, const ChannelOptics& optics,
                                  FresnelTier tier) {
  std::vector<double> factors(basis.columns().size());
  basis.shape_factors(p, z, 0.55, factors);
  double sum = 0.0;
  for (std::size_t j = 0; j < factors.size(); ++j) {
    const BasisColumn& column = basis.columns()[j];
    sum += coefficients[column.coefficient] * optics_factor(column.optics, tier, optics, p) * factors[j];
  }
  return sum;
}

/// Every coefficient as large as a white surface's: 1, or the lesser bound.
[[nodiscard]] inline std::vector<double> unit_coefficients(const Basis& basis) {
  std::vector<double> out;
  for (const BasisCoefficient& c : basis.coefficients()) out.push_back(std::min(1.0, c.upper));
  return out;
}

/// z between the bounds: 0 the lower, 1 the upper.
[[nodiscard]] inline double between(const ShapeParameter& s, double fraction) {
  return std::log(s.lower - s.origin) + fraction * std::log((s.upper - s.origin) / (s.lower - s.origin));
}

[[nodiscard]] inline std::vector<double> random_shape(const Basis& basis, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<double> z;
  for (const ShapeParameter& s : basis.shape_parameters()) z.push_back(between(s, uniform(random)));
  return z;
}

/// Half the pairs anywhere, half in a corner: grazing, normal, next to the mirror or the retro direction, or on it.
[[nodiscard]] inline AnglePair random_pair(std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const auto theta = [&] {
    switch (static_cast<int>(uniform(random) * 6.0)) {
      case 0:
        return 90.0 - std::pow(10.0, -13.0 * uniform(random));
      case 1:
        return std::pow(10.0, -12.0 * uniform(random));
      default:
        return degrees(std::acos(uniform(random)));
    }
  };
  AnglePair a{theta(), 360.0 * uniform(random), theta(), 360.0 * uniform(random)};
  const double offset = std::pow(10.0, -12.0 * uniform(random));
  switch (static_cast<int>(uniform(random) * 8.0)) {
    case 0:
      a.theta_r_deg = a.theta_i_deg, a.phi_r_deg = a.phi_i_deg + 180.0;
      break;
    case 1:
      a.theta_r_deg = std::fabs(a.theta_i_deg - offset), a.phi_r_deg = a.phi_i_deg + 180.0 + offset;
      break;
    case 2:
      a.theta_r_deg = std::fabs(a.theta_i_deg - offset), a.phi_r_deg = a.phi_i_deg + offset;
      break;
    case 3:
      a.theta_r_deg = a.theta_i_deg, a.phi_r_deg = a.phi_i_deg;
      break;
    default:
      break;
  }
  return a;
}

}  // namespace goniofit::test
