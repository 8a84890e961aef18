#pragma once
// A pair of directions in 50 digits, from the degrees themselves: every member by its plain definition on 100 digits,
// of which the cancellations near the normal, the mirror and the retro direction (28 digits at 1e-12°) leave enough.
// Nothing here shares a rearrangement with src/geometry.

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "geometry/pair.h"

namespace goniofit::test {

using Big = boost::multiprecision::cpp_bin_float_50;

namespace big_pair {

using Wide = boost::multiprecision::cpp_bin_float_100;

/// Reduced to the first octant in degrees, where it is exact: azimuths 180° apart are opposite to the last bit.
[[nodiscard]] inline Wide sin_deg(const Wide& degrees) {
  Wide d = fmod(degrees, Wide(360));
  if (d < 0) d += 360;
  const Wide sign = d < 180 ? 1 : -1;
  if (d >= 180) d -= 180;
  if (d > 90) d = 180 - d;
  const Wide degree = boost::math::constants::pi<Wide>() / 180;
  return sign * (d <= 45 ? Wide(sin(Wide(d * degree))) : Wide(cos(Wide((90 - d) * degree))));
}
[[nodiscard]] inline Wide cos_deg(const Wide& degrees) { return sin_deg(degrees + 90); }

[[nodiscard]] inline Wide square(const Wide& x) { return x * x; }

/// 1/cos² - 1 of LT's theta_f for a viewer at this sine and azimuth difference.
[[nodiscard]] inline Wide tan2_forward(const Wide& sine, const Wide& cos_delta) {
  return 1 / square(sine * cos_delta) - 1;
}

}  // namespace big_pair

[[nodiscard]] inline BasicPair<Big> big_pair_of(const AnglePair& a) {
  using namespace big_pair;
  const Wide sin_i = big_pair::sin_deg(a.theta_i_deg);
  const Wide sin_r = big_pair::sin_deg(a.theta_r_deg);
  const Wide cos_i = big_pair::cos_deg(a.theta_i_deg);
  const Wide cos_r = big_pair::cos_deg(a.theta_r_deg);
  const Wide cos_phi_i = big_pair::cos_deg(a.phi_i_deg);
  const Wide sin_phi_i = big_pair::sin_deg(a.phi_i_deg);
  const Wide cos_phi_r = big_pair::cos_deg(a.phi_r_deg);
  const Wide sin_phi_r = big_pair::sin_deg(a.phi_r_deg);
  const Wide cos_delta = big_pair::cos_deg(Wide(a.phi_r_deg) - Wide(a.phi_i_deg));
  const Wide s_x = sin_i * cos_phi_i + sin_r * cos_phi_r;
  const Wide s_y = sin_i * sin_phi_i + sin_r * sin_phi_r;
  const Wide s_z = cos_i + cos_r;
  const Wide s_h2 = square(s_x) + square(s_y);
  const Wide dot = sin_i * sin_r * cos_delta + cos_i * cos_r;
  const Wide cos_h = sqrt(Wide((1 + dot) / 2));
  // |L - V|², for 1 - cos_h: exactly 0 at the retro direction, as no rounded cosine is.
  const Wide distance2 = square(sin_i * cos_phi_i - sin_r * cos_phi_r) + square(sin_i * sin_phi_i - sin_r * sin_phi_r) +
                         square(cos_i - cos_r);
  const bool forward = sin_r > 0 && cos_delta < 0;
  const auto log_of = [](const Wide& one_minus_cos) {
    return one_minus_cos > 0 ? Wide(log(one_minus_cos)) : Wide(log_of_zero);
  };
  const Wide tan2_f = forward ? tan2_forward(sin_r, cos_delta) : Wide(0);
  const Wide tan2_f_swapped = forward && sin_i > 0 ? tan2_forward(sin_i, cos_delta) : Wide(0);
  return {.cos_i = Big(cos_i),
          .cos_r = Big(cos_r),
          .one_minus_cos_i = Big(1 - cos_i),
          .one_minus_cos_r = Big(1 - cos_r),
          .log_one_minus_cos_i = Big(log_of(1 - cos_i)),
          .log_one_minus_cos_r = Big(log_of(1 - cos_r)),
          .s_z = Big(s_z),
          .s_h2 = Big(s_h2),
          .cos_h = Big(cos_h),
          .one_minus_cos_h = Big(distance2 / (4 * (1 + cos_h))),
          .tan2_b = Big(s_h2 / square(s_z)),
          .mirror_distance2 = Big(s_h2 + square(cos_i - cos_r)),
          .tan2_f = Big(tan2_f),
          .tan2_f_swapped = Big(tan2_f_swapped),
          .dot_h = Big(sin_i * sin_r * cos_delta),
          .s_x2 = Big(square(s_x)),
          .s_y2 = Big(square(s_y)),
          .cos2_phi_i = Big(square(cos_phi_i)),
          .sin2_phi_i = Big(square(sin_phi_i)),
          .cos2_phi_r = Big(square(cos_phi_r)),
          .sin2_phi_r = Big(square(sin_phi_r)),
          .forward = forward};
}

}  // namespace goniofit::test
