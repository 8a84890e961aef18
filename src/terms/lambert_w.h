#pragma once
// The principal branch W0 of Lambert's function, w e^w = z, for z >= 0. Boost's lambert_w0 takes neither a dual
// number nor a vectorised loop, and HT's z overflows towards grazing.

#include <limits>

#include "scalar.h"

namespace goniofit {

namespace lambert {

/// Within 1 % of W0 for small z and large, smooth (Iacono & Boyd 2017 discuss starts of this kind).
template <class T>
[[nodiscard]] [[gnu::always_inline]] inline T start(const T& z) {
  using namespace math;
  const T l = log1p(z);
  return l * (1.0 - log1p(l) / (2.0 + l));
}

/// One step of Fritsch, Shafer & Crowley 1973 (CACM algorithm 443) on r = ln(z/w) - w = 0: of fourth order, so two
/// steps from `start` reach double precision. The logarithm is what makes one form right for small z and large: at
/// small z its argument tends to 1, at large z its rounding is divided by w.
template <class T>
[[nodiscard]] [[gnu::always_inline]] inline T step(const T& w, const T& r) {
  const T w1 = 1.0 + w;
  const T q = 2.0 * w1 * (3.0 * w1 + 2.0 * r);  // three times theirs
  return w + w * r * (q - 3.0 * r) / (w1 * (q - 6.0 * r));
}

template <class T>
inline constexpr int steps = std::numeric_limits<T>::digits <= 64 ? 2 : 4;

}  // namespace lambert

/// W0(z), 0 <= z <= 1e300, to 2 eps, its derivative too; below 1e-290 it is z, without the 0/0 at z = 0.
template <class T>
[[nodiscard]] [[gnu::always_inline]] inline T lambert_w0(const T& z) {
  using namespace math;
  const T least = T(1e-290);
  const T safe = select(z > least, z, least);
  T w = lambert::start(safe);
  for (int i = 0; i < lambert::steps<T>; ++i) w = lambert::step(w, T(log(safe / w) - w));
  return select(z > least, w, z);
}

/// W0(k²), 0 <= k <= 1e300 (in single precision 1e30), to 2 eps, where k² itself leaves the range of the type. The
/// start saturates at k = 1e150 (1e18); the steps are nearly linear up there and mend that. Below `least` it is k².
template <class T>
[[nodiscard]] [[gnu::always_inline]] inline T lambert_w0_of_square(const T& k, double least_k = 1e-145) {
  using namespace math;
  const T least = T(least_k);
  const T most = T(std::numeric_limits<T>::digits <= 24 ? 1e18 : 1e150);
  const T safe = select(k > least, k, least);
  const T start_at = select(safe < most, safe, most);
  T w = lambert::start(T(start_at * start_at));
  for (int i = 0; i < lambert::steps<T>; ++i) w = lambert::step(w, T(2.0 * log(safe / sqrt(w)) - w));
  return select(k > least, w, T(k * k));
}

}  // namespace goniofit
