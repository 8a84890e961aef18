#pragma once
// What a fit made least and over which readings, in the words of the report.

#include <string>

#include "../fit/fit.h"
#include "../scan/scan.h"

namespace goniofit {

/// Whether the loss is that of Li & Torrance 2005.
[[nodiscard]] bool is_published(const FitResult& result);
/// "Σ cos θᵢ (f_model − f_measured)², over samples and channels".
[[nodiscard]] std::string objective_text(const FitResult& result);
/// "3528 of 3600 used; 72 left out at θ = 90°".
[[nodiscard]] std::string samples_text(const FitResult& result, const Scan& scan);

}  // namespace goniofit
