#pragma once
// Oren & Nayar 1994 (ON): the functional model (14) + (15) and the qualitative model (17), per rho and rho². Their
// sigma, the standard deviation of the facets' slope angle, is `facet_slope` in radians. Delta phi = 0 is the retro
// side.

#include "definitions.h"

namespace goniofit::truth {

/// What (14), (15) and (17) read.
template <class R>
struct OrenNayarAngles {
  R alpha, beta;  ///< the larger and the smaller zenith angle, radians
  R cos_delta;    ///< cos(phi_r - phi_i)
  R sigma2;       ///< facet_slope²

  OrenNayarAngles(const R& theta_i_deg, const R& phi_i_deg, const R& theta_r_deg, const R& phi_r_deg,
                  const R& facet_slope_deg)
      : alpha((theta_i_deg > theta_r_deg ? theta_i_deg : theta_r_deg) * pi<R>() / 180),
        beta((theta_i_deg > theta_r_deg ? theta_r_deg : theta_i_deg) * pi<R>() / 180),
        cos_delta(cos_deg(R(phi_r_deg - phi_i_deg))),
        sigma2(square(R(facet_slope_deg * pi<R>() / 180))) {}
};

/// ON (14) over cos theta_i E0, per rho.
template <class R>
[[nodiscard]] R oren_nayar_direct(const OrenNayarAngles<R>& a) {
  const R ratio_09 = a.sigma2 / (a.sigma2 + ratio<R>(9, 100));
  const R c1 = 1 - a.sigma2 / (a.sigma2 + ratio<R>(33, 100)) / 2;
  const R two_beta = 2 * a.beta / pi<R>();
  const R bracket = a.cos_delta >= 0 ? R(sin(a.alpha)) : R(sin(a.alpha) - two_beta * two_beta * two_beta);
  const R c2 = ratio<R>(45, 100) * ratio_09 * bracket;
  const R c3 = ratio_09 * square(R(4 * a.alpha * a.beta / square(pi<R>()))) / 8;
  return (c1 + a.cos_delta * c2 * tan(a.beta) + (1 - abs(a.cos_delta)) * c3 * tan((a.alpha + a.beta) / 2)) / pi<R>();
}

/// ON (15) over cos theta_i E0, per rho².
template <class R>
[[nodiscard]] R oren_nayar_interreflection(const OrenNayarAngles<R>& a) {
  return ratio<R>(17, 100) / pi<R>() * a.sigma2 / (a.sigma2 + ratio<R>(13, 100)) *
         (1 - a.cos_delta * square(R(2 * a.beta / pi<R>())));
}

/// ON (17), its misprinted bracket as A + B max(0, cos) sin(alpha) tan(beta); per rho.
template <class R>
[[nodiscard]] R oren_nayar_qualitative(const OrenNayarAngles<R>& a) {
  const R big_a = 1 - a.sigma2 / (a.sigma2 + ratio<R>(33, 100)) / 2;
  const R big_b = ratio<R>(45, 100) * a.sigma2 / (a.sigma2 + ratio<R>(9, 100));
  const R towards = a.cos_delta > 0 ? a.cos_delta : R(0);
  return (big_a + big_b * towards * sin(a.alpha) * tan(a.beta)) / pi<R>();
}

}  // namespace goniofit::truth
