#pragma once
// The committed truth tables (tests/truth/*.csv): numbers by column name, the exact text beside them. What each column
// holds stands at the head of tests/truth/definitions.h.

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "support/paths.h"

namespace goniofit::test {

class TruthTable {
 public:
  /// "ordinary", "hard", "lobe_sum" or "oren_nayar_integral". Throws std::runtime_error for a file that is missing or
  /// not rectangular.
  explicit TruthTable(const std::string& name) : path_(source_dir() / "tests" / "truth" / (name + ".csv")) {
    std::ifstream in(path_);
    if (!in) throw std::runtime_error("no file " + path_.string());
    std::string line;
    std::getline(in, line);
    header_ = split(line);
    while (std::getline(in, line)) {
      rows_.push_back(split(line));
      if (rows_.back().size() != header_.size())
        throw std::runtime_error(path_.string() + ":" + std::to_string(rows_.size() + 1) +
                                 ": cells do not match columns");
    }
  }

  [[nodiscard]] std::size_t size() const { return rows_.size(); }
  [[nodiscard]] const std::vector<std::string>& header() const { return header_; }
  [[nodiscard]] bool has(std::string_view column) const {
    return std::find(header_.begin(), header_.end(), column) != header_.end();
  }

  /// The index of a column, for loops over rows. Throws std::out_of_range for a name that is none.
  [[nodiscard]] std::size_t column(std::string_view name) const {
    const auto found = std::find(header_.begin(), header_.end(), name);
    if (found == header_.end()) throw std::out_of_range(path_.string() + " has no column " + std::string(name));
    return static_cast<std::size_t>(found - header_.begin());
  }

  /// The nearest double; +-infinity for "inf", "-inf" and for what leaves the range.
  [[nodiscard]] double number(std::size_t row, std::size_t column) const {
    const std::string& cell = rows_.at(row).at(column);
    char* end = nullptr;
    const double value = std::strtod(cell.c_str(), &end);
    if (cell.empty() || *end != '\0')
      throw std::runtime_error(where(row) + ": " + header_.at(column) + " is no number: " + cell);
    return value;
  }
  [[nodiscard]] double number(std::size_t row, std::string_view name) const { return number(row, column(name)); }

  [[nodiscard]] const std::string& text(std::size_t row, std::string_view name) const {
    return rows_.at(row).at(column(name));
  }
  [[nodiscard]] const std::vector<std::string>& cells(std::size_t row) const { return rows_.at(row); }

  /// What goes wrong in this row if done naively ("hard"), or its stratum ("ordinary").
  [[nodiscard]] const std::string& corner(std::size_t row) const { return text(row, "corner"); }

  /// "path:line", for messages.
  [[nodiscard]] std::string where(std::size_t row) const { return path_.string() + ":" + std::to_string(row + 2); }

 private:
  [[nodiscard]] static std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream in(line);
    std::string cell;
    while (std::getline(in, cell, ',')) cells.push_back(std::move(cell));
    return cells;
  }

  std::filesystem::path path_;
  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace goniofit::test
