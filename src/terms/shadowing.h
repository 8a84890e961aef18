#pragma once
// Shadowing and masking S = S1(cos_i) S1(cos_r), always as S1(c)/c: dd divides by both cosines, and the quotient is
// finite at grazing where S1 and c vanish together.

#include "scalar.h"
#include "zenith.h"

namespace goniofit {

/// Tier `li-torrance` (LT (6)): S1(c) = 1 - (1 - c)^q, q = tau/sigma, as -expm1(q ln(1 - c)). Its mean error
/// against tier `smith` over uniform c is 0.5 to 5 %, the largest 12.8 %, for RMS slopes (√2/q) of 0.05 to 0.5; at 1.4
/// they are 13 and 19 %.
template <class T, class G>
[[nodiscard]] [[gnu::always_inline]] inline T shadowing_li_torrance(const T& q, const G& log_one_minus_c) {
  using namespace math;
  return -expm1(T(q * log_one_minus_c));
}

/// Tier `smith` (HT (24), (25), with the e^(-a²) that the 1991 print of (25) lacks), divided by c: S1 = (1 - ½ erfc a)
/// / (1 + Λ), Λ = ½(e^(-a²)/(a√π) - erfc a), a = cot theta/(2m), m the slope sigma/tau. The difference in Λ cancels for
/// large a; S1 = p/(p + e^(-a²)), p = √π a (2 - erfc a), has none, and with a multiplied out neither has it a
/// 0/0 at grazing or an ∞/∞ at the normal: right to 2 eps for every c > 0 and slope.
template <class T, class G>
[[nodiscard]] [[gnu::always_inline]] inline T shadowing_smith_over_cosine(const T& slope, const G& c, const G& s) {
  using namespace math;
  const T a = cot_over_two_slopes(slope, c, s, gaussian_reach);
  const T lit = root_pi_of<T>() * (2.0 - erfc(a));
  return lit / (c * lit + 2.0 * slope * s * exp(-a * a));
}

/// Tier `schlick` (Schlick 1994 (19)), divided by c: G(c) = c/(c - kc + k), k = √(2 m²/π). His m is the RMS slope, √2
/// times ours (sigma/tau), so k = 2 slope/√π. He tuned it to Smith's function without its e^h; against the true one
/// (tier `smith`) its mean error over uniform c is 7 to 12 %, the largest 14 to 27 %, for RMS slopes of 0.05 to 0.5.
template <class T, class G>
[[nodiscard]] [[gnu::always_inline]] inline T shadowing_schlick_over_cosine(const T& slope, const G& c) {
  using namespace math;
  const T k = 2.0 * slope / root_pi_of<T>();
  return 1.0 / (c + k * (1.0 - c));
}

}  // namespace goniofit
