#pragma once
// One lane of a vectorised loop: a number whose exp, log and the like are branch-free and inline, so that the compiler
// turns a loop over lanes into vector instructions with nothing called in between (twice as fast as with the C
// library's vector functions, which spill and reload every constant). The formulas of the terms, templates on their
// scalar, find these functions by the type.
//
// All have 1 to 2 eps of relative error within the ranges named; beyond them the result is the one at the range's end.
// No FMA is assumed: the compiler contracts where the instruction set has one.

#include <bit>
#include <concepts>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "scalar.h"

namespace goniofit {

template <std::floating_point Real>
struct Lane {
  Real v;

  Lane() = default;
  /// Constants of the formulas are doubles.
  template <class Number>
  requires std::is_arithmetic_v<Number>
  [[gnu::always_inline]] constexpr Lane(Number x) noexcept : v(static_cast<Real>(x)) {}

  [[gnu::always_inline]] friend constexpr Lane operator+(Lane a, Lane b) noexcept { return a.v + b.v; }
  [[gnu::always_inline]] friend constexpr Lane operator-(Lane a, Lane b) noexcept { return a.v - b.v; }
  [[gnu::always_inline]] friend constexpr Lane operator*(Lane a, Lane b) noexcept { return a.v * b.v; }
  [[gnu::always_inline]] friend constexpr Lane operator/(Lane a, Lane b) noexcept { return a.v / b.v; }
  [[gnu::always_inline]] friend constexpr Lane operator-(Lane a) noexcept { return -a.v; }
  [[gnu::always_inline]] friend constexpr bool operator<(Lane a, Lane b) noexcept { return a.v < b.v; }
  [[gnu::always_inline]] friend constexpr bool operator>(Lane a, Lane b) noexcept { return a.v > b.v; }
  [[gnu::always_inline]] friend constexpr bool operator<=(Lane a, Lane b) noexcept { return a.v <= b.v; }
  [[gnu::always_inline]] friend constexpr bool operator>=(Lane a, Lane b) noexcept { return a.v >= b.v; }
};

namespace lane {

template <class Real>
struct Format;
template <>
struct Format<double> {
  using Bits = std::uint64_t;
  static constexpr int mantissa = 52, bias = 1023;
  static constexpr double round = 0x1.8p52;                       // x + round has the integer nearest x in its low bits
  static constexpr double ln2_high = 6.93147180369123816490e-01;  // 21 trailing zeros
  static constexpr double ln2_low = 1.90821492927058770002e-10;
  static constexpr double least_exponent = -690.0, greatest_exponent = 709.0;
  static constexpr Bits root_half = 0x3fe6a09e667f3bcd;
};
template <>
struct Format<float> {
  using Bits = std::uint32_t;
  static constexpr int mantissa = 23, bias = 127;
  static constexpr float round = 0x1.8p23F;
  static constexpr float ln2_high = 0.693359375F;
  static constexpr float ln2_low = -2.12194440e-4F;
  static constexpr float least_exponent = -80.0F, greatest_exponent = 88.0F;
  static constexpr Bits root_half = 0x3f3504f3;
};

template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline Real clamped(Real x) noexcept {
  using F = Format<Real>;
  x = x > F::least_exponent ? x : F::least_exponent;
  return x < F::greatest_exponent ? x : F::greatest_exponent;
}

/// x = n ln 2 + r, |r| <= ½ ln 2: e^r - 1 and the bits that multiply a number in [½, 2] by 2^n.
template <class Real>
struct Reduced {
  Real r;
  typename Format<Real>::Bits power;
};
template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline Reduced<Real> reduce(Real x) noexcept {
  using F = Format<Real>;
  const Real shifted = x * Real(1.4426950408889634) + F::round;
  const Real n = shifted - F::round;
  return {(x - n * F::ln2_high) - n * F::ln2_low, std::bit_cast<typename F::Bits>(shifted) << F::mantissa};
}
template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline Real scaled(Real x, typename Format<Real>::Bits power) noexcept {
  return std::bit_cast<Real>(std::bit_cast<typename Format<Real>::Bits>(x) + power);
}

/// (e^r - 1 - r)/r² for |r| <= ½ ln 2: Taylor's series, even and odd powers apart for a short chain.
[[nodiscard]] [[gnu::always_inline]] inline double exp_tail(double r) noexcept {
  const double s = r * r;
  const double s2 = s * s;
  const double low = (1.0 / 2 + r * (1.0 / 6)) + s * (1.0 / 24 + r * (1.0 / 120));
  const double middle = (1.0 / 720 + r * (1.0 / 5040)) + s * (1.0 / 40320 + r * (1.0 / 362880));
  const double high = (1.0 / 3628800 + r * (1.0 / 39916800)) + s * (1.0 / 479001600 + r * (1.0 / 6227020800));
  return low + s2 * (middle + s2 * high);
}
[[nodiscard]] [[gnu::always_inline]] inline float exp_tail(float r) noexcept {
  const float s = r * r;
  return (1.0F / 2 + r * (1.0F / 6)) + s * ((1.0F / 24 + r * (1.0F / 120)) + s * (1.0F / 720 + r * (1.0F / 5040)));
}

/// atanh-like series of ln(1 + f), f = m - 1 with m in [√½, √2]: s = f/(2 + f), R(s²) as in ln(1+f) = f - ½f² + s(½f² +
/// R).
[[nodiscard]] [[gnu::always_inline]] inline double log_tail(double s2) noexcept {
  const double s4 = s2 * s2;
  const double odd = 2.0 / 3 + s4 * (2.0 / 7 + s4 * (2.0 / 11 + s4 * (2.0 / 15 + s4 * (2.0 / 19))));
  const double even = 2.0 / 5 + s4 * (2.0 / 9 + s4 * (2.0 / 13 + s4 * (2.0 / 17)));
  return s2 * (odd + s2 * even);
}
[[nodiscard]] [[gnu::always_inline]] inline float log_tail(float s2) noexcept {
  return s2 * (2.0F / 3 + s2 * (2.0F / 5 + s2 * (2.0F / 7 + s2 * (2.0F / 9))));
}

/// ln x of a normal x > 0 whose distance from 1 is known: where x is near 1 that is what carries the digits.
template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline Real log(Real x, Real x_minus_1) noexcept {
  using F = Format<Real>;
  using Bits = typename F::Bits;
  constexpr Bits one = Bits{F::bias} << F::mantissa;
  constexpr Bits offset = one - F::root_half;
  const Bits bits = std::bit_cast<Bits>(x);
  const Bits exponent = (bits + offset) >> F::mantissa;  // biased, of x/m with m in [√½, √2)
  // The integer as the low bits of 2^mantissa: no conversion, which SSE2 and AVX2 lack for 64 bits.
  constexpr Bits integer = Bits{F::bias + F::mantissa} << F::mantissa;
  const Real k = std::bit_cast<Real>(exponent | integer) - (std::bit_cast<Real>(integer) + Real(F::bias));
  const Real m = std::bit_cast<Real>(bits - (exponent << F::mantissa) + one);
  const Real f = k == Real(0) ? x_minus_1 : m - Real(1);
  const Real s = f / (Real(2) + f);
  const Real half_f2 = Real(0.5) * f * f;
  return k * F::ln2_high - ((half_f2 - (s * (half_f2 + log_tail(s * s)) + k * F::ln2_low)) - f);
}

}  // namespace lane

/// e^x, x in [-690, 709] (float [-80, 88]): the result times whatever else a formula has is no denormal number, which
/// would cost a hundred times the rest.
template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline Lane<Real> exp(Lane<Real> x) noexcept {
  const auto [r, power] = lane::reduce(lane::clamped(x.v));
  return lane::scaled(Real(1) + (r + r * r * lane::exp_tail(r)), power);
}

/// e^x - 1 over the same range, relatively.
template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline Lane<Real> expm1(Lane<Real> x) noexcept {
  const auto [r, power] = lane::reduce(lane::clamped(x.v));
  const Real scale = lane::scaled(Real(1), power);
  return scale * (r + r * r * lane::exp_tail(r)) + (scale - Real(1));
}

/// ln x of a normal x > 0.
template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline Lane<Real> log(Lane<Real> x) noexcept {
  return lane::log(x.v, x.v - Real(1));
}

/// ln(1 + x), x > -1, relatively.
template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline Lane<Real> log1p(Lane<Real> x) noexcept {
  return lane::log(Real(1) + x.v, x.v);
}

/// ln(1 - e^x), x < 0: the two forms of math::log_one_minus_exp are one, since both are at hand.
template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline Lane<Real> log_one_minus_exp(Lane<Real> x) noexcept {
  const auto [r, power] = lane::reduce(lane::clamped(x.v));
  const Real scale = lane::scaled(Real(1), power);
  const Real rise = scale * (r + r * r * lane::exp_tail(r));
  return lane::log((Real(1) - scale) - rise, -(scale + rise));
}

template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline Lane<Real> sqrt(Lane<Real> x) noexcept {
  return std::sqrt(x.v);
}

}  // namespace goniofit

template <class Real>
class std::numeric_limits<goniofit::Lane<Real>> : public std::numeric_limits<Real> {};
