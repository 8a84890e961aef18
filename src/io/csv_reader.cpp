#include "io/csv_reader.h"

#include <algorithm>

#include "io/number.h"
#include "support/error.h"
#include "support/text.h"

namespace goniofit {

namespace {

bool is_blank(char c) noexcept { return c == ' ' || c == '\t'; }

char separator_of(std::string_view header) noexcept {
  for (const char candidate : {';', ',', '\t'}) {
    if (header.find(candidate) != std::string_view::npos) return candidate;
  }
  return ' ';
}

// The end of the field that begins at `begin`: past a closing quote, then at the separator or the end of the line.
std::size_t field_end(std::string_view line, std::size_t begin, char separator) noexcept {
  std::size_t from = begin;
  if (begin < line.size() && line[begin] == '"') from = line.find('"', begin + 1);
  if (from == std::string_view::npos) return line.size();
  const std::size_t end = separator == ' ' ? line.find_first_of(" \t", from) : line.find(separator, from);
  return std::min(end, line.size());
}

std::string_view unquoted(std::string_view field) noexcept {
  field = trimmed(field);
  const bool has_quotes = field.size() >= 2 && field.front() == '"' && field.back() == '"';
  return has_quotes ? trimmed(field.substr(1, field.size() - 2)) : field;
}

bool is_comment(std::string_view line) noexcept { return trimmed(line).starts_with('#'); }

// Spreadsheets pad every line with separators to the width of the table.
std::string_view without_padding(std::string_view text) noexcept {
  const std::size_t last = text.find_last_not_of(" \t,;");
  return last == std::string_view::npos ? std::string_view{} : text.substr(0, last + 1);
}

bool is_key(std::string_view text) noexcept {
  constexpr std::string_view allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  return !text.empty() && text.find_first_not_of(allowed) == std::string_view::npos;
}

}  // namespace

CsvReader::CsvReader(std::istream& in, const std::string& source, std::string_view expected_names)
    : lines_(in, source) {
  std::string_view line;
  while (lines_.next(line)) {
    if (is_comment(line)) {
      add_comment(line);
    } else if (!without_padding(line).empty()) {
      read_header(line, expected_names);
      return;
    }
  }
  throw input_error(source, 0, "", "there is no header line; expected " + std::string(expected_names));
}

void CsvReader::add_comment(std::string_view line) {
  const std::string_view text = without_padding(trimmed(line).substr(1));
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return;
  const std::string_view key = trimmed(text.substr(0, colon));
  // A sentence with a colon in it, or an address, is a remark.
  if (!is_key(key)) return;
  metadata_.push_back({std::string(key), std::string(trimmed(text.substr(colon + 1))), lines_.number()});
}

void CsvReader::read_header(std::string_view line, std::string_view expected_names) {
  header_line_ = lines_.number();
  separator_ = separator_of(line);
  split(line);
  while (!fields_.empty() && fields_.back().empty()) fields_.pop_back();
  const bool numbers = std::all_of(fields_.begin(), fields_.end(), [](std::string_view field) {
    const NumberFault fault = parse_number(field).fault;
    return fault == NumberFault::none || fault == NumberFault::decimal_comma;
  });
  if (numbers) {
    throw input_error(source(), header_line_, "",
                      "there is no header line before the numbers; expected " + std::string(expected_names));
  }
  for (const std::string_view field : fields_) {
    if (field.empty()) {
      throw input_error(source(), header_line_, std::to_string(names_.size() + 1),
                        "has no name; expected one in the header line");
    }
    names_.emplace_back(field);
  }
  split(line);  // again, now that the number of names is known
  header_text_ = row_text_;
}

void CsvReader::split(std::string_view line) {
  fields_.clear();
  std::size_t begin = 0;
  for (;;) {
    while (begin < line.size() && is_blank(line[begin]) && (separator_ == ' ' || line[begin] != separator_)) ++begin;
    if (begin == line.size() && separator_ == ' ') return;
    const std::size_t end = field_end(line, begin, separator_);
    fields_.push_back(unquoted(line.substr(begin, end - begin)));
    // Where the header's last column ends, the row as text ends.
    if (fields_.size() == names_.size()) row_text_ = line.substr(0, end);
    if (end == line.size()) return;
    begin = end + 1;
  }
}

bool CsvReader::next_row() {
  std::string_view line;
  while (lines_.next(line)) {
    const std::string_view content = trimmed(line);
    if (content.empty() || content.front() == '#') continue;
    split(line);
    if (std::all_of(fields_.begin(), fields_.end(), [](std::string_view field) { return field.empty(); })) continue;
    check_row_length();
    return true;
  }
  return false;
}

void CsvReader::check_row_length() const {
  const std::size_t columns = names_.size();
  if (fields_.size() < columns) {
    throw row_error(fields_.size(), "the row ends before it, after " + std::to_string(fields_.size()) + " of " +
                                        std::to_string(columns) + " fields; expected one field a column");
  }
  const auto extra = std::find_if(fields_.begin() + static_cast<std::ptrdiff_t>(columns), fields_.end(),
                                  [](std::string_view field) { return !field.empty(); });
  if (extra != fields_.end()) {
    const auto position = static_cast<std::size_t>(extra - fields_.begin());
    throw input_error(source(), line(), std::to_string(position + 1),
                      in_quotes(*extra) + " stands beyond the last column " + shown(names_.back()) + "; expected " +
                          std::to_string(columns) + " fields as in the header line");
  }
}

double CsvReader::number(std::size_t column, std::string_view expected) const {
  const ParsedNumber parsed = parse_number(fields_[column]);
  if (parsed.fault != NumberFault::none) throw row_error(column, describe(parsed.fault, fields_[column], expected));
  return parsed.value;
}

Error CsvReader::row_error(std::size_t column, const std::string& what) const {
  return input_error(source(), line(), shown(names_[column]), what);
}

}  // namespace goniofit
