#pragma once
// The verdict on a fit and its words, by the rule that diagnostics.h states. Private to diagnose().

#include "diagnostics.h"

namespace goniofit {

/// Measures and their limit of one half: see diagnostics.h.
inline constexpr double gross_misfit = 0.5;
/// Below it a misfit is of no account: no gonioreflectometer is as good.
inline constexpr double negligible_misfit = 1e-3;
/// Above it residuals that nothing can tell from noise are taken as misfit.
inline constexpr double untested_misfit = 0.05;
/// Probability below which residuals are no noise.
inline constexpr double refuting_p = 1e-3;

/// Fills verdict and findings from everything else.
void judge(const Scan& scan, const Material& material, FitDiagnostics& d);

}  // namespace goniofit
