#include "io/scan_reader.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string_view>

#include "io/csv_reader.h"
#include "io/line_reader.h"
#include "io/scan_columns.h"
#include "support/error.h"

namespace goniofit {

namespace {

constexpr std::string_view scan_names = "names such as theta_i,phi_i,theta_r,phi_r,R,G,B or theta_i,theta_r,R,G,B";
constexpr std::string_view direction_names = "theta_i,phi_i,theta_r,phi_r or theta_i,theta_r among the names";

std::vector<std::vector<double>*> stored_columns(Scan& scan, const std::vector<ScanColumn>& columns) {
  std::vector<std::vector<double>*> stored{&scan.theta_i_deg, &scan.phi_i_deg, &scan.theta_r_deg, &scan.phi_r_deg};
  for (const auto& [role, channel] : columns) {
    if (role == ColumnRole::value) stored.push_back(&scan.channels[channel].values);
    if (role == ColumnRole::uncertainty) stored.push_back(&scan.channels[channel].u);
  }
  return stored;
}

// Room for as many rows as a file of this size should have, going by the rows so far: columns that are moved while they
// grow would take twice the memory for a while. What is reserved and not used is not resident. Without a known size,
// and where the rows get shorter, a quarter more.
class Room {
 public:
  Room(std::vector<std::vector<double>*> columns, std::optional<std::uint64_t> bytes)
      : columns_(std::move(columns)), bytes_(bytes) {}

  void make_for(std::size_t rows, const CsvReader& csv) {
    if (rows <= rows_) return;
    constexpr double margin = 1.02;
    const double so_far = bytes_ ? static_cast<double>(*bytes_) / static_cast<double>(csv.consumed()) : 0.0;
    const double expected = margin * so_far * static_cast<double>(rows);
    rows_ = rows_ == 0 ? first_rows() : std::max(rows + rows / 4, static_cast<std::size_t>(expected));
    for (std::vector<double>* column : columns_) column->reserve(rows_);
  }

  void release_spare() {
    for (std::vector<double>* column : columns_) {
      if (column->capacity() > column->size() + column->size() / 16) column->shrink_to_fit();
    }
  }

 private:
  // Enough to tell the length of a row by, and little memory however many columns there are.
  [[nodiscard]] std::size_t first_rows() const { return std::clamp<std::size_t>(65536 / columns_.size(), 4, 512); }

  std::vector<std::vector<double>*> columns_;
  std::optional<std::uint64_t> bytes_;
  std::size_t rows_ = 0;
};

void set_angle(AnglePair& angles, ColumnRole role, double value) noexcept {
  value += 0.0;  // -0 becomes 0
  if (role == ColumnRole::theta_i) angles.theta_i_deg = value;
  if (role == ColumnRole::phi_i) angles.phi_i_deg = value;
  if (role == ColumnRole::theta_r) angles.theta_r_deg = value;
  if (role == ColumnRole::phi_r) angles.phi_r_deg = value;
}

void read_row(const CsvReader& csv, const std::vector<ScanColumn>& columns, Scan& scan) {
  AnglePair as_written;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const auto [role, channel] = columns[c];
    if (role == ColumnRole::ignored) continue;
    const double value = read_number(csv, c, role, scan.geometry);
    if (role == ColumnRole::value) {
      scan.channels[channel].values.push_back(value);
    } else if (role == ColumnRole::uncertainty) {
      scan.channels[channel].u.push_back(value);
    } else {
      set_angle(as_written, role, value);
    }
  }
  const AnglePair angles = angles_of(scan.geometry, as_written);
  scan.theta_i_deg.push_back(angles.theta_i_deg);
  scan.phi_i_deg.push_back(angles.phi_i_deg);
  scan.theta_r_deg.push_back(angles.theta_r_deg);
  scan.phi_r_deg.push_back(angles.phi_r_deg);
}

Error no_rows(const CsvReader& csv, const std::string& what) {
  return input_error(csv.source(), csv.header_line(), "",
                     "there is no row after the header line; expected one a " + what);
}

}  // namespace

Scan read_scan(std::istream& in, const std::string& source, const ScanReadOptions& options) {
  const std::optional<std::uint64_t> bytes = remaining_bytes(in);
  CsvReader csv(in, source, scan_names);
  ScanColumns columns = find_scan_columns(csv, options);
  Scan scan;
  scan.source = source;
  scan.geometry = columns.geometry;
  scan.channels = std::move(columns.channels);
  apply_metadata(csv, scan);
  Room room(stored_columns(scan, columns.columns), bytes);
  while (csv.next_row()) {
    room.make_for(scan.size() + 1, csv);
    read_row(csv, columns.columns, scan);
  }
  if (scan.size() == 0) throw no_rows(csv, "reading");
  room.release_spare();
  return scan;
}

Scan read_scan(const std::filesystem::path& path, const ScanReadOptions& options) {
  std::ifstream in = open_input(path);
  return read_scan(in, path.string(), options);
}

DirectionTable read_directions(std::istream& in, const std::string& source) {
  CsvReader csv(in, source, direction_names);
  const ScanColumns columns = find_angle_columns(csv);
  DirectionTable table;
  table.header = csv.header_text();
  table.separator = csv.separator();
  while (csv.next_row()) {
    AnglePair as_written;
    for (std::size_t c = 0; c < columns.columns.size(); ++c) {
      const ColumnRole role = columns.columns[c].role;
      if (role != ColumnRole::ignored) set_angle(as_written, role, read_number(csv, c, role, columns.geometry));
    }
    table.angles.push_back(angles_of(columns.geometry, as_written));
    table.lines.emplace_back(csv.row_text());
  }
  if (table.angles.empty()) throw no_rows(csv, "direction");
  return table;
}

DirectionTable read_directions(const std::filesystem::path& path) {
  std::ifstream in = open_input(path);
  return read_directions(in, path.string());
}

}  // namespace goniofit
