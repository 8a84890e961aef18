#pragma once
// Models that stand for a material: fitted to its values, so that their error is the least they can do.

#include <cstdint>
#include <string>
#include <vector>

#include "../brdf/material.h"
#include "../fit/settings.h"
#include "../scan/scan.h"
#include "candidate.h"

namespace goniofit {

/// The reference's values without noise, in directions as those where errors are measured, but others; a reading's
/// uncertainty is the inverse of the part of the reflectance that its direction stands for. Thus inverse variance makes
/// a mean of the errors in energy least, which a kernel that is linear outside its scale turns into the l1 error. The
/// mirror directions are readings as an instrument of the material's solid angle has them, coh included; within its
/// cone there are no others.
[[nodiscard]] Scan reference_scan(const Material& reference, std::uint64_t seed);

/// Fits by l1 error as nearly as a least-squares fit can: optics, components and the rest as `settings` say. The
/// material has no fit summary.
[[nodiscard]] Material l1_fit(const Scan& scan, FitSettings settings);

/// The peers that can tell an isotropic material, or with their two widths an anisotropic one.
[[nodiscard]] std::vector<std::string> peers_for(const Material& material);

/// The peer of that name fitted to the scan of the reference. Its Fresnel term is Schlick's, as the published model's.
[[nodiscard]] EvaluationCandidate fitted_peer(const std::string& model, const Scan& scan, const Material& reference);

}  // namespace goniofit
