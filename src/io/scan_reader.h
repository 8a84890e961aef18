#pragma once
// The scan CSV: comment lines `# key: value`, a header line, readings. Streams; every value is checked while reading.
//
// Columns, in any order and any case, separated by , ; tab or blanks as the header line is (the first of ; , tab that
// occurs in it, else blanks); fields may stand in double quotes:
//   theta_i, phi_i, theta_r, phi_r  degrees, theta in [0, 90]: a hemispherical scan
//   theta_i, theta_r                degrees, theta_r in [-90, 90]: an incidence-plane scan, positive = forward side
//   R, G, B, <number>nm             channels, BRDF in 1/sr; 550nm and 550.0nm are the same name
//   any name listed by `# channels: a, b`   a channel too
//   u_<channel>                     standard uncertainty of that channel, if it has one: finite and above 0; 0 is an
//                                   error, since a reading without uncertainty would weigh infinitely much
// Metadata that means something (any other key is kept; comment lines below the header line are remarks): `name`;
// `channels`; `solid_angle_sr` in (0, 2 pi]; `refractive_index` (1.7 or 0.958+6.69i, kappa >= 0) and `wavelength_um`
// (0.01 to 100), one value or one a channel in the order of the columns, `none` where it is not known; `goniofit-scan`,
// the version, 1. A wavelength that contradicts the channel's name is an error.
//
// An Error for: NaN, infinity, theta out of range, text that is no number, empty fields, short rows, long rows, names
// given twice, a missing angle, one phi without the other, no channel, no reading, an unknown column, an uncertainty
// without its channel, UTF-16, a line above 1 MiB.

#include <cstddef>
#include <filesystem>
#include <istream>
#include <string>
#include <vector>

#include "../scan/scan.h"

namespace goniofit {

struct ScanReadOptions {
  bool ignore_unknown_columns = false;  ///< else a column that is neither angle, channel nor u_channel is an error
};

/// Reads `path` ("-" is not special). Throws Error (bad_input) as "FILE:LINE: column NAME: what is wrong, what was
/// expected", also where the file cannot be opened, and Error (system) where reading breaks off. Locale-independent.
/// Peak memory stays within 1.5 times that of the numbers, and a buffer of 1 MiB.
[[nodiscard]] Scan read_scan(const std::filesystem::path& path, const ScanReadOptions& options = {});
/// The same from a stream; `source` names it in messages.
[[nodiscard]] Scan read_scan(std::istream& in, const std::string& source, const ScanReadOptions& options = {});

/// DIRECTIONS.csv of `goniofit eval`: the angle columns of a scan, any further columns kept as text.
struct DirectionTable {
  std::string header;              ///< the header line as it stood, without separators after the last name
  char separator = ',';            ///< ' ' for any run of blanks
  std::vector<std::string> lines;  ///< the data lines as they stood, one a row, each with one field a name
  std::vector<AnglePair> angles;   ///< one a row
};
[[nodiscard]] DirectionTable read_directions(const std::filesystem::path& path);
[[nodiscard]] DirectionTable read_directions(std::istream& in, const std::string& source);

/// Writes a scan that read_scan gives back: the metadata, the geometry's columns, values with `digits` significant
/// digits (17 are exact, metadata always are). Lines of `metadata` that contradict the members of the scan are written
/// anew, those that are missing are added. Throws Error (bad_input) for what the format cannot hold: a reading out of
/// the plane in an incidence-plane scan, a channel name with separators or quotes in it or one that means something
/// else (theta_i, u_R).
void write_scan(std::ostream& out, const Scan& scan, int digits = 9);

}  // namespace goniofit
