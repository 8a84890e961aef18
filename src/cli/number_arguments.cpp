#include "cli/number_arguments.h"

#include <charconv>
#include <cmath>
#include <system_error>

#include "support/error.h"
#include "support/text.h"

namespace goniofit::cli {

double parse_number(std::string_view text, const std::string& flag) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stop, status] = std::from_chars(text.data(), end, value);
  if (status != std::errc() || stop != end || !std::isfinite(value)) {
    throw usage_error(flag + ": " + in_quotes(text) + " is not a finite number");
  }
  return value;
}

std::vector<std::string> parse_words(std::string_view text, const std::string& flag) {
  std::vector<std::string> words;
  while (true) {
    const std::size_t comma = text.find(',');
    words.emplace_back(text.substr(0, comma));
    if (words.back().empty()) throw usage_error(flag + ": an empty entry, expected a list such as a,b,c");
    if (comma == std::string_view::npos) return words;
    text.remove_prefix(comma + 1);
  }
}

std::vector<double> parse_numbers(std::string_view text, const std::string& flag) {
  std::vector<double> numbers;
  for (const std::string& word : parse_words(text, flag)) numbers.push_back(parse_number(word, flag));
  return numbers;
}

std::pair<std::string, std::string> parse_assignment(std::string_view text, const std::string& flag) {
  // The last one: a channel's name may hold an equals sign.
  const std::size_t equals = text.rfind('=');
  if (equals == std::string_view::npos || equals == 0 || equals + 1 == text.size()) {
    throw usage_error(flag + ": " + in_quotes(text) + ", expected NAME=VALUE such as k_fs=0");
  }
  return {std::string(text.substr(0, equals)), std::string(text.substr(equals + 1))};
}

}  // namespace goniofit::cli
