#pragma once
// Fits in Chebyshev polynomials, which come out by powers. For what is fitted once; chebyshev_patch.h has the fixed
// sizes of the scalar tables.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace goniofit::chebyshev {

/// T_0 ... T_(n-1) at t.
[[nodiscard]] inline std::vector<double> chebyshev_values(std::size_t n, double t) {
  std::vector<double> v(std::max<std::size_t>(n, 2), 1.0);
  v[1] = t;
  for (std::size_t i = 2; i < n; ++i) v[i] = 2.0 * t * v[i - 1] - v[i - 2];
  return v;
}

/// Row i: the coefficients of T_i by ascending power.
[[nodiscard]] inline std::vector<std::vector<double>> chebyshev_powers(std::size_t n) {
  std::vector<std::vector<double>> m(std::max<std::size_t>(n, 2), std::vector<double>(n + 1, 0.0));
  m[0][0] = 1.0;
  m[1][1] = 1.0;
  for (std::size_t i = 2; i < n; ++i) {
    for (std::size_t k = 0; k < n; ++k) m[i][k] = (k > 0 ? 2.0 * m[i - 1][k - 1] : 0.0) - m[i - 2][k];
  }
  return m;
}

/// The n places in [-1, 1] that interpolation is best at.
[[nodiscard]] inline double place(std::size_t i, std::size_t n) {
  return std::cos(std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(n));
}

/// Coefficients of T_0 ... T_(n-1) in the interpolation of f(t) on [-1, 1].
template <class F>
[[nodiscard]] std::vector<double> series(std::size_t n, const F& f) {
  std::vector<double> c(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    const double t = place(i, n);
    const double value = f(t) * 2.0 / static_cast<double>(n);
    const std::vector<double> basis = chebyshev_values(n, t);
    for (std::size_t k = 0; k < n; ++k) c[k] += value * basis[k] * (k > 0 ? 1.0 : 0.5);
  }
  return c;
}

/// Sum of c[k] T_k, k < n, by powers of t.
[[nodiscard]] inline std::vector<double> by_powers(const std::vector<double>& c, std::size_t n) {
  const auto powers = chebyshev_powers(n);
  std::vector<double> sum(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k <= i; ++k) sum[k] += c[i] * powers[i][k];
  }
  return sum;
}

/// Chebyshev interpolation of f(t) on [-1, 1], by powers of t.
template <std::size_t n, class F>
[[nodiscard]] std::array<double, n> fit_line(const F& f) {
  const std::vector<double> sum = by_powers(series(n, f), n);
  std::array<double, n> c{};
  std::copy(sum.begin(), sum.end(), c.begin());
  return c;
}

}  // namespace goniofit::chebyshev
