#pragma once
// ln(1 + x)/x: how the long-tailed distribution leaves Beckmann's. Its quotient loses the derivative at small x (a
// difference of near equals divided by x²), which is what a fit of the tail steps along.

#include <limits>

#include "scalar.h"

namespace goniofit {

/// ln(1 + x)/x for 0 <= x < ½: 2/(2+x) Σ s^2k/(2k+1), s = x/(2+x) <= 1/5, from ln(1+x) = 2 artanh s. To 1 eps, its
/// derivative too; harmless, if meaningless, for larger x.
template <class T>
[[nodiscard]] [[gnu::always_inline]] inline T log1p_ratio_series(const T& x) {
  constexpr int terms = std::numeric_limits<T>::digits <= 64 ? 12 : 37;
  const T s = x / (2.0 + x);
  const T s2 = s * s;
  T sum = T(1.0) / (2.0 * terms + 1.0);
  for (int k = terms - 1; k >= 0; --k) sum = sum * s2 + T(1.0) / (2.0 * k + 1.0);
  return 2.0 / (2.0 + x) * sum;
}

/// n ln(1 + y/n) for y >= 0 (infinity included), n > 0: y as n grows, smoothly.
template <class T>
[[nodiscard]] [[gnu::always_inline]] inline T scaled_log1p(const T& y, const T& n) {
  using namespace math;
  const T x = y / n;
  return select(x < 0.5, T(y * log1p_ratio_series(x)), T(n * log1p(x)));
}

}  // namespace goniofit
