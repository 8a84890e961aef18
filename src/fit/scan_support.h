#pragma once
// What of the effects a scan's geometry can show, in words.

#include <string>
#include <vector>

#include "fit_evidence.h"
#include "problem.h"

namespace goniofit {

/// Channels that absorb so strongly (kappa of 0.1 and more: within a wavelength) that no light comes back from below
/// the surface, in a model that has uds or fs.
[[nodiscard]] std::vector<std::size_t> opaque_channels(const Problem& problem);
/// Coefficients of light from below the surface, by index.
[[nodiscard]] std::vector<std::size_t> subsurface_coefficients(const Problem& problem);

/// "no forward reading has theta_i and theta_r both above 45°, and a single reading shows k_fs = 1 above the noise only
/// from about 70° on"; the best lit channel speaks. Empty where the scan has what fs needs.
[[nodiscard]] std::string missing_for_fs(const Problem& problem, const FitPoint& point, const NoiseModel& noise);
/// What the scan lacks to tell udf from uds; empty where it reaches grazing.
[[nodiscard]] std::string missing_for_uds(const Problem& problem);

}  // namespace goniofit
