#pragma once
// Tier `he-torrance-series`: the slope distribution of He et al. 1991 by its own sum,
//   W(g, x) = sum_{j>=1} g^j e^-g/(j! j) e^(-x/j),  g > 0, x >= 0.
// Slow (one exponential a term, some 13 sqrt(J/(1+2w)) terms around the peak J) and right: the yardstick of
// he_torrance.h. g comes as its logarithm, which does not underflow on smooth surfaces, and W leaves as its own.

#include <array>
#include <cstddef>
#include <limits>

#include "he_torrance_saddle.h"
#include "scalar.h"

namespace goniofit {
namespace he_torrance {

/// Peaks beyond this are not summed (6 sigma would be 1.5e5 terms and more): the saddle point is right to 1e-50 there.
inline constexpr double longest_peak = 1.5e8;

/// ln a_(j+1)/a_j of the whole summand a_j. Decreasing in j: there is one peak.
template <class T>
[[nodiscard]] T log_ratio(const T& log_g, const T& x, const T& j) {
  using namespace math;
  return log_g + x / (j * (j + 1.0)) - log(T((j + 1.0) * ((j + 1.0) / j)));
}

/// The index of the largest summand, from the saddle by a few steps.
template <class T>
[[nodiscard]] T peak_index(const T& log_g, const T& x, const T& w) {
  using namespace math;
  T p = floor(T(exp(T(log_g + w)) + 0.5));
  if (p < 1.0) p = 1.0;
  while (log_ratio(log_g, x, p) > 0.0) p += 1.0;
  while (p > 1.0 && log_ratio(log_g, x, T(p - 1.0)) < 0.0) p -= 1.0;
  return p;
}

/// ln p! - (p + 1/2) ln p + p - ln(2 pi)/2 for p > 100: Stirling's series, B_2n/(2n (2n-1)) p^(1-2n). Good to 1e-57.
template <class T>
[[nodiscard]] T stirling_remainder(const T& p) {
  constexpr std::array<std::array<double, 2>, 17> bernoulli{{{1.0, 6.0},
                                                             {-1.0, 30.0},
                                                             {1.0, 42.0},
                                                             {-1.0, 30.0},
                                                             {5.0, 66.0},
                                                             {-691.0, 2730.0},
                                                             {7.0, 6.0},
                                                             {-3617.0, 510.0},
                                                             {43867.0, 798.0},
                                                             {-174611.0, 330.0},
                                                             {854513.0, 138.0},
                                                             {-236364091.0, 2730.0},
                                                             {8553103.0, 6.0},
                                                             {-23749461029.0, 870.0},
                                                             {8615841276005.0, 14322.0},
                                                             {-7709321041217.0, 510.0},
                                                             {2577687858367.0, 6.0}}};
  const T inverse2 = 1.0 / (p * p);
  T sum(0.0);
  for (std::size_t n = bernoulli.size(); n > 0; --n) {
    const auto two_n = static_cast<double>(2 * n);
    sum = sum * inverse2 + T(bernoulli[n - 1][0]) / (bernoulli[n - 1][1] * two_n * (two_n - 1.0));
  }
  return sum / p;
}

/// (1+d) ln(1+d) - d, which is d²/2 near 0: there by z = d/(2+d), ln(1+d) = 2 (z + z³/3 + ...).
template <class T>
[[nodiscard]] T poisson_deviance(const T& d) {
  using namespace math;
  if (d > 0.5 || d < -0.5) return (1.0 + d) * log1p(d) - d;
  const T z = d / (2.0 + d);
  const T z2 = z * z;
  T sum(0.0);
  T power(1.0);
  double odd = 3.0;
  while (power > std::numeric_limits<T>::epsilon() * sum) {
    sum += power / odd;
    power *= z2;
    odd += 2.0;
  }
  return d * z + 2.0 * (1.0 + d) * z * z2 * sum;
}

/// ln of p^th summand without x: p ln g - g - ln p! - ln p, whose parts cancel to a few units where p is near g.
template <class T>
[[nodiscard]] T log_poisson_over_index(const T& log_g, const T& p) {
  using namespace math;
  const T g = exp(log_g);
  if (p > 100.0) {
    const T to_go = p - g;
    const T log_two_pi = log(T(8.0 * atan(T(1.0))));
    const T deviance = p < 2.0 * g ? T(g * poisson_deviance(T(to_go / g))) : T(p * (log(p) - log_g) - to_go);
    return -deviance - 1.5 * log(p) - 0.5 * log_two_pi - stirling_remainder(p);
  }
  const bool near = p < 2.0 * g + 20.0 && g > 1e-10;
  T product(1.0);
  for (int k = 1; k <= p; ++k) product *= near ? T(g / k) : T(k);
  return (near ? T(log(product)) : T(p * log_g - log(product))) - g - log(p);
}

/// The sums over the summands relative to the one at the peak.
template <class T>
struct SeriesSums {
  T weight{0.0}, stein{0.0}, inverse_j{0.0};
};

/// Adds a summand. E[j] - g would cancel at large g; by the summands' recurrence, k² a_k/(k-1) = g e^(x/(k(k-1)))
/// a_(k-1), it equals E[k/(k-1) (k (1 - e^(-x/(k(k-1)))) - 1)], where k = 1 counts 1.
template <bool with_derivatives, class T>
void add_summand(SeriesSums<T>& s, const T& x, const T& k, const T& weight) {
  using namespace math;
  s.weight += weight;
  if constexpr (with_derivatives) {
    const T below = k - 1.0;
    s.inverse_j += weight / k;
    s.stein += below > 0.0 ? T(weight * (k / below * (-k * expm1(-x / (k * below)) - 1.0))) : weight;
  }
}

/// All the summands that matter. The exponents of their ratios are taken relative to the peak's, ln g + x/(p(p+1)):
/// that is O(ln p) where there are many terms, while ln g and x/(j(j+1)) may both be large.
template <bool with_derivatives, class T>
[[nodiscard]] SeriesSums<T> sum_around(const T& log_g, const T& x, const T& p) {
  using namespace math;
  const T negligible = std::numeric_limits<T>::epsilon() / 16.0;
  const T x_p = x / (p * (p + 1.0));
  const T at_p = log_g + x_p;
  const auto ratio = [&](const T& j) {  // a_(j+1)/a_j
    const T j1 = j + 1.0;
    return T(j / (j1 * j1) * exp(T(at_p + x_p * ((p - j) * (p + j1) / (j * j1)))));
  };
  SeriesSums<T> s;
  add_summand<with_derivatives>(s, x, p, T(1.0));
  T k = p;
  T weight(1.0);
  for (int terms = 1; weight * terms > negligible * s.weight; ++terms) {
    weight *= ratio(k);
    k += 1.0;
    add_summand<with_derivatives>(s, x, k, weight);
  }
  k = p;
  weight = 1.0;
  for (int terms = 1; k > 1.0 && weight * terms > negligible * s.weight; ++terms) {
    k -= 1.0;
    weight /= ratio(k);
    add_summand<with_derivatives>(s, x, k, weight);
  }
  return s;
}

/// w = saddle_exponent(log_g, x).
template <bool with_derivatives, class T>
[[nodiscard]] LogW<T> log_series(const T& log_g, const T& x, const T& w) {
  using namespace math;
  if (log_g + w > log(longest_peak)) return log_w_at_saddle(log_g, x, w);
  const T p = peak_index(log_g, x, w);
  const SeriesSums<T> s = sum_around<with_derivatives>(log_g, x, p);
  return {T(log_poisson_over_index(log_g, p) - x / p + log(s.weight)), T(s.stein / s.weight),
          T(-s.inverse_j / s.weight)};
}

}  // namespace he_torrance

/// ln W(g, x). Within 1e-14 (1 + |ln W|) in double, 45 digits in a 50-digit float.
template <class T>
[[nodiscard]] T log_he_torrance_series(const T& log_g, const T& x) {
  return he_torrance::log_series<false>(log_g, x, he_torrance::saddle_exponent(log_g, x)).value;
}

/// ln W(g, x), d/d ln g and d/dx from one sum.
template <class T>
[[nodiscard]] LogW<T> log_he_torrance_series_derivatives(const T& log_g, const T& x) {
  return he_torrance::log_series<true>(log_g, x, he_torrance::saddle_exponent(log_g, x));
}

}  // namespace goniofit
