#pragma once
// Profile likelihoods as small multiples, drawn by gnuplot.

#include <filesystem>

#include "../fit/fit.h"
#include "../scan/scan.h"

namespace goniofit {

/// One panel a parameter: the root of Δ against its value, the straight lines that value ± k u would give beside it,
/// the levels of 68 and 95 % and the limits. Shared parameters come first; of more than twelve parameters those of
/// channels whose profiles are least like a parabola are shown, and the page says so. SVG or PNG by the extension of
/// `path`. Throws Error: system where gnuplot is missing or fails, bad_input for another extension or a fit without
/// profiles.
void plot_profiles(const std::filesystem::path& path, const FitResult& result, const Scan& scan);

}  // namespace goniofit
