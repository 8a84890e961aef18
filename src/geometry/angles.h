#pragma once
// Degrees at the edge, radians never: trigonometry of degrees that is exact where the value is (0, 30, 60, 90, 180
// ...).

namespace goniofit {

inline constexpr double pi = 3.141592653589793238462643383279502884;

/// sin and cos of an angle in degrees; multiples of 90° give exactly 0 and ±1, 30° and 60° exactly ½.
[[nodiscard]] double sin_deg(double degrees) noexcept;
[[nodiscard]] double cos_deg(double degrees) noexcept;

[[nodiscard]] constexpr double radians(double degrees) noexcept { return degrees * (pi / 180.0); }
[[nodiscard]] constexpr double degrees(double radians) noexcept { return radians * (180.0 / pi); }

/// The same azimuth in (-180, 180].
[[nodiscard]] double wrap_deg(double degrees) noexcept;

}  // namespace goniofit
