#pragma once
// The little that the formulas need of their scalar beyond arithmetic, so that each stands once for double, for dual
// numbers, for SIMD batches and for 50-digit floats. Formulas call exp, log ... unqualified after `using namespace
// math`.

#include <cmath>

namespace goniofit::math {

using std::atan;
using std::erfc;
using std::exp;
using std::expm1;
using std::floor;
using std::log;
using std::log1p;
using std::sqrt;

/// Both sides are evaluated: a vectorised loop cannot branch. Where a side is singular, keep its argument harmless.
template <class T>
[[gnu::always_inline]] inline T select(bool condition, const T& yes, const T& no) {
  return condition ? yes : no;
}

/// pi and its square root, as sums of doubles that carry 64 digits: a wide type gets them all, double its nearest.
template <class T>
[[nodiscard]] [[gnu::always_inline]] inline T pi_of() {
  return T(-2.9947698097183397e-33) + 1.1124542208633653e-49 + 1.2246467991473532e-16 + 3.1415926535897931;
}
template <class T>
[[nodiscard]] [[gnu::always_inline]] inline T root_pi_of() {
  return T(-1.3058334907945429e-33) - 2.6110142087827155e-50 - 7.6665864998257987e-17 + 1.7724538509055161;
}

/// x⁵ by three products.
template <class T>
[[gnu::always_inline]] inline T pow5(const T& x) {
  const T x2 = x * x;
  return x2 * x2 * x;
}

/// ln(1 - e^x) for x < 0. One form cancels near 0, the other far from it; they meet at -ln 2.
template <class T>
[[gnu::always_inline]] inline T log_one_minus_exp(const T& x) {
  constexpr double ln2 = 0.6931471805599453;
  const T far = log1p(-exp(x));
  const T near = log(-expm1(x));
  return select(x < -ln2, far, near);
}

}  // namespace goniofit::math
