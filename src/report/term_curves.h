#pragma once
// The tiers of one term against an angle: what a cheaper expression looks like beside the exact one.

#include <string>
#include <string_view>
#include <vector>

namespace goniofit {

struct TermCurveSettings {
  double slope = 0.1;           ///< sigma/tau of shadowing, effective_roughness and slopes
  double n = 1.5, kappa = 0.0;  ///< of fresnel
  double p = 0.2;               ///< Schlick's isotropy of azimuth, in (0, 1]
  int steps = 90;               ///< intervals of the angle
};

struct TermCurves {
  std::vector<std::string> columns;       ///< the angle in degrees first, then a tier each
  std::vector<std::vector<double>> rows;  ///< of columns.size() numbers
};

/// fresnel: F against the angle between H and V. shadowing: S1 against the zenith angle, Smith's also as Schlick 1994
/// (18) prints it, without e^h, which is what his own expression was made for. effective_roughness: sigma_e/sigma at
/// the mirror direction. slopes: Beckmann's D and Schlick's (21) for it, the slope at most ½. azimuth: Schlick's A(w)
/// against the azimuth of H, as printed and normalised.
inline constexpr std::string_view term_curve_names = "fresnel, shadowing, effective_roughness, slopes or azimuth";

/// Throws Error (bad_input) for another name and for settings out of range.
[[nodiscard]] TermCurves term_curves(std::string_view term, const TermCurveSettings& settings);

}  // namespace goniofit
