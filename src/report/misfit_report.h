#pragma once
// What a fit's diagnostics say, as a block of the report and as JSON. Private to the fit report.

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "../fit/diagnostics.h"
#include "../scan/scan.h"

namespace goniofit {

/// Lines without a heading: the verdict, its reason and the other findings, the worst outliers.
[[nodiscard]] std::string misfit_block(const FitDiagnostics& diagnostics, const Scan& scan, bool color);
[[nodiscard]] nlohmann::ordered_json misfit_json(const FitDiagnostics& diagnostics, const Scan& scan);

}  // namespace goniofit
