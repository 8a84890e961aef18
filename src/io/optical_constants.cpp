#include "io/optical_constants.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <string_view>

#include "io/csv_reader.h"
#include "io/line_reader.h"
#include "io/number.h"
#include "io/refractive_index_yaml.h"
#include "support/error.h"
#include "support/text.h"

namespace goniofit {

namespace {

constexpr std::size_t largest_file = std::size_t{16} << 20;

// The database's files have a block DATA at the outermost level; no table has such a line.
bool is_yaml(std::string_view text) {
  return text.starts_with("DATA:") || text.find("\nDATA:") != std::string_view::npos;
}

struct Columns {
  std::size_t wavelength, n;
  std::optional<std::size_t> kappa;
};

Columns find_columns(const CsvReader& csv) {
  std::optional<std::size_t> wavelength, n, kappa;
  for (std::size_t c = 0; c < csv.names().size(); ++c) {
    const std::string name = lower_case(csv.names()[c]);
    std::optional<std::size_t>* role = name == "wavelength_um"          ? &wavelength
                                       : name == "n"                    ? &n
                                       : name == "kappa" || name == "k" ? &kappa
                                                                        : nullptr;
    if (role == nullptr || *role) {
      throw input_error(
          csv.source(), csv.header_line(), shown(csv.names()[c]),
          std::string(role == nullptr ? "is unknown" : "is there twice") + "; expected wavelength_um, n, kappa");
    }
    *role = c;
  }
  if (!wavelength || !n) {
    throw input_error(csv.source(), csv.header_line(), wavelength ? "n" : "wavelength_um",
                      "is missing; expected wavelength_um, n, kappa");
  }
  return {*wavelength, *n, kappa};
}

double read_number(const CsvReader& csv, std::size_t column, bool zero_allowed, std::string_view expected) {
  const double value = csv.number(column, expected);
  if (value > 0.0 || (zero_allowed && value == 0.0)) return value;
  throw csv.row_error(column, in_quotes(csv.field(column)) + " is out of range; expected " + std::string(expected));
}

OpticalConstants read_csv(const std::string& text, const std::string& source) {
  std::istringstream in(text);
  CsvReader csv(in, source, "names such as wavelength_um,n,kappa, or a refractiveindex.info file with a DATA block");
  const Columns columns = find_columns(csv);
  OpticalConstants table;
  while (csv.next_row()) {
    table.wavelength_um.push_back(read_number(csv, columns.wavelength, false, "a wavelength above 0 in micrometres"));
    table.n.push_back(read_number(csv, columns.n, false, "n above 0"));
    table.kappa.push_back(columns.kappa ? read_number(csv, *columns.kappa, true, "kappa from 0 up") : 0.0);
    const std::size_t rows = table.wavelength_um.size();
    if (rows > 1 && table.wavelength_um[rows - 1] <= table.wavelength_um[rows - 2]) {
      throw csv.row_error(columns.wavelength,
                          in_quotes(csv.field(columns.wavelength)) +
                              " is not above the wavelength before it; expected ascending wavelengths");
    }
  }
  if (table.wavelength_um.empty())
    throw input_error(source, csv.header_line(), "",
                      "there is no row after the header line; expected one a wavelength");
  return table;
}

}  // namespace

OpticalConstants::Index OpticalConstants::at(double wavelength) const {
  if (!(wavelength >= wavelength_um.front() && wavelength <= wavelength_um.back())) {
    throw input_error(source, 0, "",
                      "has no value at " + shortest(wavelength) + " micrometres; expected " +
                          shortest(wavelength_um.front()) + " to " + shortest(wavelength_um.back()));
  }
  const auto upper = std::lower_bound(wavelength_um.begin(), wavelength_um.end(), wavelength);
  const auto i = static_cast<std::size_t>(upper - wavelength_um.begin());
  if (*upper == wavelength) return {n[i], kappa[i]};
  const double t = (wavelength - wavelength_um[i - 1]) / (wavelength_um[i] - wavelength_um[i - 1]);
  return {std::lerp(n[i - 1], n[i], t), std::lerp(kappa[i - 1], kappa[i], t)};
}

OpticalConstants read_optical_constants(std::istream& in, const std::string& source) {
  const std::string text = read_whole(in, source, largest_file);
  OpticalConstants table = is_yaml(text) ? parse_refractive_index_yaml(text, source) : read_csv(text, source);
  table.source = source;
  return table;
}

OpticalConstants read_optical_constants(const std::filesystem::path& path) {
  std::ifstream in = open_input(path);
  return read_optical_constants(in, path.string());
}

}  // namespace goniofit
