#pragma once
// The polynomials of he_torrance_regions.h: what they look like, how a lane of a vectorised loop evaluates them, and
// where they come from: fitted to the series and the saddle point when first needed, and so never at odds with them.

#include <array>
#include <cstddef>

#include "lane_math.h"

namespace goniofit::he_torrance {

/// The powers of the second variable that go with each power of the first, from the 0th: lengths(i) of them.
template <std::size_t... length>
struct Staircase {
  static constexpr std::array<std::size_t, sizeof...(length)> lengths{length...};
  static constexpr std::size_t size = (length + ...);

  [[nodiscard]] static constexpr std::size_t offset(std::size_t row) {
    std::size_t sum = 0;
    for (std::size_t i = 0; i < row; ++i) sum += lengths[i];
    return sum;
  }
};

/// sum c_k t^k, k < n.
template <std::size_t n, class Real>
[[nodiscard]] [[gnu::always_inline]] inline Real horner(const Real* c, Real t) {
  if constexpr (n == 1) {
    return c[0];
  } else {
    return c[0] + t * horner<n - 1>(c + 1, t);
  }
}

/// sum_i a^i sum_k c_ik l^k over the rows of S from `row` on.
template <class S, std::size_t row = 0, class Real>
[[nodiscard]] [[gnu::always_inline]] inline Real staircase(const Real* c, Real a, Real l) {
  const Real here = horner<S::lengths[row]>(c + S::offset(row), l);
  if constexpr (row + 1 == S::lengths.size()) {
    return here;
  } else {
    return here + a * staircase<S, row + 1>(c, a, l);
  }
}

/// ln(g W) + y G(xi) = P(a, l) with l linear in ln(1 + 12 xi), a in r q(l): in [-1, 1] both. Decay is the number of
/// coefficients of G in l.
template <class Rows, std::size_t decay_length, class Real>
struct SaddleCell {
  using Shape = Rows;
  static constexpr double xi_scale = 12.0;
  static constexpr std::size_t root_length = 7;

  Real l_scale, l_shift;
  std::array<Real, root_length> root_q;  ///< whose square is 2 r q/(a + 1) times 1/r
  std::array<Real, decay_length> decay;
  std::array<Real, Rows::size> prefactor;

  [[nodiscard]] [[gnu::always_inline]] Real log_g_w(Real r, Real x) const {
    const Real y = x * r;
    const Real l = log1p(Lane<Real>(Real(xi_scale) * (y * r))).v * l_scale + l_shift;
    const Real root = horner<root_length>(root_q.data(), l);
    const Real a = r * (root * root) - Real(1);
    return staircase<Rows>(prefactor.data(), a, l) - y * horner<decay_length>(decay.data(), l);
  }
};

/// ln(g W) + y = P(a, l) with l linear in ln(1 + x/8), a in r.
template <class Rows, class Real>
struct OriginCell {
  using Shape = Rows;
  static constexpr double x_scale = 1.0 / 8.0;

  Real l_scale, l_shift, a_scale, a_shift;
  std::array<Real, Rows::size> prefactor;

  [[nodiscard]] [[gnu::always_inline]] Real log_g_w(Real r, Real x) const {
    const Real l = log1p(Lane<Real>(Real(x_scale) * x)).v * l_scale + l_shift;
    const Real a = r * a_scale + a_shift;
    return staircase<Rows>(prefactor.data(), a, l) - x * r;
  }
};

/// Within 6e-10: 593 numbers.
struct FineCells {
  SaddleCell<Staircase<15, 15, 12, 11, 9, 7>, 20, double> shallow_large;
  SaddleCell<Staircase<15, 15, 14, 13, 12, 9>, 20, double> shallow;
  SaddleCell<Staircase<16, 16, 14, 11, 5>, 24, double> deep;
  SaddleCell<Staircase<12, 12, 12, 12, 11, 10, 9, 6>, 18, double> shallow_small;
  SaddleCell<Staircase<12, 10, 10, 7, 5>, 18, double> deep_small;
  OriginCell<Staircase<13, 13, 12, 12, 11, 11, 10, 9, 8, 8, 7, 6, 4>, double> origin;

  [[nodiscard]] static const FineCells& get();
};

/// Within 6e-5.
template <class Real>
struct CoarseCells {
  SaddleCell<Staircase<11, 10, 10, 5>, 22, Real> saddle;
  OriginCell<Staircase<8, 7, 7, 6, 5, 4, 4>, Real> origin;

  [[nodiscard]] static const CoarseCells& get();
};
extern template struct CoarseCells<double>;
extern template struct CoarseCells<float>;

}  // namespace goniofit::he_torrance
