#include "io/number.h"

#include <fast_float/fast_float.h>

#include <algorithm>
#include <cmath>

#include "support/text.h"

namespace goniofit {

namespace {

bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }

NumberFault fault_of(std::string_view text) noexcept {
  constexpr std::size_t longest_number = 64;
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos || text.size() > longest_number) return NumberFault::not_a_number;
  char with_point[longest_number];
  std::copy(text.begin(), text.end(), with_point);
  with_point[comma] = '.';
  const bool number = parse_number({with_point, text.size()}).fault == NumberFault::none;
  return number ? NumberFault::decimal_comma : NumberFault::not_a_number;
}

}  // namespace

ParsedNumber parse_number(std::string_view text) noexcept {
  if (text.empty()) return {0.0, NumberFault::empty};
  std::string_view digits = text;
  // fast_float takes no plus sign; "+-1" must stay an error.
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
  double value = 0.0;
  const char* const end = digits.data() + digits.size();
  const auto [rest, status] = fast_float::from_chars(digits.data(), end, value);
  if (status == std::errc::invalid_argument || rest != end) return {0.0, fault_of(text)};
  if (std::isfinite(value)) return {value, NumberFault::none};
  const bool written_out = std::any_of(digits.begin(), digits.end(), is_digit);
  return {0.0, written_out ? NumberFault::too_large : NumberFault::not_finite};
}

std::string describe(NumberFault fault, std::string_view text, std::string_view expected) {
  const std::string tail = "; expected " + std::string(expected);
  switch (fault) {
    case NumberFault::empty:
      return "the field is empty" + tail;
    case NumberFault::not_finite:
      return in_quotes(text) + " is not finite" + tail;
    case NumberFault::too_large:
      return in_quotes(text) + " is too large" + tail;
    case NumberFault::decimal_comma: {
      std::string pointed(text);
      pointed[pointed.find(',')] = '.';
      return in_quotes(text) + " has a decimal comma; expected a decimal point, " + pointed;
    }
    case NumberFault::not_a_number:
    case NumberFault::none:
      break;
  }
  return in_quotes(text) + " is not a number" + tail;
}

std::string shown(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string out(text.substr(0, longest));
  // Cut between characters, not inside one.
  if (text.size() > longest) {
    while (!out.empty() && (static_cast<unsigned char>(text[out.size()]) & 0xC0U) == 0x80U) out.pop_back();
    out += "...";
  }
  for (char& c : out) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
  }
  return out;
}

std::string_view trimmed(std::string_view text) noexcept {
  constexpr std::string_view blanks = " \t";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return out;
}

}  // namespace goniofit
