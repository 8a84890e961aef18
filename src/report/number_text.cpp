#include "report/number_text.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace goniofit {
namespace {

constexpr int most_decimals = 8;

// The decimal exponent of the leading digit after rounding to two digits: 0.0996 rounds to 0.10, exponent -1.
int leading_exponent(double positive) {
  const std::string text = fmt::format("{:.1e}", positive);
  return std::stoi(text.substr(text.find('e') + 1));
}

std::string fixed_text(double value, int decimals) {
  std::string text = fmt::format("{:.{}f}", value, std::max(decimals, 0));
  // A rounded -0.00 is 0.00.
  if (text.front() == '-' && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

double rounded_to(double value, int decimals) {
  if (decimals >= 0) return value;
  const double unit = std::pow(10.0, -decimals);
  return std::round(value / unit) * unit;
}

}  // namespace

ValueText value_text(double value, double uncertainty) {
  if (!std::isfinite(value) || !std::isfinite(uncertainty) || uncertainty <= 0.0) {
    return {number_text(value), number_text(uncertainty)};
  }
  // Next to an uncertainty this large no digit of the value would be left.
  constexpr double hopeless = 100.0;
  if (value != 0.0 && uncertainty > hopeless * std::fabs(value)) {
    return {number_text(value), fmt::format("{:.1e}", uncertainty)};
  }
  const int decimals = 1 - leading_exponent(uncertainty);
  const double largest = std::max(std::fabs(value), uncertainty);
  if (decimals > most_decimals || decimals < -3) {
    const int exponent = leading_exponent(largest);
    const double scale = std::pow(10.0, exponent);
    const int places = std::max(decimals + exponent, 0);
    return {"(" + fixed_text(value / scale, places),
            fixed_text(uncertainty / scale, places) + fmt::format(")e{:+03d}", exponent)};
  }
  return {fixed_text(rounded_to(value, decimals), decimals), fixed_text(rounded_to(uncertainty, decimals), decimals)};
}

std::string number_text(double value) { return value == 0.0 ? "0" : fmt::format("{:.6g}", value); }

std::string percent_text(double part) {
  if (!std::isfinite(part)) return {};
  const double percent = 100.0 * part;
  const double size = std::fabs(percent);
  if (size == 0.0) return "0 %";
  if (size < 1e-3 || size >= 1e4) return fmt::format("{:.1e} %", percent);
  return fixed_text(percent, std::max(1 - leading_exponent(size), 0)) + " %";
}

std::string angle_text(double degrees) { return fmt::format("{:.4g}", std::round(10.0 * degrees) / 10.0); }

std::string duration_text(double seconds) {
  if (seconds < 1.0) return fmt::format("{:.3g} ms", 1e3 * seconds);
  if (seconds < 60.0) return fmt::format("{:.3g} s", seconds);
  const auto whole = static_cast<long>(std::lround(seconds));
  return fmt::format("{} min {} s", whole / 60, whole % 60);
}

}  // namespace goniofit
