#pragma once
// Tables as text: comment lines `# key: value`, a header line, rows. Knows nothing of what the columns mean.

#include <cstddef>
#include <cstdint>
#include <istream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "../support/error.h"
#include "line_reader.h"

namespace goniofit {

/// A `# key: value` line above the header.
struct MetadataEntry {
  std::string key, value;
  std::size_t line = 0;
};

/// Separators are , ; tab or blanks, whichever the header line has. Blank lines, comment lines among the rows, trailing
/// separators and fields in double quotes are accepted. Errors name file, line and column.
class CsvReader {
 public:
  /// Reads as far as the header line. Throws Error (bad_input) where there is none or a name is empty; `expected_names`
  /// is what the message offers.
  CsvReader(std::istream& in, const std::string& source, std::string_view expected_names);

  [[nodiscard]] const std::string& source() const noexcept { return lines_.source(); }
  [[nodiscard]] const std::vector<MetadataEntry>& metadata() const noexcept { return metadata_; }
  /// As the header line has them, without blanks around.
  [[nodiscard]] const std::vector<std::string>& names() const noexcept { return names_; }
  [[nodiscard]] std::size_t header_line() const noexcept { return header_line_; }
  /// ' ' stands for any run of blanks.
  [[nodiscard]] char separator() const noexcept { return separator_; }
  /// The header line as far as its last name.
  [[nodiscard]] const std::string& header_text() const noexcept { return header_text_; }

  /// The next row, with as many fields as the header has names; false at the end. Throws Error for short and long rows.
  [[nodiscard]] bool next_row();
  [[nodiscard]] std::size_t line() const noexcept { return lines_.number(); }
  [[nodiscard]] std::uint64_t consumed() const noexcept { return lines_.consumed(); }
  [[nodiscard]] std::string_view field(std::size_t column) const noexcept { return fields_[column]; }
  /// The row as it stands, as far as its last field that has a name.
  [[nodiscard]] std::string_view row_text() const noexcept { return row_text_; }
  /// The field as a finite number; else Error with what was expected.
  [[nodiscard]] double number(std::size_t column, std::string_view expected) const;
  /// "FILE:LINE: column NAME: what" at the row last read.
  [[nodiscard]] Error row_error(std::size_t column, const std::string& what) const;

 private:
  void read_header(std::string_view line, std::string_view expected_names);
  void add_comment(std::string_view line);
  void check_row_length() const;
  void split(std::string_view line);

  LineReader lines_;
  std::vector<MetadataEntry> metadata_;
  std::vector<std::string> names_;
  std::size_t header_line_ = 0;
  char separator_ = ',';
  std::string header_text_;
  std::vector<std::string_view> fields_;  // of the line last split, views into the line reader's buffer
  std::string_view row_text_;
};

}  // namespace goniofit
