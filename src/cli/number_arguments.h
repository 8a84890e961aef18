#pragma once
// Numbers and name=value pairs of the command line, the same in every locale.

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace goniofit::cli {

/// A finite number; all of `text` must belong to it. Throws Error (bad_input) naming `flag`.
[[nodiscard]] double parse_number(std::string_view text, const std::string& flag);
/// "1.7,1.6,1.5".
[[nodiscard]] std::vector<double> parse_numbers(std::string_view text, const std::string& flag);
/// "dd,uds,fs"; an empty part is an error.
[[nodiscard]] std::vector<std::string> parse_words(std::string_view text, const std::string& flag);
/// "k_fs=0" in its two halves, neither of them empty.
[[nodiscard]] std::pair<std::string, std::string> parse_assignment(std::string_view text, const std::string& flag);

}  // namespace goniofit::cli
