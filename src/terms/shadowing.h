#pragma once
// Shadowing and masking S = S1(cos_i) S1(cos_r), always as S1(c)/c: dd divides by both cosines, and the quotient is
// finite at grazing where S1 and c vanish together.

#include "../geometry/pair.h"
#include "scalar.h"
#include "tiers.h"

namespace goniofit {

/// Tier `li-torrance` (LT (6)): S1(c) = 1 - (1 - c)^q, q = tau/sigma, as -expm1(q ln(1 - c)).
template <class T, class G, class Floor = math::NoFloor>
[[nodiscard]] [[gnu::always_inline]] inline T shadowing_li_torrance(const T& q, const G& log_one_minus_c,
                                                                    Floor floor = {}) {
  using namespace math;
  return -expm1(floored(T(q * log_one_minus_c), floor));
}

/// S / (cos_i cos_r) at the given tier. q = tau/sigma = 1/slope.
template <ShadowingTier tier, class T, class G, class Floor = math::NoFloor>
[[nodiscard]] [[gnu::always_inline]] inline T shadowing_over_cosines(const T& q, const BasicPair<G>& p,
                                                                     Floor floor = {}) {
  if constexpr (tier == ShadowingTier::li_torrance) {
    return shadowing_li_torrance(q, p.log_one_minus_cos_i, floor) *
           shadowing_li_torrance(q, p.log_one_minus_cos_r, floor) / (p.cos_i * p.cos_r);
  } else {
    return T(1.0 / (p.cos_i * p.cos_r));
  }
}

}  // namespace goniofit
