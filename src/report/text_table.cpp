#include "report/text_table.h"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>

namespace goniofit {
namespace {

constexpr std::size_t gap = 2;

const char* ansi_code(Tint tint) {
  switch (tint) {
    case Tint::bold:
      return "\x1b[1m";
    case Tint::faint:
      return "\x1b[2m";
    case Tint::good:
      return "\x1b[32m";
    case Tint::warning:
      return "\x1b[33m";
    case Tint::bad:
      return "\x1b[31m";
    case Tint::none:
      break;
  }
  return "";
}

// fmt measures UTF-8 in display columns, wide characters included, when it pads; the width itself it does not publish.
std::size_t display_width(const std::string& text) {
  constexpr std::size_t wide_enough = 4;
  const std::size_t target = wide_enough * text.size() + 1;
  return target - (fmt::format("{:<{}}", text, target).size() - text.size());
}

std::string padded(const std::string& text, std::size_t width, TextTable::Align align) {
  return align == TextTable::Align::left ? fmt::format("{:<{}}", text, width) : fmt::format("{:>{}}", text, width);
}

void append_line(std::string& out, std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  out += line + '\n';
}

}  // namespace

std::string tinted(const std::string& text, Tint tint, bool color) {
  if (!color || tint == Tint::none || text.empty()) return text;
  return ansi_code(tint) + text + "\x1b[0m";
}

std::string printable(const std::string& text) {
  std::string safe = text;
  for (std::size_t i = 0; i < safe.size(); ++i) {
    const auto byte = static_cast<unsigned char>(safe[i]);
    // U+0080 to U+009F are control characters too: 0x9B alone begins a sequence on some terminals.
    const bool c1 = byte == 0xC2 && i + 1 < safe.size() && static_cast<unsigned char>(safe[i + 1]) < 0xA0;
    if (byte < 0x20 || byte == 0x7F) safe[i] = '?';
    if (c1) safe.replace(i, 2, "?");
  }
  return safe;
}

std::vector<std::size_t> TextTable::widths() const {
  std::vector<std::size_t> widths(columns_.size(), 0);
  for (const std::vector<Cell>& row : rows_) {
    for (std::size_t c = 0; c < std::min(row.size(), columns_.size()); ++c) {
      widths[c] = std::max(widths[c], display_width(row[c].text));
    }
  }
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    if (widths[c] > 0) widths[c] = std::max(widths[c], display_width(columns_[c].title));
  }
  return widths;
}

std::string TextTable::str(std::size_t indent, bool color) const {
  const std::vector<std::size_t> width = widths();
  std::string out;
  std::string line(indent, ' ');
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    if (width[c] == 0) continue;
    line += padded(columns_[c].title, width[c], columns_[c].align) + std::string(gap, ' ');
  }
  line.erase(line.find_last_not_of(' ') + 1);
  const bool titled = line.size() > indent;
  if (titled) out += std::string(indent, ' ') + tinted(line.substr(indent), Tint::faint, color) + '\n';
  for (const std::vector<Cell>& row : rows_) {
    line.assign(indent, ' ');
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      if (width[c] == 0) continue;
      const Cell cell = c < row.size() ? row[c] : Cell{};
      const std::string text = padded(cell.text, width[c], columns_[c].align);
      const std::size_t begin = std::min(text.find_first_not_of(' '), text.size());
      const std::size_t end = text.find_last_not_of(' ') + 1;
      // Only the text itself is coloured, so that the trailing blanks can still be cut.
      line += begin >= end ? text
                           : text.substr(0, begin) + tinted(text.substr(begin, end - begin), cell.tint, color) +
                                 text.substr(end);
      line += std::string(gap, ' ');
    }
    append_line(out, line);
  }
  return out;
}

std::string wrapped(const std::string& text, std::size_t indent, std::size_t width) {
  std::istringstream words(text);
  std::string out;
  std::string word;
  std::size_t column = indent;
  while (words >> word) {
    const std::size_t length = display_width(word);
    if (!out.empty() && column + 1 + length > width) {
      out += '\n' + std::string(indent, ' ');
      column = indent;
    } else if (!out.empty()) {
      out += ' ';
      ++column;
    }
    out += word;
    column += length;
  }
  return out;
}

}  // namespace goniofit
