#pragma once
// The [parameters] table of a recipe, and the ranges of numbers that recipes have.

#include <limits>
#include <string>

#include "../basis/basis.h"
#include "../fit/settings.h"
#include "toml_value.h"

namespace goniofit {

/// An interval and the words for it.
struct Range {
  double low, high;
  bool low_included, high_included;
  std::string expected;

  [[nodiscard]] bool holds(double x) const noexcept {
    return (low_included ? x >= low : x > low) && (high_included ? x <= high : x < high);
  }
  [[nodiscard]] static Range above(double low) {
    return {low, std::numeric_limits<double>::infinity(), false, true, "a number above " + words(low)};
  }
  [[nodiscard]] static Range at_least(double low) {
    return {low, std::numeric_limits<double>::infinity(), true, true, "a number of at least " + words(low)};
  }
  [[nodiscard]] static Range closed(double low, double high) {
    return {low, high, true, true, "a number in [" + words(low) + ", " + words(high) + "]"};
  }

 private:
  static std::string words(double x);
};

/// Throws Error (bad_input) for what is no finite number or out of range.
[[nodiscard]] double read_number(const TomlValue& value, const Range& range);

/// Reads settings of the parameters that the model has: those of `peer`, or of the surface family where it is null.
/// Reads recipe.channels. Throws Error (bad_input).
void read_parameters(const TomlValue& table, const Basis* peer, Recipe& recipe);

}  // namespace goniofit
