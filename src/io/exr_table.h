#pragma once
// The fitted BRDF tabulated in OpenEXR: one part an incidence angle, each a hemisphere of reflected directions in the
// Shirley-Chiu concentric square (32-bit float), one image channel a material channel, the parameters as attributes.

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "../brdf/material.h"
#include "../geometry/pair.h"

namespace goniofit {

struct ExrTableOptions {
  std::size_t size = 128;           ///< cells along each side of the square, 2 to 4096
  double incidence_step_deg = 5.0;  ///< incidence angles 0, step, ... up to 85
};

/// More values than this (1 GiB of them) are neither made nor read.
inline constexpr std::size_t most_table_values = std::size_t{1} << 28U;
inline constexpr std::size_t largest_table_size = 4096;

/// The table in memory. values[incidence][channel][row * size + column] in 1/sr, at cell centres, phi_i = 0; column
/// goes with u and row with v of square_to_hemisphere. A value beyond the largest float stands as that.
struct BrdfTable {
  std::string name;
  std::vector<std::string> channels;
  std::size_t size = 0;
  std::vector<double> theta_i_deg;
  std::vector<std::vector<std::vector<float>>> values;
  /// Differences of value() from the material itself at 20000 random directions (theta_i 0-80, uniform over the
  /// hemisphere to 80), all channels: root mean square of the difference over max(f, 0.001/sr), and the largest
  /// difference over the largest value of its channel at the incidences on either side (to 80 too).
  double interpolation_rms = 0.0, interpolation_max = 0.0;

  /// Bilinear in the square, linear in theta_i. theta_i beyond the last incidence uses the last; beyond the outermost
  /// cell centres the border's values go on. 0 at theta of 90 and more.
  [[nodiscard]] double value(const AnglePair& angles, std::size_t channel) const;
};

/// coh is left out (its cone is narrower than a cell; sigma and tau are in the attributes), which the file says. Throws
/// Error (bad_input) for an invalid material, one of coh alone, one that is anisotropic (the table has one phi_i), or
/// options out of range.
[[nodiscard]] BrdfTable tabulate(const Material& material, const ExrTableOptions& options = {});

/// Every part has the attributes theta_i_deg (double), goniofit.format and .version, .material (the material as JSON),
/// .name, .model, .components, the shared parameters that the material has by their names (.slope, .tail, .alpha ...),
/// .channels (in the material's order: OpenEXR sorts them), the coefficients by theirs (.k_dd ..., a number a channel,
/// NaN where it is not known), .interpolation_rms and _max, and in words .mapping and .left_out.
void write_exr(const std::filesystem::path& path, const Material& material, const BrdfTable& table);
/// Throws Error (bad_input) when there is no such file or it is not such a table.
[[nodiscard]] BrdfTable read_exr(const std::filesystem::path& path);

}  // namespace goniofit
