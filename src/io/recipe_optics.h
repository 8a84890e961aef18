#pragma once
// Optical constants that a recipe or a flag names by a file, put into the settings of one scan's fit.

#include <filesystem>

#include "../fit/settings.h"
#include "../scan/scan.h"

namespace goniofit {

/// Replaces n, kappa and f0 of `settings` by the table's values at the wavelengths of the scan's channels. Throws Error
/// (bad_input) where a channel has no wavelength or the table does not reach it.
void use_optical_constants(const std::filesystem::path& path, const Scan& scan, FitSettings& settings);

}  // namespace goniofit
