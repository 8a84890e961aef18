#pragma once
// Names of the channels of spectral OpenEXR images (Fichet, Pacanowski & Wilkie 2021, "An OpenEXR layout for spectral
// images", JCGT 10 (3)): "S0.450,000000nm" is the radiance at 450 nm, with a decimal comma since a point parts layers.

#include <optional>
#include <string>
#include <string_view>

namespace goniofit {

[[nodiscard]] std::string spectral_channel_name(double wavelength_nm);
/// nullopt for a name that is none of these.
[[nodiscard]] std::optional<double> spectral_band_nm(std::string_view name);

}  // namespace goniofit
