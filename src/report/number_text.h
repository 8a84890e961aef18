#pragma once
// Numbers as a person wants to read them: rounded to what the uncertainty supports.

#include <optional>
#include <string>

namespace goniofit {

/// A value and its standard uncertainty with the same decimals, the uncertainty to two significant digits:
/// 0.085374 and 0.000213 give "0.08537" and "0.00021". Very small and very large ones share an exponent:
/// "(3.21" and "0.42)e-09". A value far below its uncertainty keeps six digits of its own.
struct ValueText {
  std::string value, uncertainty;
};
[[nodiscard]] ValueText value_text(double value, double uncertainty);

/// Six significant digits, no trailing zeros.
[[nodiscard]] std::string number_text(double value);
/// A part of one as percent with two significant digits: "0.25 %"; empty where it is not finite.
[[nodiscard]] std::string percent_text(double part);
/// To a tenth of a degree, without trailing zeros or a unit.
[[nodiscard]] std::string angle_text(double degrees);
/// 38.2 ms, 1.24 s, 3 min 20 s.
[[nodiscard]] std::string duration_text(double seconds);

}  // namespace goniofit
