#pragma once
// Rough Lambertian surfaces, Oren & Nayar 1994: the two closed forms that they fitted to the V-cavity integral
// (v_cavity_integral.h). facet_slope is the standard deviation of the angle between facet and surface, in radians. It
// is theirs alone: not the RMS slope and not an RMS height. T is its scalar, G that of the geometry.
//
// Both forms part into functions of facet_slope and of the directions, so that a fit computes the latter once. In both
// tan(beta) cos(Δφ) sin(alpha) is dot_h / max(cos_i, cos_r), and tan((alpha+beta)/2) is (sin_i + sin_r)/(cos_i +
// cos_r): finite for all cosines > 0, though without a bound towards double grazing.

#include "../geometry/pair.h"
#include "azimuth_difference.h"
#include "scalar.h"

namespace goniofit::oren_nayar {

/// facet_slope² / (facet_slope² + hundredths/100): the shape that every coefficient has. 0 at 0, and smooth.
template <class T>
[[nodiscard]] [[gnu::always_inline]] inline T saturation(const T& facet_slope, double hundredths) {
  const T slope2 = 100.0 * facet_slope * facet_slope;
  return slope2 / (slope2 + hundredths);
}

/// C1 of (14) and A of (17).
template <class T>
[[nodiscard]] [[gnu::always_inline]] inline T flattening(const T& facet_slope) {
  return 1.0 - 0.5 * saturation(facet_slope, 33.0);
}

/// max(0, cos Δφ) sin(alpha) tan(beta), alpha the larger and beta the smaller of the zenith angles.
template <class G>
[[nodiscard]] [[gnu::always_inline]] inline G qualitative_geometry(const BasicPair<G>& p) {
  using namespace math;
  return select(p.dot_h > 0.0, p.dot_h, G(0.0)) / select(p.cos_i > p.cos_r, p.cos_i, p.cos_r);
}

/// (17), whose bracket is misprinted: A + B max(0, cos Δφ) sin(alpha) tan(beta), A = 1 - s²/(s²+0.33)/2, B = 0.45
/// s²/(s²+0.09), s = facet_slope. f = rho/pi times this; Lambert exactly at 0. At facet_slope 30° and rho = 1
/// it is within 19 % of the integral (direct and interreflection) with both angles up to 60°; at 85° on the forward
/// side 2.7 times too bright.
template <class T, class G>
[[nodiscard]] [[gnu::always_inline]] inline T qualitative(const T& facet_slope, const BasicPair<G>& p) {
  return flattening(facet_slope) + 9.0 * saturation(facet_slope, 9.0) * qualitative_geometry(p) / 20.0;
}

/// What (14) and (15) read of the directions.
template <class G>
struct FunctionalGeometry {
  G direct;           ///< factor of s²/(s²+0.09)
  G interreflection;  ///< factor of s²/(s²+0.13)
};

/// f = rho/pi direct + rho²/pi interreflection.
template <class T>
struct Functional {
  T direct, interreflection;
};

/// 2 theta/pi and 1 - 2 theta/pi, each accurate where it is small.
template <class G>
struct QuarterTurns {
  G from_normal, from_horizon;
};

template <class G>
[[nodiscard]] [[gnu::always_inline]] inline QuarterTurns<G> quarter_turns(const G& cos, const G& one_minus_cos) {
  using namespace math;
  using std::asin;
  const G right_angle = 0.5 * pi_of<G>();
  const G from_normal = 2.0 * asin(G(sqrt(G(0.5 * one_minus_cos)))) / right_angle;
  const G from_horizon = asin(cos) / right_angle;
  return {from_normal, select(cos < 0.5, from_horizon, G(1.0 - from_normal))};
}

/// The geometry of C2 tan(beta) cos Δφ + (1 - |cos Δφ|) C3 tan((alpha+beta)/2), and of (15).
/// On the forward side C2 has sin(alpha) - (2 beta/pi)³, which vanishes at double grazing where tan(beta) grows: it is
/// written as the difference of the two distances from 1.
template <class G>
[[nodiscard]] [[gnu::always_inline]] inline FunctionalGeometry<G> functional_geometry(const BasicPair<G>& p) {
  using namespace math;
  const AzimuthDifference<G> azimuth = azimuth_difference(p);
  const bool i_is_lower = p.cos_i < p.cos_r;  // L nearer to the horizon: alpha = theta_i
  const QuarterTurns<G> turns_i = quarter_turns(p.cos_i, p.one_minus_cos_i);
  const QuarterTurns<G> turns_r = quarter_turns(p.cos_r, p.one_minus_cos_r);
  const G alpha = select(i_is_lower, turns_i.from_normal, turns_r.from_normal);
  const G beta = select(i_is_lower, turns_r.from_normal, turns_i.from_normal);
  const G beyond_beta = select(i_is_lower, turns_r.from_horizon, turns_i.from_horizon);
  const G sin_alpha = select(i_is_lower, azimuth.sin_i, azimuth.sin_r);
  const G cos_alpha = select(i_is_lower, p.cos_i, p.cos_r);
  const G cos_beta = select(i_is_lower, p.cos_r, p.cos_i);

  const G cube_from_one = beyond_beta * (3.0 - beyond_beta * (3.0 - beyond_beta));  // 1 - (2 beta/pi)³
  const G sin_from_one = cos_alpha * cos_alpha / (1.0 + sin_alpha);                 // 1 - sin(alpha)
  const G safe_sin = select(sin_alpha > 0.0, sin_alpha, G(1.0));                    // dot_h is 0 where it is 0
  const G forward = (cube_from_one - sin_from_one) / safe_sin;
  const G in_plane = p.dot_h / cos_beta * select(p.dot_h < 0.0, forward, G(1.0));
  const G product = alpha * beta;
  const G across = azimuth.one_minus_abs_cos * product * product * (azimuth.sin_i + azimuth.sin_r) / p.s_z;
  // 1 - cos Δφ (2 beta/pi)², which vanishes at retro grazing.
  const G square = beta * beta;
  const G shaded = select(p.dot_h < 0.0, G(1.0 - azimuth.cos * square),
                          G(beyond_beta * (1.0 + beta) + azimuth.one_minus_abs_cos * square));
  return {9.0 * in_plane / 20.0 + across / 8.0, 17.0 * shaded / 100.0};
}

/// (14) and (15) at a geometry already computed. `direct` is uncut: see cut_at_zero. Lambert exactly at 0.
/// Against the integral at facet_slope 30° with both angles up to 60°: direct within 4.9 %, 0.5 % in the mean;
/// interreflection -29 to +49 %, 14 % in the mean. Up to 85°: direct 1.3 % in the mean but 2.3 times too bright on the
/// forward side at 85°/85°; interreflection 18 % in the mean. With rho = 1 it reflects up to 1.05 (15-20°, at grazing).
template <class T, class G>
[[nodiscard]] [[gnu::always_inline]] inline Functional<T> functional(const T& facet_slope,
                                                                     const FunctionalGeometry<G>& geometry) {
  return {flattening(facet_slope) + saturation(facet_slope, 9.0) * geometry.direct,
          saturation(facet_slope, 13.0) * geometry.interreflection};
}

template <class T, class G>
[[nodiscard]] [[gnu::always_inline]] inline Functional<T> functional(const T& facet_slope, const BasicPair<G>& p) {
  return functional(facet_slope, functional_geometry(p));
}

/// (14) turns negative at forward grazing (both angles about 80°) from a facet_slope of 40° on. No surface does, so f
/// takes the cut; the derivative is 0 there. Count the directions concerned with needs_cut.
template <class T>
[[nodiscard]] [[gnu::always_inline]] inline bool needs_cut(const T& direct) {
  return direct < 0.0;
}
template <class T>
[[nodiscard]] [[gnu::always_inline]] inline T cut_at_zero(const T& direct) {
  return math::select(needs_cut(direct), T(0.0), direct);
}

}  // namespace goniofit::oren_nayar
