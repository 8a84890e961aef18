#pragma once
// Tables for a terminal: columns as wide as their widest cell, in display columns rather than bytes, coloured or plain.

#include <cstdint>
#include <string>
#include <vector>

namespace goniofit {

enum class Tint : std::uint8_t { none, bold, faint, good, warning, bad };

/// The text in the tint's ANSI colour; unchanged without `color`.
[[nodiscard]] std::string tinted(const std::string& text, Tint tint, bool color);

/// Text from files, made safe for a terminal: control characters (escape sequences begin with one) become '?'.
[[nodiscard]] std::string printable(const std::string& text);

struct Cell {
  Cell(std::string cell_text = {}, Tint cell_tint = Tint::none) : text(std::move(cell_text)), tint(cell_tint) {}
  Cell(const char* cell_text) : text(cell_text) {}
  std::string text;
  Tint tint = Tint::none;
};

class TextTable {
 public:
  enum class Align : std::uint8_t { left, right };
  struct Column {
    std::string title;
    Align align = Align::left;
  };

  explicit TextTable(std::vector<Column> columns) : columns_(std::move(columns)) {}

  /// Missing cells are empty. A column that stays empty in every row is not printed.
  void add_row(std::vector<Cell> cells) { rows_.push_back(std::move(cells)); }
  [[nodiscard]] bool empty() const noexcept { return rows_.empty(); }
  /// Lines end with a newline and carry no trailing blanks.
  [[nodiscard]] std::string str(std::size_t indent, bool color) const;

 private:
  [[nodiscard]] std::vector<std::size_t> widths() const;

  std::vector<Column> columns_;
  std::vector<std::vector<Cell>> rows_;
};

/// `text` in lines of at most `width` columns broken at blanks; all but the first indented.
[[nodiscard]] std::string wrapped(const std::string& text, std::size_t indent, std::size_t width = 100);

}  // namespace goniofit
