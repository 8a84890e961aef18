#pragma once
// The metadata keys of a scan that mean something, and how their values are spelled.

#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "../scan/scan.h"

namespace goniofit {

/// Keys, in lower case.
namespace scan_key {
inline constexpr std::string_view version = "goniofit-scan";  ///< 1
inline constexpr std::string_view name = "name";
inline constexpr std::string_view refractive_index = "refractive_index";  ///< 1.7 or 0.958+6.69i
inline constexpr std::string_view wavelength_um = "wavelength_um";
inline constexpr std::string_view solid_angle_sr = "solid_angle_sr";
inline constexpr std::string_view scale_u = "scale_u";    ///< 0.01: of 1 % common to all readings
inline constexpr std::string_view channels = "channels";  ///< columns that are channels by this line only
}  // namespace scan_key
[[nodiscard]] bool is_scan_key(std::string_view lower_key) noexcept;

/// What stands for a channel whose value is not known, in a list of one value a channel.
inline constexpr std::string_view unknown_entry = "none";

struct RefractiveIndex {
  double n, kappa;
  friend bool operator==(const RefractiveIndex&, const RefractiveIndex&) = default;
};
template <class T>
using EntryList = std::vector<std::optional<T>>;

/// What is wrong with a value and what was expected, without the file and the line.
class MetadataFault : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Comma-separated values. All throw MetadataFault.
[[nodiscard]] EntryList<RefractiveIndex> parse_refractive_index(std::string_view text);
[[nodiscard]] EntryList<double> parse_wavelength_um(std::string_view text);
[[nodiscard]] double parse_solid_angle_sr(std::string_view text);
[[nodiscard]] double parse_scale_u(std::string_view text);
[[nodiscard]] std::vector<std::string> parse_channel_names(std::string_view text);

/// Throws MetadataFault outside 0.01 to 100 µm, which is how nanometres taken for micrometres are found.
void check_wavelength_um(double wavelength_um);

/// R, G, B in any case.
[[nodiscard]] bool is_rgb(std::string_view name) noexcept;
/// The wavelength that a column name such as "550nm" states; nullopt for other names.
[[nodiscard]] std::optional<double> wavelength_of_name_um(std::string_view name) noexcept;
/// A column of this name is a channel without being listed in `# channels:`.
[[nodiscard]] bool is_standard_channel(std::string_view name) noexcept;

}  // namespace goniofit
