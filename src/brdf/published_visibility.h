#pragma once
// Shadowing and the effective roughness of tiers li-torrance for the lanes of a loop: one exponential a direction.

#include <limits>

#include "../support/lane_math.h"

namespace goniofit::block {

/// Of one direction: S1 = 1 - (1-c)^q and what sigma_e reads, 1 - (1-c)^(1.6 q) and its remainder.
template <class T>
struct Published {
  T lit, seen, hidden;
};

/// From here on S1 and 1 - w⁸ are 1 to the last digit, while squares of w⁸ would be denormal numbers.
template <class T>
inline constexpr double all_lit = std::numeric_limits<T>::digits <= 24 ? 0.99 : 0.9998;

/// Both powers are of w = (1-c)^(q/5): 1 - w⁵ and 1 - w⁸ are multiples of 1 - w.
template <class T>
[[gnu::always_inline]] inline Published<T> published(T inverse_slope, T log_one_minus_cos) {
  const T full = -expm1(T(0.2 * inverse_slope * log_one_minus_cos));
  const T rise = select(full < all_lit<T>, full, T(all_lit<T>));
  const T w = 1.0 - rise;
  const T w2 = w * w;
  const T w4 = w2 * w2;
  const T both = rise * (1.0 + w) * (1.0 + w2);  // 1 - w⁴
  return {both + rise * w4, both * (1.0 + w4), w4 * w4};
}

/// 1 - i.seen r.seen without a difference of near equals.
template <class T>
[[gnu::always_inline]] inline T hidden_of_both(const Published<T>& i, const Published<T>& r) {
  return i.hidden + r.hidden * (1.0 - i.hidden);
}

/// -2 ln(sigma_e/sigma) of two directions, by the product of what is seen and its distance from 1.
template <class T>
[[gnu::always_inline]] inline T published_growth(T inverse_slope, T seen, T hidden) {
  return -0.2 * inverse_slope * T(lane::log(seen.v, -hidden.v));
}

}  // namespace goniofit::block
