#pragma once
// Where a fit misses its scan, drawn by gnuplot.

#include <filesystem>

#include "../fit/fit.h"
#include "../scan/scan.h"

namespace goniofit {

/// For each incidence angle a map of the hemisphere, of the channel that the fit misses by most, in Lambert's
/// equal-area projection with the forward direction to the right; of a scan near the plane of incidence curves against
/// theta_r. In units of u where the scan states it, else relative to the larger of measured and fitted, so that neither
/// a peak that the model lacks nor one that it invents is beyond 100 %. Colours from blue (measured below fitted)
/// through white to orange, and a dot in every mark that is below: the sign needs no colour. SVG or PNG by the
/// extension of `path`. Throws Error: system where gnuplot is missing or fails, bad_input for another extension.
void plot_residuals(const std::filesystem::path& path, const Scan& scan, const FitResult& result);

}  // namespace goniofit
