// "Stability is a number": every quantity in double against the 50-digit tables, and how a textbook's form fares.
// Budgets: 1e-12 on ordinary rows and 1e-9 in the hard corners, of the relative error over 1 + |ln f|; 1e-9 and 1e-6
// for derivatives. The inputs' own conditioning is not needed as an excuse anywhere.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <utility>

#include "brdf/evaluator.h"
#include "stability.h"
#include "table_inputs.h"

namespace goniofit::stability {
namespace {

using test::TruthTable;

void print(const char* table_name, const TruthTable& table, const Line& line, const Errors& errors) {
  if (errors.rows() == 0) return;
  std::printf("%-38s %-8s %5zu rows, max %s, RMS %s; naive there %s\n    at %s\n    naive worst %s at %s\n",
              line.name.c_str(), table_name, errors.rows(), in_short(errors.worst()).c_str(),
              in_short(errors.rms()).c_str(), in_short(errors.naive_there()).c_str(),
              describe(table, errors.worst_row()).c_str(), in_short(errors.naive_worst()).c_str(),
              describe(table, errors.naive_worst_row()).c_str());
}

void expect_within_budget(const TruthTable& ordinary, const TruthTable& hard, const Line& line) {
  if (line.ordinary.rows() > 0) {
    EXPECT_LE(line.ordinary.worst(), line.ordinary_budget)
        << line.name << " at " << describe(ordinary, line.ordinary.worst_row());
  }
  EXPECT_LE(line.hard.worst(), line.hard_budget) << line.name << " at " << describe(hard, line.hard.worst_row());
}

// The claim of W itself, not over 1 + |ln W|: 1e-9 for he-torrance. What half an ulp of ln g does to ln W (the table
// has its derivative) and what a double's ln W can hold come off: at g = 1e8 and a wide x that is 1e-10.
TEST(Stability, LobeSumsKeepTheirClaims) {
  const TruthTable table("lobe_sum");
  double fast = 0.0;
  double series = 0.0;
  for (std::size_t row = 0; row < table.size(); ++row) {
    const double log_g = std::log(table.number(row, "g"));
    const double x = table.number(row, "x");
    const long double truth = cell(table, row, table.column("ln_W"));
    const double rounding =
        1.2e-16 * std::fabs(log_g * table.number(row, "dln_W_dln_g")) + 1e-15 * std::fabs(static_cast<double>(truth));
    const auto error = [&](double log_w) {
      return std::max(0.0, std::fabs(static_cast<double>(log_w - truth)) - rounding);
    };
    const double fast_error = error(he_torrance_log_w(log_g, x));
    const double series_error = error(log_he_torrance_series(log_g, x));
    EXPECT_LE(fast_error, 1e-9) << table.where(row);
    EXPECT_LE(series_error, 1e-12) << table.where(row) << " rounding " << rounding;
    fast = std::max(fast, fast_error);
    series = std::max(series, series_error);
  }
  std::printf("W against lobe_sum.csv: he-torrance %.2g, he-torrance-series %.2g\n", fast, series);
}

// Of the hard rows, those whose value no double holds.
TEST(Stability, ValuesBeyondTheRangeAreTheDocumentedSaturation) {
  const TruthTable hard("hard");
  const auto lt =
      std::find_if(quantities().begin(), quantities().end(), [](const Quantity& q) { return q.column == "ln_f_lt"; });
  std::size_t beyond = 0;
  for (std::size_t row = 0; row < hard.size(); ++row) {
    if (!(cell(hard, row, hard.column("ln_f_lt")) > std::log(saturation))) continue;
    const Inputs in = truth::inputs_of(hard, row);
    EXPECT_EQ(lt->in_double(sample_of<double>(in, make_pair(truth::angles_of(in)))).value, saturation)
        << describe(hard, row);
    ++beyond;
  }
  EXPECT_GT(beyond, 5U);
}

TEST(Stability, EveryColumnKeepsItsBudget) {
  const TruthTable ordinary("ordinary");
  const TruthTable hard("hard");
  std::vector<Line> lines = measure_geometry(ordinary, hard);
  for (Line& line : measure(ordinary, hard)) lines.push_back(std::move(line));
  for (const Line& line : lines) {
    print("ordinary", ordinary, line, line.ordinary);
    print("hard", hard, line, line.hard);
    expect_within_budget(ordinary, hard, line);
  }
  for (const Line& derivative : measure_derivatives(ordinary, hard)) {
    const std::string name = "derivative of ln " + derivative.name;
    std::printf("%-45s ordinary %s, RMS %s; hard %s, RMS %s\n    at %s\n", name.c_str(),
                in_short(derivative.ordinary.worst()).c_str(), in_short(derivative.ordinary.rms()).c_str(),
                in_short(derivative.hard.worst()).c_str(), in_short(derivative.hard.rms()).c_str(),
                describe(hard, derivative.hard.worst_row()).c_str());
    expect_within_budget(ordinary, hard, derivative);
    for (Line& line : lines) {
      if (line.name != derivative.name) continue;
      line.derivative = std::max({line.derivative, derivative.ordinary.worst(), derivative.hard.worst()});
    }
  }
  if (const char* const file = std::getenv("GONIOFIT_STABILITY_TABLE")) {
    std::ofstream out(file);
    out << markdown(lines, hard);
    EXPECT_TRUE(out.good()) << file;
  }
}

}  // namespace
}  // namespace goniofit::stability
