#pragma once
// Small pieces of the sentences that error messages are made of.

#include <array>
#include <charconv>
#include <cstddef>
#include <string>
#include <string_view>

namespace goniofit {

/// "a", "a or b", "a, b or c".
template <class Range>
[[nodiscard]] std::string alternatives(const Range& names) {
  std::string out;
  std::size_t left = names.size();
  for (const auto& name : names) {
    if (!out.empty()) out += left == 1 ? " or " : ", ";
    out += name;
    --left;
  }
  return out;
}

/// The shortest decimal that reads back as the same double.
[[nodiscard]] inline std::string shortest(double value) {
  std::array<char, 32> buffer{};
  const std::to_chars_result end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), end.ptr};
}

/// Text of a file in quotes, fit for one line of a terminal: control characters become '?', a long text is cut.
[[nodiscard]] inline std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 60;
  std::string out = "\"";
  for (const char c : text.substr(0, longest)) out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  return out + (text.size() > longest ? "...\"" : "\"");
}

/// A key as a step of a JSON pointer (RFC 6901), with its slash: "/k_dd".
[[nodiscard]] inline std::string pointer_step(std::string_view key) {
  std::string out = "/";
  for (const char c : key) {
    if (c == '~')
      out += "~0";
    else if (c == '/')
      out += "~1";
    else
      out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  }
  return out;
}

}  // namespace goniofit
