#pragma once
// What each column of a scan or a table of directions is, decided once from the header line.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "../geometry/pair.h"
#include "csv_reader.h"
#include "scan_reader.h"

namespace goniofit {

enum class ColumnRole : std::uint8_t { ignored, theta_i, phi_i, theta_r, phi_r, value, uncertainty };

struct ScanColumn {
  ColumnRole role = ColumnRole::ignored;
  std::size_t channel = 0;  ///< of a value or an uncertainty
};

struct ScanColumns {
  ScanGeometry geometry = ScanGeometry::hemispherical;
  std::vector<ScanColumn> columns;    ///< one a column of the file
  std::vector<ScanChannel> channels;  ///< without readings, in the order of their columns
};

/// Angle columns only, every other column ignored: both phi columns make a hemispherical table, neither one of the
/// plane of incidence. Throws Error (bad_input) where an angle is missing or named twice.
[[nodiscard]] ScanColumns find_angle_columns(const CsvReader& csv);

/// Angles, channels, uncertainties. Channels are R, G, B, <number>nm, and the columns listed by `# channels: a, b`.
/// Throws Error (bad_input) as documented at read_scan.
[[nodiscard]] ScanColumns find_scan_columns(const CsvReader& csv, const ScanReadOptions& options);

/// Puts refractive_index, wavelength_um, solid_angle_sr and name where they belong and keeps every entry. Throws Error.
void apply_metadata(const CsvReader& csv, Scan& scan);

/// One checked number of the current row. Throws Error naming the column and what was expected.
[[nodiscard]] double read_number(const CsvReader& csv, std::size_t column, ColumnRole role, ScanGeometry geometry);

/// The angles of the current row from the file's own columns.
[[nodiscard]] AnglePair angles_of(ScanGeometry geometry, const AnglePair& as_written) noexcept;

}  // namespace goniofit
