#pragma once
// n and kappa against wavelength, from a CSV (wavelength_um,n,kappa with `# key: value` lines; no kappa is 0) or from a
// refractiveindex.info YAML file (tabulated nk, tabulated n, formulas 1 and 2, and tabulated k beside an n).

#include <filesystem>
#include <istream>
#include <string>
#include <vector>

namespace goniofit {

struct OpticalConstants {
  std::string source;
  std::vector<double> wavelength_um, n, kappa;  ///< ascending wavelength
  struct Index {
    double n, kappa;
  };
  /// Linear interpolation. Throws Error (bad_input) outside the tabulated range, naming the range.
  [[nodiscard]] Index at(double wavelength_um) const;
};

/// Throws Error (bad_input) with file, line and column.
[[nodiscard]] OpticalConstants read_optical_constants(const std::filesystem::path& path);
[[nodiscard]] OpticalConstants read_optical_constants(std::istream& in, const std::string& source);

}  // namespace goniofit
