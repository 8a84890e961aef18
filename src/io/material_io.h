#pragma once
// Materials as JSON, as rows of a CSV table, and optical constants read from tables.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "../brdf/material.h"

namespace goniofit {

/// Reads and validates. Throws Error (bad_input) as "FILE: /json/pointer: what is wrong, what was expected"; syntax
/// errors name line and column. Derives a slope where sigma and its tau are given without it.
[[nodiscard]] Material read_material(const std::filesystem::path& path);
[[nodiscard]] Material parse_material(std::string_view json, const std::string& source);

/// Two-space indented JSON with a final newline; numbers in the shortest form that reads back to the same double.
/// Throws Error (bad_input) for a material that read_material would reject.
[[nodiscard]] std::string to_json(const Material& material);
void write_material(const std::filesystem::path& path, const Material& material);

/// A header and one row a material and channel: name, channel, wavelength_um, n, kappa, f0, components, terms, fs_form,
/// slope, sigma_um, tau_um, k_dd ... k_fs, solid_angle_sr, loss, rms, samples, converged, model, rough_form,
/// anisotropy, slope_y, tau_y_um, tail, facet_slope_deg, rho, then the parameters and coefficients of the peers among
/// them. What can be fitted has its standard uncertainty in the next column (n,u_n ... rho,u_rho). Cells of what is not
/// known or not of the model are empty. components and terms are lists with blanks: "dd uds fs", "fresnel=schlick
/// shadowing=li-torrance
/// ...". Quoted as RFC 4180 says.
[[nodiscard]] std::string to_csv(const std::vector<Material>& materials);

}  // namespace goniofit
