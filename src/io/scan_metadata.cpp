#include "io/scan_metadata.h"

#include <fast_float/fast_float.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "geometry/angles.h"
#include "io/number.h"
#include "support/text.h"

namespace goniofit {

namespace {

constexpr double shortest_wavelength_um = 0.01;
constexpr double longest_wavelength_um = 100.0;

double parse_value(std::string_view text, std::string_view expected) {
  const ParsedNumber parsed = parse_number(text);
  if (parsed.fault != NumberFault::none) throw MetadataFault(describe(parsed.fault, text, expected));
  return parsed.value;
}

std::vector<std::string_view> entries_of(std::string_view text) {
  std::vector<std::string_view> entries;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    entries.push_back(trimmed(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  return entries;
}

template <class T, class Parse>
EntryList<T> parse_list(std::string_view text, Parse&& parse) {
  EntryList<T> list;
  for (const std::string_view entry : entries_of(text)) {
    list.push_back(lower_case(entry) == unknown_entry ? std::nullopt : std::optional<T>(parse(entry)));
  }
  return list;
}

// "1.7", "0.958+6.69i", "0.958 + 6.69 i".
RefractiveIndex parse_index(std::string_view entry) {
  constexpr std::string_view expected = "n or n+kappa*i, such as 1.7 or 0.958+6.69i";
  std::string text(entry);
  std::erase_if(text, [](char c) { return c == ' ' || c == '\t'; });
  RefractiveIndex index{0.0, 0.0};
  if (text.ends_with('i')) {
    double first = 0.0;
    const auto [rest, status] = fast_float::from_chars(text.data(), text.data() + text.size(), first);
    const std::string_view second(rest, static_cast<std::size_t>(text.data() + text.size() - 1 - rest));
    const bool signed_second = second.size() > 1 && (second.front() == '+' || second.front() == '-');
    if (status == std::errc::invalid_argument || !signed_second) {
      throw MetadataFault(describe(NumberFault::not_a_number, entry, expected));
    }
    index = {first, parse_value(second, expected)};
  } else {
    index.n = parse_value(text, expected);
  }
  if (!(index.n > 0.0) || !std::isfinite(index.n))
    throw MetadataFault(in_quotes(entry) + " is out of range; expected n above 0");
  if (index.kappa < 0.0) {
    throw MetadataFault(in_quotes(entry) + " is out of range; expected kappa from 0 up (absorption is n+kappa*i)");
  }
  return index;
}

double parse_wavelength(std::string_view entry) {
  const double value = parse_value(entry, "a wavelength in micrometres");
  check_wavelength_um(value);
  return value;
}

}  // namespace

bool is_scan_key(std::string_view key) noexcept {
  constexpr std::array keys{scan_key::version,       scan_key::name,           scan_key::refractive_index,
                            scan_key::wavelength_um, scan_key::solid_angle_sr, scan_key::scale_u,
                            scan_key::channels};
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

EntryList<RefractiveIndex> parse_refractive_index(std::string_view text) {
  return parse_list<RefractiveIndex>(text, parse_index);
}

EntryList<double> parse_wavelength_um(std::string_view text) { return parse_list<double>(text, parse_wavelength); }

double parse_solid_angle_sr(std::string_view text) {
  const double value = parse_value(text, "a solid angle in steradians");
  if (!(value > 0.0) || value > 2.0 * pi) {
    throw MetadataFault(in_quotes(text) + " is out of range; expected a solid angle above 0 and up to 2 pi sr");
  }
  return value;
}

double parse_scale_u(std::string_view text) {
  const double value = parse_value(text, "a relative standard uncertainty");
  if (!(value >= 0.0) || value > 1.0) {
    throw MetadataFault(in_quotes(text) + " is out of range; expected a part of the readings from 0 to 1");
  }
  return value;
}

std::vector<std::string> parse_channel_names(std::string_view text) {
  std::vector<std::string> names;
  for (const std::string_view entry : entries_of(text)) {
    if (entry.empty()) throw MetadataFault("an entry is empty; expected column names separated by commas");
    names.emplace_back(entry);
  }
  return names;
}

void check_wavelength_um(double wavelength_um) {
  if (wavelength_um >= shortest_wavelength_um && wavelength_um <= longest_wavelength_um) return;
  throw MetadataFault("the wavelength is out of range; expected 0.01 to 100 micrometres (10 to 100000 nm)");
}

bool is_rgb(std::string_view name) noexcept {
  constexpr std::string_view letters = "RGBrgb";
  return name.size() == 1 && letters.find(name.front()) != std::string_view::npos;
}

std::optional<double> wavelength_of_name_um(std::string_view name) noexcept {
  constexpr std::string_view scale = "e-3";
  constexpr std::size_t longest_number = 24;
  const bool unit = name.ends_with("nm") || name.ends_with("NM") || name.ends_with("Nm") || name.ends_with("nM");
  if (!unit) return std::nullopt;
  const std::string_view digits = trimmed(name.substr(0, name.size() - 2));
  const bool plain = !digits.empty() && digits.size() <= longest_number &&
                     digits.find_first_not_of("0123456789.") == std::string_view::npos;
  if (!plain) return std::nullopt;
  // Scaled in the text, so that 632.8nm is the double nearest to 0.6328 and equals the metadata's.
  std::array<char, longest_number + scale.size()> text{};
  char* const end = std::copy(scale.begin(), scale.end(), std::copy(digits.begin(), digits.end(), text.begin()));
  const ParsedNumber parsed = parse_number({text.data(), static_cast<std::size_t>(end - text.data())});
  if (parsed.fault != NumberFault::none) return std::nullopt;
  return parsed.value;
}

bool is_standard_channel(std::string_view name) noexcept {
  return is_rgb(name) || wavelength_of_name_um(name).has_value();
}

}  // namespace goniofit
