#pragma once
// What shadowing and the effective roughness of He et al. 1991 read of one direction at zenith angle theta.

#include "scalar.h"

namespace goniofit {

/// sin theta = √((1 - c)(1 + c)), accurate at both ends.
template <class G>
[[nodiscard]] [[gnu::always_inline]] inline G sine(const G& c, const G& one_minus_c) {
  using namespace math;
  return sqrt(one_minus_c * (1.0 + c));
}

/// HT's a = cot theta / (2 m) at slope m = sigma/tau, but never above `bound`, from where on the caller's terms no
/// longer depend on it: at normal incidence a is infinite and its derivative no number. It is the divisor that is
/// bounded, by a value not known at compile time: a select on a constant would undo the vectorisation of what follows.
template <class T, class G>
[[nodiscard]] [[gnu::always_inline]] inline T cot_over_two_slopes(const T& slope, const G& c, const G& s,
                                                                  double bound) {
  using namespace math;
  const T width = 2.0 * slope * s;
  const T least = T(c * (1.0 / bound));
  return c / select(width > least, width, least);
}

/// From here on erfc a and exp(-a²) are below 1e-293: lost against 1, yet still normal numbers, which vector
/// exponentials want.
inline constexpr double gaussian_reach = 26.0;

}  // namespace goniofit
