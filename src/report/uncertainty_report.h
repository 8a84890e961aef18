#pragma once
// What the report says of uncertainties: where they come from, the instrument's part, what hangs together.

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "../fit/fit.h"

namespace goniofit {

/// The 95 % interval: "0.0851 … 0.0857", or for a parameter on a bound "< 0.0012" or "> 0.98"; empty for none.
[[nodiscard]] std::string interval_text(const FittedParameter& parameter);
/// A sentence each.
[[nodiscard]] std::vector<std::string> uncertainty_sentences(const FitResult& result);
/// Source, scale, reduced chi-square and correlations.
[[nodiscard]] nlohmann::ordered_json uncertainty_json(const FitResult& result);

}  // namespace goniofit
