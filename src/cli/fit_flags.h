#pragma once
// The flags of `goniofit fit` that say how to fit, and how they and a recipe become settings.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "../fit/settings.h"
#include "../scan/scan.h"

namespace goniofit::cli {

struct FitFlags {
  std::optional<std::string> components, channels;
  std::optional<std::string> n, kappa, f0, free_optics;
  std::optional<std::filesystem::path> optical_constants;
  std::vector<std::string> fixed, bounded;
  std::optional<std::string> model, terms, fresnel, shadowing, effective_roughness, distribution;
  std::optional<std::string> fs_form, rough_form, anisotropy;
  bool anisotropic = false;
  std::optional<std::string> loss, weight, robust, robust_scale;
  std::optional<std::string> exclude_retro, exclude_saturated;
  bool exclude_clamped = false;
  std::optional<std::filesystem::path> reflectances;
  std::optional<std::string> uncertainty, scale_u;
  std::optional<std::string> max_theta, solid_angle;
};

/// --model alone: `compare` has a list in its place.
void add_model_flag(CLI::App& command, FitFlags& flags);
void add_fit_flags(CLI::App& command, FitFlags& flags);

/// The channels to fit: the flag's, else the recipe's; empty is all.
[[nodiscard]] std::vector<std::string> channels_of(const FitFlags& flags, const Recipe& recipe);

/// The recipe's settings with the flags put over them. `scan` is the one to be fitted, its channels selected: optical
/// constants are interpolated at their wavelengths. Throws Error (bad_input) naming the flag.
[[nodiscard]] FitSettings settings_of(const FitFlags& flags, const Recipe& recipe, const Scan& scan);

/// The file of reflectances in force.
[[nodiscard]] std::optional<std::filesystem::path> reflectances_of(const FitFlags& flags, const Recipe& recipe);

/// The file of optical constants in force; nullopt where another source of n and kappa is.
[[nodiscard]] std::optional<std::filesystem::path> optical_constants_of(const FitFlags& flags, const Recipe& recipe);

}  // namespace goniofit::cli
