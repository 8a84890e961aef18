#pragma once
// Schlick 1994 (22)-(33). t = N·H, u = V·H, v and v' the cosines of the two directions, w the cosine between the
// tangent (x, the grooves) and the projection of H onto the surface.
//
//   SINGLE  R = S(u) D(t, v, v', w),                       S(u) = C + (1 - C)(1 - u)⁵
//   DOUBLE  R = S D + (1 - S) S' D',                       each layer with its own C, r, p
//   D = a/pi + b/(4 pi v v') B(t, v, v', w) + c/v Delta,   b = 4 r (1 - r), a = 1 - b for r > ½, c = 1 - b for r < ½,
//                                                          else 0: Lambert's surface at r = 1, a mirror at r = 0
//   B = G(v) G(v') Z(t) A(w) + 1 - G(v) G(v')              the light that is shadowed comes out anyhow
//   G(v) = v/(r - r v + v),   Z(t) = r/(1 + r t² - t²)²    Z/pi is GGX's D with alpha² = r
//   A(w) = sqrt(p/(p² - p² w² + w²))  `printed`, or without the root `normalised`.
//
// A without the root meets Schlick's own condition, the mean over azimuth being 1, for every p; with it the mean is
// below 1 (0.99 at p = 0.7, 0.62 at p = 0.05). Both are 1 at p = 1. Within one plane of incidence A is a constant
// factor: such a scan does not tell p from C, and the isotropic models leave p out.
//
// Delta is a mirror reflection. Through an instrument it is c/(v dw) inside the mirror cone of solid angle dw, the
// convention of LT's coherent component, v being the incident cosine: the only part that is not reciprocal (2 % at 60°
// across a cone of 0.0005 sr).
//
// All else is symmetric in L and V. It does not conserve energy, 1/(v v') being unbounded: at r = ½ the white albedo is
// 0.64 at the normal, passes 1 at 59° and is 5.6 at 85° (of the lobe without G, (25), 4.3).

#include <memory>

#include "lobes.h"

namespace goniofit {

enum class SchlickAzimuth { isotropic, normalised, printed };

/// Z(t) with r = e^z, by tan² of the facet.
template <class T, class G>
[[nodiscard]] T schlick_zenith(const T& r, const BasicPair<G>& p) {
  const T below = p.tan2_b + r;
  const G sec2 = 1.0 + p.tan2_b;
  return r * (sec2 * sec2) / (below * below);
}

/// A(w), w² = s_x²/(s_x² + s_y²). H = N has no azimuth, and A is taken as 1 there, its mean: no limit exists.
template <SchlickAzimuth form, class T, class G>
[[nodiscard]] T schlick_azimuth(const T& p, const BasicPair<G>& pair) {
  using namespace math;
  const G sum = pair.s_x2 + pair.s_y2;
  if (form == SchlickAzimuth::isotropic || !(sum > 0.0)) return T(1.0);
  T a = p * sum / (p * p * pair.s_y2 + pair.s_x2);
  if constexpr (form == SchlickAzimuth::printed) return sqrt(a);
  return a;
}

/// D. z = {ln r, ln p}; mirror is Delta/v at this pair, 1/(v dw) inside the cone.
template <SchlickAzimuth form, class T, class G>
[[nodiscard]] T schlick_directional(const BasicPair<G>& pair, const T* z, const G& mirror) {
  using namespace math;
  const T r = exp(z[0]);
  const T smoothness = -expm1(z[0]);  // 1 - r
  const T p = form == SchlickAzimuth::isotropic ? T(1.0) : exp(z[1]);
  // G(v) = v/g and 1 - G(v) = r (1 - v)/g: neither is a difference.
  const T g_i = pair.cos_i + r * pair.one_minus_cos_i;
  const T g_r = pair.cos_r + r * pair.one_minus_cos_r;
  const T hidden_i = r * pair.one_minus_cos_i / g_i;
  const T hidden_r = r * pair.one_minus_cos_r / g_r;
  const T lobe = schlick_zenith(r, pair) * schlick_azimuth<form>(p, pair) / (g_i * g_r);
  const T emitted = (hidden_i + hidden_r - hidden_i * hidden_r) / (pair.cos_i * pair.cos_r);
  const T polar = r - smoothness;  // 1 - b = (2r - 1)²
  const T rest = polar * polar;
  const bool diffuse = polar > 0.0;
  return r * smoothness / pi_of<G>() * (lobe + emitted) + rest * (diffuse ? G(white_lambert<G>()) : mirror);
}

/// S(u) = C weight(u) + (1 - u)⁵: the weight 1 - (1 - u)⁵ without a cancellation at grazing.
template <class G>
[[nodiscard]] G schlick_white(const BasicPair<G>& p) {
  return math::pow5(p.one_minus_cos_h);
}
template <class G>
[[nodiscard]] G schlick_coloured(const BasicPair<G>& p) {
  const G x = p.one_minus_cos_h;
  return p.cos_h * (1.0 + x * (1.0 + x * (1.0 + x * (1.0 + x))));
}

template <SchlickAzimuth form>
struct SchlickSingle {
  static constexpr std::size_t columns = 2, parameters = form == SchlickAzimuth::isotropic ? 1 : 2;

  template <class T, class G>
  static void factors(const BasicPair<G>& p, const T* z, T* values) {
    through_instrument(p, z, G(0.0), values);
  }
  template <class T, class G>
  static void through_instrument(const BasicPair<G>& p, const T* z, const G& mirror, T* values) {
    const T d = schlick_directional<form>(p, z, mirror);
    values[0] = d * schlick_coloured(p);
    values[1] = d * schlick_white(p);
  }
};

/// Layer 1 is the clear one: S = F(u) of the channel's n, kappa or f0. Layer 2 has the colour C_2.
template <SchlickAzimuth form>
struct SchlickDouble {
  static constexpr std::size_t layer = form == SchlickAzimuth::isotropic ? 1 : 2;
  static constexpr std::size_t columns = 3, parameters = 2 * layer;

  template <class T, class G>
  static void factors(const BasicPair<G>& p, const T* z, T* values) {
    through_instrument(p, z, G(0.0), values);
  }
  template <class T, class G>
  static void through_instrument(const BasicPair<G>& p, const T* z, const G& mirror, T* values) {
    const T below = schlick_directional<form>(p, z + layer, mirror);
    values[0] = schlick_directional<form>(p, z, mirror);
    values[1] = below * schlick_coloured(p);
    values[2] = below * schlick_white(p);
  }
};

/// solid_angle_sr is the mirror cone's; 0 leaves the mirror part out (its weight c stays missing from the energy).
/// Errors: usage_error if it is negative or not a number.
[[nodiscard]] std::unique_ptr<const Basis> make_schlick_single(SchlickAzimuth form, double solid_angle_sr);
[[nodiscard]] std::unique_ptr<const Basis> make_schlick_double(SchlickAzimuth form, double solid_angle_sr);

}  // namespace goniofit
