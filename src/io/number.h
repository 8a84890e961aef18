#pragma once
// Numbers in text, whatever the locale, and what is wrong with those that are none.

#include <cstdint>
#include <string>
#include <string_view>

namespace goniofit {

enum class NumberFault : std::uint8_t { none, empty, not_a_number, decimal_comma, not_finite, too_large };

struct ParsedNumber {
  double value = 0.0;
  NumberFault fault = NumberFault::none;
};

/// The whole of `text` as one finite number; a leading + is allowed, blanks are not.
[[nodiscard]] ParsedNumber parse_number(std::string_view text) noexcept;

/// "abc" is not a number; expected EXPECTED.
[[nodiscard]] std::string describe(NumberFault fault, std::string_view text, std::string_view expected);

/// A name of a file as a message shows it: at most 40 bytes, control characters as '?'.
[[nodiscard]] std::string shown(std::string_view text);

/// Without the blanks (space, tab) at both ends.
[[nodiscard]] std::string_view trimmed(std::string_view text) noexcept;
/// ASCII letters in lower case.
[[nodiscard]] std::string lower_case(std::string_view text);

}  // namespace goniofit
