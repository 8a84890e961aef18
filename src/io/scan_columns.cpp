#include "io/scan_columns.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

#include "io/number.h"
#include "io/scan_metadata.h"
#include "support/error.h"
#include "support/text.h"

namespace goniofit {

namespace {

struct AngleName {
  std::string_view name;
  ColumnRole role;
};
constexpr std::array angle_names{AngleName{"theta_i", ColumnRole::theta_i}, AngleName{"phi_i", ColumnRole::phi_i},
                                 AngleName{"theta_r", ColumnRole::theta_r}, AngleName{"phi_r", ColumnRole::phi_r}};
constexpr std::string_view uncertainty_prefix = "u_";

Error header_error(const CsvReader& csv, const std::string& column, const std::string& what) {
  return input_error(csv.source(), csv.header_line(), shown(column), what);
}

ColumnRole angle_role(std::string_view lower_name) noexcept {
  const auto found = std::find_if(angle_names.begin(), angle_names.end(),
                                  [&](const AngleName& angle) { return angle.name == lower_name; });
  return found == angle_names.end() ? ColumnRole::ignored : found->role;
}

bool has(const ScanColumns& columns, ColumnRole role) {
  return std::any_of(columns.columns.begin(), columns.columns.end(),
                     [&](const ScanColumn& c) { return c.role == role; });
}

// Two names are one column where they differ in case only, or are the same wavelength: they have the same key.
std::string column_key(std::string_view name) {
  const std::optional<double> wavelength = wavelength_of_name_um(name);
  if (!wavelength) return lower_case(name);
  std::array<char, 32> digits{};
  const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), *wavelength);
  return std::string(digits.data(), result.ptr) + " um";
}

// A map, since a header line may hold half a million names.
using ColumnIndex = std::unordered_map<std::string, std::size_t>;

void check_named_once(const CsvReader& csv, bool angles_only) {
  ColumnIndex seen;
  for (std::size_t c = 0; c < csv.names().size(); ++c) {
    const std::string& name = csv.names()[c];
    if (angles_only && angle_role(lower_case(name)) == ColumnRole::ignored) continue;
    const auto [first, is_new] = seen.emplace(column_key(name), c);
    if (is_new) continue;
    throw header_error(csv, name,
                       "is in the header line twice, as columns " + std::to_string(first->second + 1) + " and " +
                           std::to_string(c + 1) + "; expected each column once");
  }
}

void check_geometry(const CsvReader& csv, ScanColumns& columns) {
  constexpr const char* expected =
      "is missing; expected theta_i, phi_i, theta_r, phi_r (hemispherical) or theta_i, theta_r (incidence plane, "
      "theta_r "
      "signed)";
  const bool any_phi = has(columns, ColumnRole::phi_i) || has(columns, ColumnRole::phi_r);
  for (const AngleName& angle : angle_names) {
    const bool is_phi = angle.role == ColumnRole::phi_i || angle.role == ColumnRole::phi_r;
    if (!has(columns, angle.role) && (!is_phi || any_phi)) throw header_error(csv, std::string(angle.name), expected);
  }
  columns.geometry = any_phi ? ScanGeometry::hemispherical : ScanGeometry::incidence_plane;
}

std::vector<std::string> listed_channels(const CsvReader& csv) {
  for (const MetadataEntry& entry : csv.metadata()) {
    if (lower_case(entry.key) != scan_key::channels) continue;
    try {
      return parse_channel_names(entry.value);
    } catch (const MetadataFault& fault) {
      throw input_error(csv.source(), entry.line, "", entry.key + ": " + fault.what());
    }
  }
  return {};
}

void add_channel(const CsvReader& csv, ScanColumns& columns, std::size_t column) {
  const std::string& name = csv.names()[column];
  ScanChannel channel;
  channel.name = name;
  if (is_rgb(name)) channel.name = std::string(1, static_cast<char>(name.front() & ~0x20));  // upper case
  channel.wavelength_um = wavelength_of_name_um(name);
  if (channel.wavelength_um) {
    channel.name = lower_case(name);
    std::erase_if(channel.name, [](char c) { return c == ' ' || c == '\t'; });
    try {
      check_wavelength_um(*channel.wavelength_um);
    } catch (const MetadataFault& fault) {
      throw header_error(csv, name, fault.what());
    }
  }
  columns.columns[column] = {ColumnRole::value, columns.channels.size()};
  columns.channels.push_back(std::move(channel));
}

// Returns the channels by column_key.
ColumnIndex find_channels(const CsvReader& csv, ScanColumns& columns) {
  const std::vector<std::string> listed = listed_channels(csv);
  ColumnIndex listed_keys;
  for (const std::string& name : listed) listed_keys.emplace(column_key(name), 0);
  ColumnIndex channels;
  for (std::size_t c = 0; c < csv.names().size(); ++c) {
    const std::string& name = csv.names()[c];
    if (columns.columns[c].role != ColumnRole::ignored) continue;
    const std::string key = column_key(name);
    if (!is_standard_channel(name) && !listed_keys.contains(key)) continue;
    channels.emplace(key, columns.channels.size());
    add_channel(csv, columns, c);
  }
  for (const std::string& name : listed) {
    if (channels.contains(column_key(name))) continue;
    throw header_error(csv, name,
                       "is listed by '# channels:' and is no channel column; expected it in the header line");
  }
  if (columns.channels.empty()) {
    throw header_error(csv, "",
                       "there is no channel column; expected R, G, B, a wavelength such as 550nm, or names listed by "
                       "'# channels: a, b'");
  }
  return channels;
}

// What remains is an uncertainty, or unknown.
void find_others(const CsvReader& csv, const ScanReadOptions& options, const ColumnIndex& channels,
                 ScanColumns& columns) {
  for (std::size_t c = 0; c < csv.names().size(); ++c) {
    if (columns.columns[c].role != ColumnRole::ignored) continue;
    const std::string& name = csv.names()[c];
    const bool uncertainty = lower_case(name).starts_with(uncertainty_prefix);
    const std::string of = uncertainty ? name.substr(uncertainty_prefix.size()) : std::string{};
    const auto channel = channels.find(column_key(of));
    if (uncertainty && channel != channels.end()) {
      columns.columns[c] = {ColumnRole::uncertainty, channel->second};
    } else if (!options.ignore_unknown_columns) {
      throw header_error(csv, name,
                         uncertainty
                             ? "is an uncertainty without its channel; expected a column " + shown(of)
                             : "is unknown; expected angles, R, G, B, a wavelength such as 550nm, u_CHANNEL, or "
                               "names listed by '# channels: a, b' (--ignore-columns leaves others out)");
    }
  }
}

template <class T, class Apply>
void apply_list(const EntryList<T>& list, std::vector<ScanChannel>& channels, Apply&& apply) {
  if (list.size() != 1 && list.size() != channels.size()) {
    throw MetadataFault(std::to_string(list.size()) + " values for " + std::to_string(channels.size()) +
                        (channels.size() == 1 ? " channel" : " channels") + "; expected one, or one a channel");
  }
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const std::optional<T>& value = list.size() == 1 ? list.front() : list[c];
    if (value) apply(channels[c], *value);
  }
}

void set_wavelength(ScanChannel& channel, double wavelength_um) {
  constexpr double tolerance = 1e-6;
  if (channel.wavelength_um && std::fabs(*channel.wavelength_um - wavelength_um) > tolerance * wavelength_um) {
    throw MetadataFault("the value for channel " + shown(channel.name) +
                        " contradicts its name; expected the same wavelength");
  }
  if (!channel.wavelength_um) channel.wavelength_um = wavelength_um;
}

void set_index(ScanChannel& channel, const RefractiveIndex& index) {
  channel.n = index.n;
  channel.kappa = index.kappa;
}

void apply_entry(std::string_view key, const std::string& value, Scan& scan) {
  if (key == scan_key::version && value != "1") {
    throw MetadataFault(in_quotes(value) + " is a version this program does not know; expected 1");
  }
  if (key == scan_key::name && !value.empty()) scan.name = value;
  if (key == scan_key::solid_angle_sr) scan.solid_angle_sr = parse_solid_angle_sr(value);
  if (key == scan_key::scale_u) scan.scale_u = parse_scale_u(value);
  if (key == scan_key::wavelength_um) apply_list(parse_wavelength_um(value), scan.channels, set_wavelength);
  if (key == scan_key::refractive_index) apply_list(parse_refractive_index(value), scan.channels, set_index);
}

std::string_view expectation(ColumnRole role, ScanGeometry geometry) noexcept {
  switch (role) {
    case ColumnRole::phi_i:
    case ColumnRole::phi_r:
      return "an angle in degrees";
    case ColumnRole::value:
      return "a BRDF value in 1/sr";
    case ColumnRole::uncertainty:
      return "a standard uncertainty above 0 in 1/sr";
    case ColumnRole::theta_r:
      if (geometry == ScanGeometry::incidence_plane) return "a signed angle from -90 to 90 degrees";
      break;
    case ColumnRole::theta_i:
    case ColumnRole::ignored:
      break;
  }
  return "an angle from 0 to 90 degrees";
}

bool in_range(ColumnRole role, ScanGeometry geometry, double value) noexcept {
  const bool is_signed = role == ColumnRole::theta_r && geometry == ScanGeometry::incidence_plane;
  switch (role) {
    case ColumnRole::theta_i:
    case ColumnRole::theta_r:
      return (is_signed ? std::fabs(value) : value) <= 90.0 && (is_signed || value >= 0.0);
    // A reading without any uncertainty would weigh infinitely much under the inverse-variance loss.
    case ColumnRole::uncertainty:
      return value > 0.0;
    default:
      return true;
  }
}

}  // namespace

ScanColumns find_angle_columns(const CsvReader& csv) {
  check_named_once(csv, true);
  ScanColumns columns;
  columns.columns.resize(csv.names().size());
  for (std::size_t c = 0; c < csv.names().size(); ++c) {
    columns.columns[c].role = angle_role(lower_case(csv.names()[c]));
  }
  check_geometry(csv, columns);
  return columns;
}

ScanColumns find_scan_columns(const CsvReader& csv, const ScanReadOptions& options) {
  check_named_once(csv, false);
  ScanColumns columns = find_angle_columns(csv);
  const ColumnIndex channels = find_channels(csv, columns);
  find_others(csv, options, channels, columns);
  return columns;
}

void apply_metadata(const CsvReader& csv, Scan& scan) {
  scan.name = std::filesystem::path(csv.source()).stem().string();
  std::vector<std::string> seen;
  for (const MetadataEntry& entry : csv.metadata()) {
    const std::string key = lower_case(entry.key);
    scan.metadata.emplace_back(entry.key, entry.value);
    if (!is_scan_key(key)) continue;
    try {
      if (std::find(seen.begin(), seen.end(), key) != seen.end())
        throw MetadataFault("is given twice; expected it once");
      apply_entry(key, entry.value, scan);
    } catch (const MetadataFault& fault) {
      throw input_error(csv.source(), entry.line, "", shown(entry.key) + ": " + fault.what());
    }
    seen.push_back(key);
  }
}

double read_number(const CsvReader& csv, std::size_t column, ColumnRole role, ScanGeometry geometry) {
  const std::string_view expected = expectation(role, geometry);
  const double value = csv.number(column, expected);
  if (in_range(role, geometry, value)) return value;
  std::string what = in_quotes(csv.field(column)) + " is out of range; expected " + std::string(expected);
  if (role == ColumnRole::theta_r && value < 0.0 && geometry == ScanGeometry::hemispherical) {
    what += " (a signed theta_r goes with a scan without phi columns)";
  }
  throw csv.row_error(column, what);
}

AnglePair angles_of(ScanGeometry geometry, const AnglePair& as_written) noexcept {
  return geometry == ScanGeometry::hemispherical ? as_written
                                                 : in_plane(as_written.theta_i_deg, as_written.theta_r_deg);
}

}  // namespace goniofit
