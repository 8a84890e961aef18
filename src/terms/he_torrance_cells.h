#pragma once
// The polynomials of he_torrance_regions.h: what they look like, how a lane of a vectorised loop evaluates them, and
// where they come from: fitted to the series and the saddle point when first needed, and so never at odds with them.

#include <array>
#include <bit>
#include <cstddef>
#include <type_traits>

#include "../support/lane_math.h"
#include "polynomial.h"

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

/// sum_i a^i sum_k c_ik l^k over the rows of S from `row` on.
template <class S, std::size_t row = 0, class Real>
[[nodiscard]] [[gnu::always_inline]] inline Real staircase(const Real* c, Real a, Real l) {
  const Real here = polynomial<S::lengths[row]>(c + S::offset(row), l);
  if constexpr (row + 1 == S::lengths.size()) {
    return here;
  } else {
    return here + a * staircase<S, row + 1>(c, a, l);
  }
}

/// l in [-1, 1] linear in ln(v), v >= 1: from the exponent of v and a polynomial of its mantissa. No division, of which
/// the usual logarithms have one, and no more digits than the polynomials that take l need.
template <std::size_t length, class Real>
struct LogVariable {
  Real by_exponent;
  std::array<Real, length> of_mantissa;

  [[nodiscard]] [[gnu::always_inline]] Real at(Real v) const {
    using F = lane::Format<Real>;
    using Bits = typename F::Bits;
    constexpr Bits one = Bits{F::bias} << F::mantissa;
    constexpr Bits low = (Bits{1} << F::mantissa) - 1;
    // The integer as the low bits of 2^mantissa, as in lane::log.
    constexpr Bits integer = Bits{F::bias + F::mantissa} << F::mantissa;
    const Bits bits = std::bit_cast<Bits>(v);
    const Real k =
        std::bit_cast<Real>((bits >> F::mantissa) | integer) - (std::bit_cast<Real>(integer) + Real(F::bias));
    const Real m = std::bit_cast<Real>((bits & low) | one) - Real(1.5);
    return k * by_exponent + polynomial<length>(of_mantissa.data(), m);
  }
};

/// ln(g W) + y G(xi) = P(a, l) with l linear in ln(1 + 12 xi), a in r q(l): in [-1, 1] both. Decay is the number of
/// coefficients of G in l.
template <class Rows, std::size_t log_length, std::size_t decay_length, class Real>
struct SaddleCell {
  static constexpr double scale = 12.0;
  static constexpr std::size_t root_length = 6;

  LogVariable<log_length, Real> log_variable;
  std::array<Real, root_length> root_q;  ///< r times its square is a + 1
  std::array<Real, decay_length> decay;
  std::array<Real, Rows::size> prefactor;

  [[nodiscard]] [[gnu::always_inline]] Real variable(Real r, Real x) const {
    return log_variable.at(Real(1) + Real(scale) * (x * r * r));
  }
  [[nodiscard]] [[gnu::always_inline]] Real log_g_w(Real r, Real x, Real l) const {
    const Real root = polynomial<root_length>(root_q.data(), l);
    const Real a = r * (root * root) - Real(1);
    return staircase<Rows>(prefactor.data(), a, l) - x * r * polynomial<decay_length>(decay.data(), l);
  }
};

/// ln(g W) + y = P(a, l) with l linear in ln(1 + x/8), a in r.
template <class Rows, std::size_t log_length, class Real>
struct OriginCell {
  static constexpr double scale = 1.0 / 8.0;

  LogVariable<log_length, Real> log_variable;
  Real a_scale, a_shift;
  std::array<Real, Rows::size> prefactor;

  [[nodiscard]] [[gnu::always_inline]] Real variable(Real, Real x) const {
    return log_variable.at(Real(1) + Real(scale) * x);
  }
  [[nodiscard]] [[gnu::always_inline]] Real log_g_w(Real r, Real x, Real l) const {
    return staircase<Rows>(prefactor.data(), r * a_scale + a_shift, l) - x * r;
  }
};

/// Within 6e-10.
struct FineCells {
  static constexpr std::size_t logs = 16;
  SaddleCell<Staircase<15, 15, 12, 11, 9, 7>, logs, 20, double> shallow_large;
  SaddleCell<Staircase<15, 15, 14, 13, 12, 9>, logs, 20, double> shallow;
  SaddleCell<Staircase<16, 16, 14, 11, 5>, logs, 24, double> deep;
  SaddleCell<Staircase<12, 12, 12, 12, 11, 10, 9, 6>, logs, 18, double> shallow_small;
  SaddleCell<Staircase<12, 10, 10, 7, 5>, logs, 18, double> deep_small;
  OriginCell<Staircase<13, 13, 12, 12, 11, 11, 10, 9, 8, 8, 7, 6, 4>, logs, double> origin;

  [[nodiscard]] static const FineCells& get();
};

/// Within 8e-5; in float, which has lanes to spare, within 1e-5.
template <class Real>
struct CoarseCells {
  static constexpr bool in_float = std::is_same_v<Real, float>;
  using Rows = std::conditional_t<in_float, Staircase<13, 12, 11, 8, 3>, Staircase<11, 10, 9, 4>>;

  SaddleCell<Rows, 9, 20, Real> saddle;
  OriginCell<Staircase<8, 7, 7, 6, 5, 4, 4>, 9, Real> origin;

  [[nodiscard]] static const CoarseCells& get();
};
extern template struct CoarseCells<double>;
extern template struct CoarseCells<float>;

}  // namespace goniofit::he_torrance
