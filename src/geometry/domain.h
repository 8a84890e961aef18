#pragma once
// What of the hemisphere and the spectrum matters to whoever asks: a plan, a scan, a scene.

#include <optional>
#include <vector>

namespace goniofit {

/// Angles in degrees, the zenith angles of light and viewer; azimuths are free. Wavelengths in µm.
struct Domain {
  double theta_i_min_deg = 0.0, theta_i_max_deg = 80.0;
  double theta_r_max_deg = 90.0;
  std::vector<double> wavelengths_um{};    ///< empty: those of the material's channels
  std::optional<double> solid_angle_sr{};  ///< of the source, for coh; else the material's
  friend bool operator==(const Domain&, const Domain&) = default;
};

/// Throws Error (bad_input) unless 0 <= theta_i_min <= theta_i_max < 90, 0 < theta_r_max <= 90 and the rest is above 0.
void validate(const Domain& domain);

}  // namespace goniofit
