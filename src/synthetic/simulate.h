#pragma once
// The virtual gonioreflectometer.

#include <cstdint>
#include <vector>

#include "../brdf/material.h"
#include "../fit/settings.h"
#include "../scan/scan.h"

namespace goniofit {

/// The azimuths of incidence that tell a material: 0, or 0, 45 and 90 degrees for one that is anisotropic.
[[nodiscard]] std::vector<double> incidence_azimuths(const Material& material);

/// A scan of `material` with Gaussian noise of standard deviation sqrt((relative f)² + additive²). The same seed gives
/// the same scan: each reading has its own stream, so the values do not depend on threads or on which channels there
/// are. The hemisphere sampling has the mirror directions where the material has coh, the distribution of He et al. or
/// Schlick's mirror part. Each azimuth of `phi_i_deg` turns
/// the whole sampling; empty takes incidence_azimuths(). The metadata say how the scan was made. `with_uncertainty`
/// adds the u columns. Throws Error (bad_input) for a negative noise, an invalid material, an azimuth that is not
/// finite or is given twice, or an uncertainty asked of a reading whose noise is 0.
[[nodiscard]] Scan simulate(const Material& material, Sampling sampling, const Noise& noise, std::uint64_t seed,
                            bool with_uncertainty = false, const std::vector<double>& phi_i_deg = {});

}  // namespace goniofit
