#include "stability.h"

#include <ceres/jet.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "brdf/evaluator.h"
#include "table_inputs.h"

namespace goniofit::stability {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// e^-this is the least that a double holds with all its digits, e^+this the documented saturation.
constexpr long double representable = 690.0L;

double or_infinite(long double error) { return std::isnan(error) ? infinity : static_cast<double>(error); }

double plain_error(double value, long double truth) {
  if (truth == 0.0L) return std::fabs(value) < 1e-300 ? 0.0 : infinity;
  const long double scale = 1.0L + std::fabs(std::log(std::fabs(truth)));
  return or_infinite(std::fabs(value / truth - 1.0L) / scale);
}

double logarithm_error(long double value, long double truth) {
  if (std::isinf(truth)) return value == truth ? 0.0 : infinity;
  return or_infinite(std::fabs(value - truth) / (1.0L + std::fabs(truth)));
}

/// A value whose logarithm is `truth`.
double value_error(double value, long double truth) {
  return or_infinite(std::fabs(std::expm1(std::log(static_cast<long double>(value)) - truth)) /
                     (1.0L + std::fabs(truth)));
}

double outside_range_error(const Outcome<double>& outcome, long double truth) {
  const bool beyond = truth > 0.0L;
  const bool evaluated = std::isnan(outcome.log);  // a whole model
  const bool as_documented = beyond ? (evaluated ? outcome.value == saturation : outcome.value >= 1e299)
                                    : outcome.value >= 0.0 && outcome.value < 1e-290;
  if (!as_documented) return infinity;
  return evaluated || std::isinf(truth) ? 0.0 : logarithm_error(outcome.log, truth);
}

}  // namespace

double error_of(Kind kind, const Outcome<double>& outcome, long double truth) {
  if (kind == Kind::plain) return plain_error(outcome.value, truth);
  if (kind == Kind::logarithm) return logarithm_error(outcome.log, truth);
  return std::fabs(truth) < representable ? value_error(outcome.value, truth) : outside_range_error(outcome, truth);
}

double naive_error_of(Kind kind, double value, long double truth) {
  if (std::isnan(value)) return value;
  if (kind == Kind::plain) {
    if (truth == 0.0L) return value == 0.0 ? 0.0 : 1.0;
    return std::isinf(value) ? infinity : plain_error(value, truth);
  }
  if (std::isinf(truth)) return value < 1e-290 ? 0.0 : 1.0;
  if (kind == Kind::log_of_value && std::fabs(truth) >= representable) return no_double;
  if (value == 0.0) return 1.0;
  if (std::isinf(value)) return infinity;
  if (kind == Kind::logarithm) return logarithm_error(std::log(static_cast<long double>(value)), truth);
  return value_error(value, truth);
}

void Errors::add(std::size_t row, double error, double naive) {
  ++rows_;
  squares_ += error * error;
  if (error > worst_) worst_ = error, worst_row_ = row, naive_there_ = naive;
  const bool worse = std::isnan(naive) ? !std::isnan(naive_worst_) : naive > naive_worst_;
  if (worse) naive_worst_ = naive, naive_worst_row_ = row;
}

double Errors::rms() const { return rows_ > 0 ? std::sqrt(squares_ / static_cast<double>(rows_)) : 0.0; }

long double cell(const test::TruthTable& table, std::size_t row, std::size_t column) {
  const long double number = std::strtold(table.cells(row).at(column).c_str(), nullptr);
  if (std::fabs(number) <= std::numeric_limits<double>::max()) return number;
  return std::copysign(std::numeric_limits<long double>::infinity(), number);
}

namespace {

/// Calls f(row, inputs, pair) for every row.
template <class F>
void for_rows(const test::TruthTable& table, const F& f) {
  for (std::size_t row = 0; row < table.size(); ++row) {
    const Inputs in = truth::inputs_of(table, row);
    f(row, in, make_pair(truth::angles_of(in)));
  }
}

void measure_table(const test::TruthTable& table, Errors Line::*errors, std::vector<Line>& lines) {
  constexpr std::size_t absent = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> columns;
  for (const Quantity& q : quantities()) columns.push_back(table.has(q.column) ? table.column(q.column) : absent);
  for_rows(table, [&](std::size_t row, const Inputs& in, const Pair& pair) {
    const Sample<double> sample = sample_of<double>(in, pair);
    const truth::naive::Sample naive{in};
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (columns[i] == absent) continue;
      const Quantity& q = quantities()[i];
      const long double truth = cell(table, row, columns[i]);
      (lines[i].*errors)
          .add(row, error_of(q.kind, q.in_double(sample), truth), naive_error_of(q.kind, q.naive(naive), truth));
    }
  });
}

using Jet = ceres::Jet<double, 2>;  // by ln slope and ln sigma

struct Derivative {
  const char* name;
  const char* column;
  ShapeSettings settings;
  int parameter;
  double ordinary_budget, hard_budget;
};

/// d ln dd: of the value where doubles hold it, else of its logarithm.
double log_derivative(const Derivative& d, const Inputs& in, const Pair& pair) {
  Sample<Jet, double> sample = sample_of<Jet, double>(in, pair);
  sample.surface.log_slope.v[0] = 1.0;
  sample.surface.log_sigma.v[1] = 1.0;
  const Outcome<Jet> f = dd(d.settings, sample);
  const bool held = std::fabs(f.log.a) < 650.0;
  return held ? f.value.v[d.parameter] / f.value.a : f.log.v[d.parameter];
}

}  // namespace

std::vector<Line> measure(const test::TruthTable& ordinary, const test::TruthTable& hard) {
  std::vector<Line> lines;
  for (const Quantity& q : quantities()) {
    lines.push_back({std::string(q.name), q.ordinary_budget, q.hard_budget, {}, {}});
  }
  measure_table(ordinary, &Line::ordinary, lines);
  measure_table(hard, &Line::hard, lines);
  return lines;
}

std::vector<Line> measure_derivatives(const test::TruthTable& ordinary, const test::TruthTable& hard) {
  constexpr ShapeSettings fast = with(ht_settings, DistributionTier::he_torrance);
  // he_torrance.h claims 1.3e-8 for its table's derivatives.
  const std::array<Derivative, 5> derivatives{{
      {"dd, li-torrance", "dln_dd_lt_dln_slope", lt_settings, 0, 1e-9, 1e-6},
      {"dd, he-torrance-series", "dln_dd_ht_dln_slope", ht_settings, 0, 1e-9, 1e-6},
      {"dd, he-torrance-series", "dln_dd_ht_dln_sigma", ht_settings, 1, 1e-9, 1e-6},
      {"dd, he-torrance", "dln_dd_ht_dln_slope", fast, 0, 1.3e-8, 1e-6},
      {"dd, he-torrance", "dln_dd_ht_dln_sigma", fast, 1, 1.3e-8, 1e-6},
  }};
  std::vector<Line> lines;
  for (const Derivative& d : derivatives) {
    Line line{d.name, d.ordinary_budget, d.hard_budget, {}, {}};
    const auto add = [&](const test::TruthTable& table, Errors& errors) {
      const std::size_t column = table.column(d.column);
      for_rows(table, [&](std::size_t row, const Inputs& in, const Pair& pair) {
        errors.add(row, logarithm_error(log_derivative(d, in, pair), cell(table, row, column)), 0.0);
      });
    };
    add(ordinary, line.ordinary);
    add(hard, line.hard);
    lines.push_back(line);
  }
  return lines;
}

std::string in_short(double error) {
  if (error == no_double) return "-";
  if (std::isnan(error)) return "NaN";
  if (std::isinf(error)) return "inf";
  if (error == 0.0) return "0";
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1e", error);
  return text.data();
}

std::string corner_name(const test::TruthTable& table, std::size_t row) {
  const std::string& corner = table.corner(row);
  return corner.substr(0, corner.find(':'));
}

std::string describe(const test::TruthTable& table, std::size_t row) {
  std::string text = table.where(row) + " (" + table.corner(row) + ")";
  for (const truth::InputColumn& column : truth::input_columns()) {
    text += " " + std::string(column.name) + "=" + table.text(row, column.name);
  }
  return text;
}

std::string markdown(const std::vector<Line>& lines, const test::TruthTable& hard) {
  std::string text =
      "| quantity | ordinary: max, RMS | hard corners: max, where | naive formula there (its own worst) | derivative: "
      "max "
      "|\n|---|---|---|---|---|\n";
  for (const Line& line : lines) {
    text += "| " + line.name + " | ";
    text += line.ordinary.rows() > 0 ? in_short(line.ordinary.worst()) + ", " + in_short(line.ordinary.rms()) : "-";
    text += " | " + in_short(line.hard.worst()) + ", " + corner_name(hard, line.hard.worst_row());
    text += " | " + in_short(line.hard.naive_there()) + " (" + in_short(line.hard.naive_worst()) + ")";
    text += " | " + (line.derivative < 0.0 ? "-" : in_short(line.derivative)) + " |\n";
  }
  return text;
}

}  // namespace goniofit::stability
