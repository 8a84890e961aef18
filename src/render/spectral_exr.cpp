#include "render/spectral_exr.h"

#include <algorithm>
#include <cstdio>

#include "io/number.h"

namespace goniofit {

namespace {
constexpr std::string_view prefix = "S0.";
constexpr std::string_view suffix = "nm";
}  // namespace

std::string spectral_channel_name(double wavelength_nm) {
  char number[48];
  std::snprintf(number, sizeof number, "%.6f", wavelength_nm);
  std::string text = number;
  std::replace(text.begin(), text.end(), '.', ',');
  return std::string(prefix) + text + std::string(suffix);
}

std::optional<double> spectral_band_nm(std::string_view name) {
  if (!name.starts_with(prefix) || !name.ends_with(suffix) || name.size() <= prefix.size() + suffix.size()) return {};
  std::string number(name.substr(prefix.size(), name.size() - prefix.size() - suffix.size()));
  std::replace(number.begin(), number.end(), ',', '.');
  const ParsedNumber parsed = parse_number(number);
  if (parsed.fault != NumberFault::none) return std::nullopt;
  return parsed.value;
}

}  // namespace goniofit
