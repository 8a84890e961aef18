#pragma once
// A smooth function of two variables on a rectangle as one polynomial of total degree 9, laid out for short dependency
// chains and two-wide arithmetic; and one of a single variable. Both are fitted at Chebyshev points, which is within a
// small factor of the best there is.

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace goniofit {

namespace chebyshev {

/// Coefficients by ascending power of the Chebyshev polynomials T_0 ... T_(n-1).
template <std::size_t n>
[[nodiscard]] constexpr std::array<std::array<double, n>, n> monomials() {
  std::array<std::array<double, n>, n> m{};
  m[0][0] = 1.0;
  m[1][1] = 1.0;
  for (std::size_t i = 2; i < n; ++i) {
    for (std::size_t k = 0; k < n; ++k) m[i][k] = (k > 0 ? 2.0 * m[i - 1][k - 1] : 0.0) - m[i - 2][k];
  }
  return m;
}

/// The n points cos(pi (i + 1/2)/n).
template <std::size_t n>
[[nodiscard]] double node(std::size_t i) {
  return std::cos(std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(n));
}

/// What takes n values at the nodes to the Chebyshev coefficients of their interpolant.
template <std::size_t n>
[[nodiscard]] std::array<std::array<double, n>, n> transform() {
  std::array<std::array<double, n>, n> m{};
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = 0; i < n; ++i) {
      const double angle = std::numbers::pi * static_cast<double>(k * (2 * i + 1)) / static_cast<double>(2 * n);
      m[k][i] = (k > 0 ? 2.0 : 1.0) / static_cast<double>(n) * std::cos(angle);
    }
  }
  return m;
}

template <std::size_t n>
[[nodiscard]] std::array<double, n> coefficients(const std::array<double, n>& values) {
  static const std::array<std::array<double, n>, n> matrix = transform<n>();
  std::array<double, n> c{};
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = 0; i < n; ++i) c[k] += matrix[k][i] * values[i];
  }
  return c;
}

}  // namespace chebyshev

/// sum c_k t^k for t in [-1, 1], k < 14.
class ChebyshevLine {
 public:
  static constexpr std::size_t size = 14;

  template <class F>
  [[nodiscard]] static ChebyshevLine fit(const F& f) {
    constexpr auto monomials = chebyshev::monomials<size>();
    std::array<double, size> values{};
    for (std::size_t i = 0; i < size; ++i) values[i] = f(chebyshev::node<size>(i));
    const std::array<double, size> c = chebyshev::coefficients<size>(values);
    ChebyshevLine line;
    for (std::size_t n = 0; n < size; ++n) {
      for (std::size_t k = 0; k < size; ++k) line.c_[k] += c[n] * monomials[n][k];
    }
    return line;
  }

  /// The value, and the derivative in `slope` if asked for.
  template <bool with_derivative>
  [[nodiscard]] [[gnu::always_inline]] double at(double t, double& slope) const {
    const double t2 = t * t;
    double even = c_[size - 2];
    double odd = c_[size - 1];
    double d_even = 0.0;  // by t²
    double d_odd = 0.0;
    for (std::size_t k = size - 2; k > 0; k -= 2) {
      if constexpr (with_derivative) {
        d_even = d_even * t2 + even;
        d_odd = d_odd * t2 + odd;
      }
      even = even * t2 + c_[k - 2];
      odd = odd * t2 + c_[k - 1];
    }
    if constexpr (with_derivative) slope = odd + 2.0 * t * (d_even + t * d_odd);
    return even + t * odd;
  }

 private:
  std::array<double, size> c_{};
};

/// sum_{k+l <= 9} c_kl a^k t^l for a, t in [-1, 1].
class ChebyshevPatch {
 public:
  static constexpr std::size_t size = 10;  ///< coefficients a variable

  struct Gradient {
    double value, by_a, by_t;
  };

  /// Interpolates f(a, t) at 100 points and leaves out what is of higher degree.
  template <class F>
  [[nodiscard]] static ChebyshevPatch fit(const F& f) {
    std::array<std::array<double, size>, size> c{};
    for (std::size_t i = 0; i < size; ++i) {
      const double a = chebyshev::node<size>(i);
      for (std::size_t j = 0; j < size; ++j) c[i][j] = f(a, chebyshev::node<size>(j));
      c[i] = chebyshev::coefficients<size>(c[i]);
    }
    for (std::size_t l = 0; l < size; ++l) {
      std::array<double, size> column{};
      for (std::size_t i = 0; i < size; ++i) column[i] = c[i][l];
      column = chebyshev::coefficients<size>(column);
      for (std::size_t i = 0; i < size; ++i) c[i][l] = column[i];
    }
    return of_chebyshev(c);
  }

  [[nodiscard]] [[gnu::always_inline]] double value(double a, double t) const {
    const double t2 = t * t;
    Row even{};
    Row odd{};
    for (std::size_t m = pairs; m-- > 0;) {
      const Two* const c = c_.data() + offset(m);
      const std::size_t n = pairs - m;
      for (std::size_t k = 0; k < n; ++k) {
        even[k] = even[k] * t2 + c[k];
        odd[k] = odd[k] * t2 + c[n + k];
      }
    }
    for (std::size_t k = 0; k < pairs; ++k) even[k] += t * odd[k];
    return in_a(even, a);
  }

  [[nodiscard]] [[gnu::always_inline]] Gradient gradient(double a, double t) const {
    const double t2 = t * t;
    Row even{};
    Row odd{};
    Row d_even{};  // by t²
    Row d_odd{};
    for (std::size_t m = pairs; m-- > 0;) {
      const Two* const c = c_.data() + offset(m);
      const std::size_t n = pairs - m;
      for (std::size_t k = 0; k < n; ++k) {
        d_even[k] = d_even[k] * t2 + even[k];
        d_odd[k] = d_odd[k] * t2 + odd[k];
        even[k] = even[k] * t2 + c[k];
        odd[k] = odd[k] * t2 + c[n + k];
      }
    }
    for (std::size_t k = 0; k < pairs; ++k) {
      d_even[k] = odd[k] + 2.0 * t * (d_even[k] + t * d_odd[k]);
      even[k] += t * odd[k];
    }
    return {in_a(even, a), slope_in_a(even, a), in_a(d_even, a)};
  }

 private:
  /// Two neighbouring powers of a: GCC leaves plain arrays of ten in memory, half as fast.
  using Two [[gnu::vector_size(2 * sizeof(double))]] = double;
  static constexpr std::size_t pairs = size / 2;
  using Row = std::array<Two, pairs>;  ///< by ascending power of a

  /// Powers 2m and 2m+1 of t, each with its 10 - 2m powers of a (the last of the latter is 0, for even lengths).
  [[nodiscard]] static constexpr std::size_t offset(std::size_t m) { return m * (size + 1 - m); }

  [[nodiscard]] static ChebyshevPatch of_chebyshev(const std::array<std::array<double, size>, size>& c) {
    constexpr auto monomials = chebyshev::monomials<size>();
    ChebyshevPatch patch;
    for (std::size_t l = 0; l < size; ++l) {
      Two* const row = patch.c_.data() + offset(l / 2) + (l % 2) * (pairs - l / 2);
      for (std::size_t k = 0; k + l < size; ++k) {
        double sum = 0.0;
        for (std::size_t i = k; i < size; ++i) {
          for (std::size_t j = l; i + j < size; ++j) sum += c[i][j] * monomials[i][k] * monomials[j][l];
        }
        row[k / 2][k % 2] = sum;
      }
    }
    return patch;
  }

  [[nodiscard]] [[gnu::always_inline]] static double in_a(const Row& p, double a) {
    const double a2 = a * a;
    const double a4 = a2 * a2;
    const Two sum = (p[0] + a2 * p[1]) + a4 * ((p[2] + a2 * p[3]) + a4 * p[4]);
    return sum[0] + a * sum[1];
  }

  [[nodiscard]] [[gnu::always_inline]] static double slope_in_a(const Row& p, double a) {
    const double a2 = a * a;
    const double a4 = a2 * a2;
    const Two sum = (p[0] + a2 * p[1]) + a4 * ((p[2] + a2 * p[3]) + a4 * p[4]);
    const Two by_a2 = (p[1] + 2.0 * a2 * p[2]) + a4 * (3.0 * p[3] + 4.0 * a2 * p[4]);
    return sum[1] + 2.0 * a * (by_a2[0] + a * by_a2[1]);
  }

  std::array<Two, 30> c_{};
};

}  // namespace goniofit
