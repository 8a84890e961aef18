#pragma once
// W(g, x) of He et al. 1991 by its saddle point: no sum, any size of the summand's peak. For peaks above 100 or so; the
// other files of this name choose when.

#include <array>
#include <cstddef>

#include "lambert_w.h"
#include "scalar.h"

namespace goniofit {

/// ln W with its derivatives with respect to ln g and x.
template <class T>
struct LogW {
  T value, by_log_g, by_x;
};

namespace he_torrance {

/// w = W0(2 x/g²)/2, so that g e^w is where the exponent of the summand peaks. As lambert_w0, but its argument may
/// leave the range of doubles: then by its logarithm.
template <class T>
[[nodiscard]] T saddle_exponent(const T& log_g, const T& x) {
  using namespace math;
  if (!(x > 0)) return T(0.0);
  const T log_a = log(x) + log(T(2.0)) - 2.0 * log_g;
  if (log_a < 600.0) return 0.5 * lambert_w0(T(exp(log_a)));
  T z = log_a - log(log_a);
  for (int i = 0; i < lambert::steps<T>; ++i) z = lambert::step(z, T(log_a - log(z) - z));
  return 0.5 * z;
}

/// One correction Q_n of W = exp(-g e(w) - w)/g sqrt(v) [1 + sum_n Q_n(v)/J^n], v = 1/(1+2w), J = g e^w: numerators
/// over one denominator, by ascending power of v. They follow from j! by Stirling, the exponent around J and the
/// moments of a Gaussian; Q_n(1) = n! (at x = 0, W is the exponential integral). tests/truth/he_torrance_saddle.py
/// prints them.
template <std::size_t n>
struct SaddleTerm {
  double denominator;
  std::array<double, 3 * n + 1> numerators;

  /// Q_n and dQ_n/dv.
  template <class T>
  [[nodiscard]] std::array<T, 2> at(const T& v) const {
    T q(0.0);
    T dq(0.0);
    for (std::size_t i = numerators.size(); i-- > 0;) {
      dq = dq * v + q;
      q = q * v + numerators[i];
    }
    return {T(q / denominator), T(dq / denominator)};
  }
};

// clang-format off
inline constexpr SaddleTerm<1> saddle_1{12.0, {-1.0, 0.0, 3.0, 10.0}};
inline constexpr SaddleTerm<2> saddle_2{288.0, {1.0, -24.0, -30.0, -92.0, -399.0, -420.0, 1540.0}};
inline constexpr SaddleTerm<3> saddle_3{51840.0, {139.0, 540.0, 405.0, -930.0, 12825.0, 129816.0, 278355.0, -810810.0,
    -2702700.0, 3403400.0}};
inline constexpr SaddleTerm<4> saddle_4{2488320.0, {-571.0, 40032.0, 47604.0, 66040.0, 166590.0, -1148184.0,
    -15800532.0, -50131224.0, 101975445.0, 813412600.0, 116396280.0, -3879876000.0, 2974571600.0}};
inline constexpr SaddleTerm<5> saddle_5{209018880.0, {-163879.0, -479640.0, 8202873.0, 13971230.0, 14388906.0, -562296.0,
    277880330.0, 4067523252.0, 16727235525.0, -22623897296.0, -360396831795.0, -514597653570.0, 2359132735960.0,
    3435630198000.0, -10931550630000.0, 6038380348000.0}};
inline constexpr SaddleTerm<6> saddle_6{75246796800.0, {5246819.0, -884946600.0, -1086748110.0, 1954183380.0,
    9432291645.0, 20562464412.0, 41844618480.0, -256835163960.0, -5112940575555.0, -25976799131920.0, 20413690465194.0,
    687346979138820.0, 1822938355633395.0, -4298676120238500.0, -20684825112451500.0, 20198382264060000.0,
    88447176147330000.0, -151623730538280000.0, 65516426775800000.0}};
// clang-format on

/// The bracket T = sum_n Q_n(v)/J^n and its derivatives with respect to v and ln J.
template <class T>
struct SaddleCorrection {
  T sum{0.0}, by_v{0.0}, by_log_j{0.0};
};

template <class T>
[[nodiscard]] SaddleCorrection<T> saddle_correction(const T& v, const T& inverse_j) {
  SaddleCorrection<T> c;
  T power(1.0);
  const auto add = [&]<std::size_t n>(const SaddleTerm<n>& term) {
    power *= inverse_j;
    const std::array<T, 2> q = term.at(v);
    c.sum += q[0] * power;
    c.by_v += q[1] * power;
    c.by_log_j -= static_cast<double>(n) * q[0] * power;
  };
  add(saddle_1);
  add(saddle_2);
  add(saddle_3);
  add(saddle_4);
  add(saddle_5);
  add(saddle_6);
  return c;
}

/// ln W at the saddle exponent w = saddle_exponent(log_g, x). Its relative error in W is that of the first term left
/// out: 5040 v^7/J^7 and less, 5e-11 at J = 100, 1e-52 at J = 1e8. Sum and integral differ by exp(-2 pi² J v), so J v
/// has to be above 1.3 (1e-11), which for peaks above 100 says g > e^-35 or so.
template <class T>
[[nodiscard]] LogW<T> log_w_at_saddle(const T& log_g, const T& x, const T& w) {
  using namespace math;
  const T j = w > 1.0 ? T(sqrt(T(x / w))) : T(exp(T(log_g + w)));  // x = w J²; the sum may have rounded w away
  const T v = 1.0 / (1.0 + 2.0 * w);
  const T jw = x / j;  // J w; in place of g e(w), this and the next stay finite at any g
  const T shrink = w > 0 ? T(-expm1(-w) / w) : T(1.0);
  const SaddleCorrection<T> c = saddle_correction(v, T(1.0 / j));
  const T by_w_of_bracket = -2.0 * v * v * c.by_v / (1.0 + c.sum);
  const T by_log_j_of_bracket = c.by_log_j / (1.0 + c.sum);
  // dw/d ln g = -2wv, d ln J/d ln g = v; dw/dx = d ln J/dx = v/J². The exponent itself is stationary in J.
  const T w_by_log_g = -2.0 * w * v;
  const T w_by_x = v / j / j;
  const T by_w = by_w_of_bracket - 1.0 - v;
  return {-jw * (2.0 - shrink) - log_g - w - 0.5 * log1p(T(2.0 * w)) + log1p(c.sum),
          jw * shrink - 1.0 + by_w * w_by_log_g + by_log_j_of_bracket * v,
          -1.0 / j + (by_w + by_log_j_of_bracket) * w_by_x};
}

}  // namespace he_torrance
}  // namespace goniofit
