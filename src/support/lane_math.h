#pragma once
// One lane of a vectorised loop: a number whose exp, log and the like are branch-free and inline, so that the compiler
// turns a loop over lanes into vector instructions with nothing called in between (the C library's vector functions
// spill and reload around every call). The formulas of the terms, templates on their scalar, find these functions by
// the type.
//
// Polynomials are interpolants at Chebyshev points, computed with 40 digits; the errors named are relative and include
// the rounding. No FMA is assumed: the compiler contracts where the instruction set has one.

#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include <cmath>

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
  Lane& operator+=(Lane a) noexcept { return *this = *this + a; }
  Lane& operator*=(Lane a) noexcept { return *this = *this * a; }
};

namespace lane {

template <class Real>
struct Format;
template <>
struct Format<double> {
  using Bits = std::uint64_t;
  static constexpr int mantissa = 52, bias = 1023;
  static constexpr double round = 0x1.8p52;            // x + round has the integer nearest x in its low bits
  static constexpr double ln2_high = 0x1.62e42feep-1;  // 21 trailing zeros: products with small integers are exact
  static constexpr double ln2_low = 0x1.a39ef35793c76p-33;
  // The result times whatever else a formula has shall be no denormal number, which would cost a hundred times the
  // rest.
  static constexpr double least_exponent = -690.0, greatest_exponent = 709.0;
  static constexpr Bits root_half = 0x3fe6a09e667f3bcd;
};
template <>
struct Format<float> {
  using Bits = std::uint32_t;
  static constexpr int mantissa = 23, bias = 127;
  static constexpr float round = 0x1.8p23F;
  static constexpr float ln2_high = 0x1.63p-1F;
  static constexpr float ln2_low = -0x1.bd0106p-13F;
  static constexpr float least_exponent = -64.0F, greatest_exponent = 88.0F;
  static constexpr Bits root_half = 0x3f3504f3;
};

template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline Real at_least(Real bound, Real x) noexcept {
  return x > bound ? x : bound;
}
template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline Real at_most(Real bound, Real x) noexcept {
  return x < bound ? x : bound;
}

/// Sum of c[k] x^k, in four interleaved chains where it is long: Horner's rule alone waits for itself.
template <class Real, std::size_t n>
[[nodiscard]] [[gnu::always_inline]] inline Real polynomial(const std::array<Real, n>& c, Real x) noexcept {
  const auto horner = [&](std::size_t first, std::size_t step, Real y) __attribute__((always_inline)) {
    std::size_t k = first + (n - 1 - first) / step * step;
    Real sum = c[k];
    while (k >= step + first) {
      k -= step;
      sum = sum * y + c[k];
    }
    return sum;
  };
  if constexpr (n < 6) return horner(0, 1, x);
  const Real x2 = x * x;
  if constexpr (n < 12) return horner(0, 2, x2) + x * horner(1, 2, x2);
  const Real x4 = x2 * x2;
  return (horner(0, 4, x4) + x * horner(1, 4, x4)) + x2 * (horner(2, 4, x4) + x * horner(3, 4, x4));
}

/// x = n ln 2 + r, |r| <= ½ ln 2, and the bits that multiply a number of about 1 by 2^n.
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

/// e^r - 1 for |r| <= ½ ln 2, as r + r² times a polynomial.
template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline Real exp_rise(Real r) noexcept {
  if constexpr (std::is_same_v<Real, float>) {
    constexpr std::array<float, 5> c{0.5F, 0.16666576989698775683F, 0.041666554617204574203F, 0.0083631790527225773704F,
                                     0.0013926183587713494542F};
    return r + r * r * polynomial(c, r);
  } else {
    constexpr std::array<double, 10> c{0.50000000000000010221,   0.16666666666666667453,   0.041666666666624127873,
                                       0.0083333333333300618325, 0.0013888888917213716901, 0.00019841269863053616878,
                                       2.4801521295954375131e-5, 2.7557268459997064772e-6, 2.7620088445409748161e-7,
                                       2.5100385495510319078e-8};
    return r + r * r * polynomial(c, r);
  }
}

/// (ln((1+s)/(1-s))/s - 2)/s² as a function of s², for (1+s)/(1-s) in [√½, √2].
template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline Real log_tail(Real s2) noexcept {
  if constexpr (std::is_same_v<Real, float>) {
    constexpr std::array<float, 3> c{0.66666685045156029067F, 0.39988778282162807727F, 0.29580053043188442144F};
    return polynomial(c, s2);
  } else {
    constexpr std::array<double, 7> c{0.66666666666666696883, 0.39999999999899443233, 0.28571428626003268742,
                                      0.22222211130259877029, 0.18182889455674946039, 0.15331710618210771568,
                                      0.14616585424888621989};
    return polynomial(c, s2);
  }
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
  // ln(1+f) = f - s (f - R(s²)) with s = f/(2+f): the rounding of the quotient meets a small factor only.
  const Real s = f / (Real(2) + f);
  const Real s2 = s * s;
  return k * F::ln2_high + (f - (s * (f - s2 * log_tail(s2)) - k * F::ln2_low));
}

/// e^(x²) erfc(x) (1 + 2x) in t = (x - 3.75)/(x + 3.75), 0 <= x <= 26.
template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline Real scaled_erfc(Real t) noexcept {
  if constexpr (std::is_same_v<Real, float>) {
    constexpr std::array<float, 10> c{1.237512673880656839F,    -0.140244626846854223F,  0.003583761575123683989F,
                                      0.08236593905636578687F,  -0.1087854244733703111F, 0.09176125402449888974F,
                                      -0.05881627576724413423F, 0.02965110054623193511F, -0.009399870745288116766F,
                                      0.000561668056170812754F};
    return polynomial(c, t);
  } else {
    constexpr std::array<double, 22> c{
        1.237512630837827642,      -0.1402405985855470586,    0.003585415485444151819,    0.08227673849014656948,
        -0.1088039301406586477,    0.09230432116076653835,    -0.0586933986124147064,     0.02836227740462939075,
        -0.009746579316659303658,  0.001755626058766035699,   0.0002937122073969962361,   -0.0002901556349445583969,
        0.00005165435660817465722, 0.00002239108670441713105, -0.00001145532009044481139, -9.918027424842235199e-7,
        1.76409716604340991e-6,    -2.820059376521186849e-8,  -2.620329075412501233e-7,   -2.249975959174353957e-9,
        3.221412520213950317e-8,   6.048628409906214402e-9};
    return polynomial(c, t);
  }
}

/// (asin x - x)/x³ as a function of x², for x² up to ½.
template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline Real asin_tail(Real x2) noexcept {
  if constexpr (std::is_same_v<Real, float>) {
    constexpr std::array<float, 7> c{0.16666673576687637826F,  0.074986516632921731973F, 0.045064493159567141356F,
                                     0.025548843194940516754F, 0.047878790478741314884F, -0.047614747773011972809F,
                                     0.084298201926807175832F};
    return polynomial(c, x2);
  } else {
    constexpr std::array<double, 18> c{0.1666666666666666019,   0.075000000000089828145, 0.044642857123585157064,
                                       0.03038194607802385816,  0.022372086303686842396, 0.017354730668996842802,
                                       0.013929824301362787528, 0.011985559032731258472, 0.0058919623838489124448,
                                       0.033823977477227554211, -0.11747841395554579902, 0.46581061083892005836,
                                       -1.2586813003945880318,  2.5735080644015928542,   -3.7415993002001366463,
                                       3.7316474816315223784,   -2.2779904894416329597,  0.66294755483690970266};
    return polynomial(c, x2);
  }
}

}  // namespace lane

/// e^x, x in [-690, 709] (float [-64, 88]); beyond, that of the range's end.
template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline Lane<Real> exp(Lane<Real> x) noexcept {
  using F = lane::Format<Real>;
  const auto [r, power] = lane::reduce(lane::at_most(F::greatest_exponent, lane::at_least(F::least_exponent, x.v)));
  return lane::scaled(Real(1) + lane::exp_rise(r), power);
}

/// The same where x is known to be below the upper end.
template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline Lane<Real> exp_of_negative(Lane<Real> x) noexcept {
  const auto [r, power] = lane::reduce(lane::at_least(lane::Format<Real>::least_exponent, x.v));
  return lane::scaled(Real(1) + lane::exp_rise(r), power);
}

/// e^x - 1, x <= the upper end.
template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline Lane<Real> expm1(Lane<Real> x) noexcept {
  const auto [r, power] = lane::reduce(lane::at_least(lane::Format<Real>::least_exponent, x.v));
  const Real scale = lane::scaled(Real(1), power);
  return scale * lane::exp_rise(r) + (scale - Real(1));
}

/// ln x of a normal x > 0.
template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline Lane<Real> log(Lane<Real> x) noexcept {
  return lane::log(x.v, x.v - Real(1));
}

/// ln(1 + x), x > -1.
template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline Lane<Real> log1p(Lane<Real> x) noexcept {
  return lane::log(Real(1) + x.v, x.v);
}

/// erfc x, 0 <= x; 1e-296 and less come back as that.
template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline Lane<Real> erfc(Lane<Real> x) noexcept {
  constexpr Real reach = std::is_same_v<Real, float> ? Real(8.9) : Real(26);
  const Real a = lane::at_most(reach, x.v);
  const Real inverse = Real(1) / ((a + Real(3.75)) * (Real(1) + Real(2) * a));
  const Real t = (a - Real(3.75)) * (Real(1) + Real(2) * a) * inverse;
  return exp_of_negative(Lane<Real>(-a * a)).v * (a + Real(3.75)) * inverse * lane::scaled_erfc(t);
}

/// By value: a choice between references is one between addresses, which no vector instruction makes.
template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline Lane<Real> select(bool condition, Lane<Real> yes, Lane<Real> no) noexcept {
  return condition ? yes.v : no.v;
}

template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline Lane<Real> sqrt(Lane<Real> x) noexcept {
  return std::sqrt(x.v);
}

/// asin x, |x| <= √½; finite up to 1, where it is not the arc sine.
template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline Lane<Real> asin(Lane<Real> x) noexcept {
  const Real x2 = x.v * x.v;
  return x.v + x.v * x2 * lane::asin_tail(x2);
}

}  // namespace goniofit

template <class Real>
class std::numeric_limits<goniofit::Lane<Real>> : public std::numeric_limits<Real> {};
