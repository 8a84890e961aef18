#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <ostream>
#include <string>
#include <string_view>

#include "geometry/angles.h"
#include "io/number.h"
#include "io/scan_metadata.h"
#include "io/scan_reader.h"
#include "support/error.h"
#include "support/text.h"

namespace goniofit {

namespace {

constexpr int exact_digits = 17;

// Significant digits in the shortest notation, whatever the locale.
void append_number(std::string& out, double value, int digits) {
  std::array<char, 40> text{};
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, digits);
  out.append(text.data(), result.ptr);
}

Error unwritable(const Scan& scan, const std::string& column, const std::string& what) {
  return input_error(scan.source.empty() ? scan.name : scan.source, 0, column, what);
}

void check_channel_name(const Scan& scan, const std::string& name) {
  constexpr std::array<std::string_view, 4> angles{"theta_i", "phi_i", "theta_r", "phi_r"};
  const std::string lower = lower_case(name);
  const bool printable = std::none_of(name.begin(), name.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; });
  const bool plain =
      !name.empty() && trimmed(name) == name && printable && name.find_first_of(",;\"#") == std::string::npos;
  const bool taken = std::find(angles.begin(), angles.end(), lower) != angles.end() || lower.starts_with("u_");
  if (plain && !taken) return;
  throw unwritable(scan, shown(name),
                   "is no channel name that a scan file can have; expected one without "
                   "separators and quotes that is no angle and does not begin with u_");
}

// A line break would end the comment; what the reader takes for padding it would not give back.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; }, ' ');
  text.erase(text.find_last_not_of(" ,;") + 1);
  text.erase(0, std::min(text.find_first_not_of(' '), text.size()));
  return text;
}

template <class T>
bool all_equal(const EntryList<T>& list) {
  return std::all_of(list.begin(), list.end(), [&](const auto& entry) { return entry == list.front(); });
}

// One value, or one a channel; empty where none is known.
template <class T, class Text>
std::string list_text(const EntryList<T>& list, Text&& text_of) {
  if (std::none_of(list.begin(), list.end(), [](const auto& entry) { return entry.has_value(); })) return {};
  if (all_equal(list)) return text_of(*list.front());
  std::string out;
  for (const auto& entry : list)
    out += (out.empty() ? "" : ", ") + (entry ? text_of(*entry) : std::string(unknown_entry));
  return out;
}

EntryList<double> wavelengths_of(const Scan& scan) {
  EntryList<double> list;
  for (const ScanChannel& channel : scan.channels) list.push_back(channel.wavelength_um);
  return list;
}

EntryList<RefractiveIndex> indices_of(const Scan& scan) {
  EntryList<RefractiveIndex> list;
  for (const ScanChannel& channel : scan.channels) {
    list.push_back(channel.n ? std::optional(RefractiveIndex{*channel.n, channel.kappa.value_or(0.0)}) : std::nullopt);
  }
  return list;
}

std::string index_text(const RefractiveIndex& index) {
  return index.kappa == 0.0 ? shortest(index.n) : shortest(index.n) + "+" + shortest(index.kappa) + "i";
}

// The channel names already state their wavelengths.
bool named_by_wavelength(const Scan& scan) {
  return std::all_of(scan.channels.begin(), scan.channels.end(), [](const ScanChannel& channel) {
    return !channel.wavelength_um || wavelength_of_name_um(channel.name) == channel.wavelength_um;
  });
}

std::string channels_text(const Scan& scan) {
  std::string out;
  for (const ScanChannel& channel : scan.channels) {
    if (!is_standard_channel(channel.name)) out += (out.empty() ? "" : ", ") + channel.name;
  }
  return out;
}

// What the members of the scan say, by key; an empty text is nothing to say.
std::string text_of(const Scan& scan, std::string_view key) {
  if (key == scan_key::version) return "1";
  if (key == scan_key::name) return one_line(scan.name);
  if (key == scan_key::channels) return channels_text(scan);
  if (key == scan_key::solid_angle_sr) return scan.solid_angle_sr ? shortest(*scan.solid_angle_sr) : "";
  if (key == scan_key::scale_u) return scan.scale_u ? shortest(*scan.scale_u) : "";
  if (key == scan_key::refractive_index) return list_text(indices_of(scan), index_text);
  return named_by_wavelength(scan) ? "" : list_text(wavelengths_of(scan), shortest);
}

template <class T>
bool says(const EntryList<T>& stated, const EntryList<T>& expected) {
  return stated == expected || (stated.size() == 1 && all_equal(expected) && stated.front() == expected.front());
}

// The text of a line as it was read still says what the members say, so it stays as it is.
bool still_right(const Scan& scan, std::string_view key, const std::string& text) {
  try {
    if (key == scan_key::refractive_index) return says(parse_refractive_index(text), indices_of(scan));
    if (key == scan_key::wavelength_um) return says(parse_wavelength_um(text), wavelengths_of(scan));
    if (key == scan_key::solid_angle_sr) return parse_solid_angle_sr(text) == scan.solid_angle_sr;
    if (key == scan_key::scale_u) return parse_scale_u(text) == scan.scale_u;
    if (key == scan_key::channels) return parse_channel_names(text) == parse_channel_names(channels_text(scan));
  } catch (const MetadataFault&) {
    return false;
  }
  return false;
}

void write_metadata(std::ostream& out, const Scan& scan) {
  std::vector<std::string> written;
  for (const auto& [key, value] : scan.metadata) {
    const std::string lower = lower_case(key);
    const bool keep = !is_scan_key(lower) || still_right(scan, lower, value);
    const std::string text = keep ? one_line(value) : text_of(scan, lower);
    written.push_back(lower);
    if (keep || !text.empty()) out << "# " << one_line(key) << ": " << text << '\n';
  }
  for (const std::string_view key : {scan_key::version, scan_key::name, scan_key::channels, scan_key::refractive_index,
                                     scan_key::wavelength_um, scan_key::solid_angle_sr, scan_key::scale_u}) {
    if (std::find(written.begin(), written.end(), key) != written.end()) continue;
    const std::string text = text_of(scan, key);
    if (!text.empty()) out << "# " << key << ": " << text << '\n';
  }
}

void write_header(std::ostream& out, const Scan& scan) {
  out << (scan.geometry == ScanGeometry::hemispherical ? "theta_i,phi_i,theta_r,phi_r" : "theta_i,theta_r");
  for (const ScanChannel& channel : scan.channels) out << ',' << channel.name;
  for (const ScanChannel& channel : scan.channels) {
    if (!channel.u.empty()) out << ",u_" << channel.name;
  }
  out << '\n';
}

void append_angles(std::string& line, const Scan& scan, std::size_t row, int digits) {
  const AnglePair a = scan.angles(row);
  if (scan.geometry == ScanGeometry::hemispherical) {
    for (const double angle : {a.theta_i_deg, a.phi_i_deg, a.theta_r_deg}) {
      append_number(line, angle, digits);
      line += ',';
    }
    append_number(line, a.phi_r_deg, digits);
    return;
  }
  if (scan.plane_side(row) == 0) {
    throw unwritable(scan, "theta_r",
                     "reading " + std::to_string(row + 1) +
                         " is out of the plane of incidence; expected none in an incidence-plane scan");
  }
  // Not plane_side: at theta_i = 0 it calls both halves forward, and the sign would be lost.
  const bool retro = std::fabs(wrap_deg(a.phi_r_deg - a.phi_i_deg)) < 90.0;
  append_number(line, a.theta_i_deg, digits);
  line += ',';
  append_number(line, retro ? -a.theta_r_deg : a.theta_r_deg, digits);
}

void append_values(std::string& line, const Scan& scan, std::size_t row, int digits) {
  for (const ScanChannel& channel : scan.channels) {
    line += ',';
    append_number(line, channel.values[row], digits);
  }
  for (const ScanChannel& channel : scan.channels) {
    if (channel.u.empty()) continue;
    line += ',';
    append_number(line, channel.u[row], digits);
  }
}

}  // namespace

void write_scan(std::ostream& out, const Scan& scan, int digits) {
  for (const ScanChannel& channel : scan.channels) check_channel_name(scan, channel.name);
  digits = std::clamp(digits, 1, exact_digits);
  write_metadata(out, scan);
  write_header(out, scan);
  std::string line;
  for (std::size_t row = 0; row < scan.size(); ++row) {
    line.clear();
    append_angles(line, scan, row, digits);
    append_values(line, scan, row, digits);
    line += '\n';
    out << line;
  }
}

}  // namespace goniofit
