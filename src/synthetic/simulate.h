#pragma once
// The virtual gonioreflectometer.

#include <cstdint>

#include "../brdf/material.h"
#include "../fit/settings.h"
#include "../scan/scan.h"

namespace goniofit {

/// A scan of `material` with Gaussian noise of standard deviation sqrt((relative f)² + additive²). The same seed gives
/// the same scan: each reading has its own stream, so the values do not depend on threads or on which channels there
/// are. The hemisphere sampling has the mirror directions where the material has coh. The metadata say how the scan was
/// made. `with_uncertainty` adds the u columns. Throws Error (bad_input) for a negative noise, an invalid material, or
/// an uncertainty asked of a reading whose noise is 0.
[[nodiscard]] Scan simulate(const Material& material, Sampling sampling, const Noise& noise, std::uint64_t seed,
                            bool with_uncertainty = false);

}  // namespace goniofit
