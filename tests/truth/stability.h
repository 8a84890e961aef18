#pragma once
// The error of every column against the 50-digit tables, and of the textbook form at the same rows.

#include <cstddef>
#include <string>
#include <vector>

#include "quantities.h"
#include "support/truth_table.h"

namespace goniofit::stability {

/// Relative error over 1 + |ln f|: what exponents amplify belongs to the magnitude. Infinity for NaN or a wrong 0.
[[nodiscard]] double error_of(Kind kind, const Outcome<double>& outcome, long double truth);

/// What naive_error_of returns where the value leaves the range of doubles: no textbook form is to blame.
inline constexpr double no_double = -1.0;

/// The same of a textbook value, which may be NaN or infinite, and is 1 for a 0 that is none.
[[nodiscard]] double naive_error_of(Kind kind, double value, long double truth);

/// Errors of one quantity over one table.
class Errors {
 public:
  void add(std::size_t row, double error, double naive);
  [[nodiscard]] std::size_t rows() const { return rows_; }
  [[nodiscard]] double worst() const { return worst_; }
  [[nodiscard]] double rms() const;
  [[nodiscard]] std::size_t worst_row() const { return worst_row_; }
  [[nodiscard]] double naive_there() const { return naive_there_; }
  [[nodiscard]] double naive_worst() const { return naive_worst_; }
  [[nodiscard]] std::size_t naive_worst_row() const { return naive_worst_row_; }

 private:
  std::size_t rows_ = 0, worst_row_ = 0, naive_worst_row_ = 0;
  double worst_ = -1.0, squares_ = 0.0, naive_there_ = 0.0, naive_worst_ = no_double;
};

/// A quantity over both tables; ordinary.csv leaves some columns out.
struct Line {
  std::string name;
  double ordinary_budget, hard_budget;
  Errors ordinary, hard;
  double derivative = no_double;  ///< the largest error of its derivatives, hard corners included
};

/// What terms read of the directions, against 50-digit pairs: relative errors, every twentieth ordinary row.
[[nodiscard]] std::vector<Line> measure_geometry(const test::TruthTable& ordinary, const test::TruthTable& hard);

/// Every quantity of quantities.h.
[[nodiscard]] std::vector<Line> measure(const test::TruthTable& ordinary, const test::TruthTable& hard);

/// The columns dln_dd_*, by dual numbers: |error| / (1 + |derivative|).
[[nodiscard]] std::vector<Line> measure_derivatives(const test::TruthTable& ordinary, const test::TruthTable& hard);

/// A cell of the tables with all of its digits that a long double holds.
[[nodiscard]] long double cell(const test::TruthTable& table, std::size_t row, std::size_t column);

/// "2.0e-16", "NaN" or "inf"; "-" for no_double.
[[nodiscard]] std::string in_short(double error);

/// The first words of a row's corner.
[[nodiscard]] std::string corner_name(const test::TruthTable& table, std::size_t row);

/// The row's inputs, for messages.
[[nodiscard]] std::string describe(const test::TruthTable& table, std::size_t row);

/// The README's table.
[[nodiscard]] std::string markdown(const std::vector<Line>& lines, const test::TruthTable& hard);

}  // namespace goniofit::stability
