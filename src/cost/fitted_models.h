#pragma once
// Peers that stand for a material: fitted to its values, so that their error is the least they can do.

#include <cstdint>
#include <string>

#include "../brdf/material.h"
#include "../fit/settings.h"
#include "../scan/scan.h"
#include "candidate.h"

namespace goniofit {

/// The reference's values without coh as a scan without noise: half of the directions uniform, half in the lobe, as
/// where errors are measured, but others. coh is left out: no peer has its width.
[[nodiscard]] Scan reference_scan(const Material& reference, std::uint64_t seed);

/// The peer of that name of least l1 error among its fits to the scan by several losses; which one `note` says. Its
/// Fresnel term is `fresnel`, schlick where the reference's is.
[[nodiscard]] Candidate fitted_peer(const std::string& model, const Scan& scan, const Material& reference,
                                    FresnelTier fresnel);

}  // namespace goniofit
