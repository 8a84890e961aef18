#pragma once
// What can be said of a material beside a scan without fitting it again.

#include "../fit/fit.h"
#include "../scan/scan.h"

namespace goniofit {

/// The result of the fit that made `material`, as far as its own words and `scan` tell: parameters, uncertainties and
/// 95 % intervals from its "fit" section, misfit measured anew on all readings below 90 degrees. Correlations, profiles
/// and the choice of the effects are not known. `loss`, `rms` and `samples` are of these readings, whatever was made
/// least. Material and scan have the same channels in the same order. Throws Error (bad_input) where not.
[[nodiscard]] FitResult result_of_material(const Material& material, const Scan& scan);

}  // namespace goniofit
