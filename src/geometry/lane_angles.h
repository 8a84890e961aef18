#pragma once
// Sine and cosine of an angle in degrees, branch-free: for scalars and for the lanes of a vectorised loop.

#include "../support/lane_math.h"
#include "angles.h"

namespace goniofit {

/// Beyond this the reduction of sine_cosine_deg is no longer exact: wrap_deg first. Doubles of this size are 1/8°
/// apart.
inline constexpr double most_degrees = 1e15;

template <class T>
struct SineCosine {
  T sine, cosine;
};

namespace lane {

/// Of an angle within 45 degrees, and of somewhat larger ones.
[[nodiscard]] [[gnu::always_inline]] inline double octant_sine(double degrees) noexcept {
  constexpr std::array<double, 7> c{-0.16666666666666666666,   0.0083333333333333314921,  -0.00019841269841265064899,
                                    2.7557319219339129399e-6,  -2.5052106232434683791e-8, 1.6058531616942477437e-10,
                                    -7.5866969972366332944e-13};
  const double x = radians(degrees);
  const double x2 = x * x;
  const double rounded = x + x * (x2 * polynomial(c, x2));
  const double size = degrees < 0.0 ? -degrees : degrees;
  return size == 30.0 ? degrees * (1.0 / 60.0) : rounded;
}
[[nodiscard]] [[gnu::always_inline]] inline double octant_cosine(double degrees) noexcept {
  constexpr std::array<double, 6> c{0.041666666666666665389,   -0.0013888888888887397222, 0.000024801587298765665387,
                                    -2.7557317271718101079e-7, 2.0876146265966423454e-9,  -1.1382632249960622914e-11};
  const double x = radians(degrees);
  const double x2 = x * x;
  const double half = 0.5 * x2;
  const double most = 1.0 - half;
  return most + (((1.0 - most) - half) + x2 * (x2 * polynomial(c, x2)));
}

}  // namespace lane

/// Both to 1 eps, |degrees| <= most_degrees; exact where sin_deg and cos_deg are.
[[nodiscard]] [[gnu::always_inline]] inline SineCosine<Lane<double>> sine_cosine_deg(Lane<double> degrees) noexcept {
  // d = 90 n + r, |r| <= 45 but for a rounding: exact, since d and 90 n are multiples of the spacing of d or of 1.
  constexpr double round = lane::Format<double>::round;
  const double shifted = degrees.v * (1.0 / 90.0) + round;
  const double r = degrees.v - (shifted - round) * 90.0;
  const double sine = lane::octant_sine(r);
  const double cosine = lane::octant_cosine(r);
  // The quadrant, n modulo 4, is in the low bits of `shifted`; 0.0 is added so that no zero is negative.
  const std::uint64_t n = std::bit_cast<std::uint64_t>(shifted);
  const bool odd = (n & 1U) != 0;
  const double along = odd ? cosine : sine;
  const double across = odd ? sine : cosine;
  const auto signed_by = [](double value, std::uint64_t bit) __attribute__((always_inline)) {
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(value) ^ ((bit & 2U) << 62U)) + 0.0;
  };
  return {signed_by(along, n), signed_by(across, n + 1)};
}

}  // namespace goniofit
