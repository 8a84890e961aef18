#pragma once
// What a scan determines of a fit's parameters, as a block of the report and as JSON. Private to the fit report.

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "../fit/fit.h"

namespace goniofit {

/// Lines without a heading; empty for a model without free parameters.
[[nodiscard]] std::string identifiability_block(const FitResult& result, bool color);
[[nodiscard]] nlohmann::ordered_json identifiability_json(const Identifiability& identifiability);
/// Null where there is none.
[[nodiscard]] nlohmann::ordered_json design_json(const std::optional<MeasurementDesign>& design);

}  // namespace goniofit
