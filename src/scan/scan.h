#pragma once
// A scan: readings of a gonioreflectometer, as read and checked at the edge. Plain values, no file formats.

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../geometry/pair.h"

namespace goniofit {

/// What the header line of the file said; decides how the scan is written back and drawn.
enum class ScanGeometry {
  hemispherical,   ///< theta_i, phi_i, theta_r, phi_r
  incidence_plane  ///< theta_i, signed theta_r
};

struct ScanChannel {
  std::string name;                     ///< "R", "550nm"
  std::optional<double> wavelength_um;  ///< from the name (550nm) or the metadata
  std::optional<double> n, kappa;       ///< from the metadata (refractive_index)
  std::vector<double> values;           ///< BRDF in 1/sr, one a reading; negative values (noise) are kept
  std::vector<double> u;                ///< standard uncertainty of the values in 1/sr; empty where the scan has none
};

struct Scan {
  std::string source;  ///< the file it came from, for messages
  std::string name;    ///< metadata `name`, else the file's stem
  ScanGeometry geometry = ScanGeometry::hemispherical;
  /// Degrees. theta in [0, 90]; an incidence-plane scan is stored with phi_i = 0 and phi_r = 180 (forward) or 0
  /// (retro).
  std::vector<double> theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg;
  std::vector<ScanChannel> channels;
  std::optional<double> solid_angle_sr;
  std::optional<double> scale_u{};  ///< relative standard uncertainty of the instrument's scale, common to all readings
  std::vector<std::pair<std::string, std::string>> metadata;  ///< every `# key: value`, in file order

  [[nodiscard]] std::size_t size() const noexcept { return theta_i_deg.size(); }
  [[nodiscard]] AnglePair angles(std::size_t row) const noexcept {
    return {theta_i_deg[row], phi_i_deg[row], theta_r_deg[row], phi_r_deg[row]};
  }
  /// +1 in the plane of incidence on the forward side, -1 on the retro side, 0 out of the plane (by more than
  /// `tolerance_deg` of azimuth; theta_i = 0 or theta_r = 0 are always in the plane: +1 there).
  [[nodiscard]] int plane_side(std::size_t row, double tolerance_deg = 0.5) const noexcept;
  /// theta_r with the sign of plane_side.
  [[nodiscard]] double signed_theta_r_deg(std::size_t row) const noexcept;
};

/// The scan reduced to the named channels, in that order. A name matches without regard to case, and "450" or "450nm"
/// alike; no names at all is every channel. Throws Error (bad_input) naming the channels there are, or one asked for
/// twice.
[[nodiscard]] Scan select_channels(const Scan& scan, const std::vector<std::string>& names);

/// The readings of several scans of the same channels in one, under the first one's name and metadata; hemispherical
/// unless all are incidence-plane scans. Throws Error (bad_input) when the channels differ, when only some have
/// uncertainties, or when two state different wavelengths, refractive indices or solid angles.
[[nodiscard]] Scan concatenate(const std::vector<Scan>& scans);

}  // namespace goniofit
