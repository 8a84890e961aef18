#pragma once
// What the terminal report and its JSON form both say of a fit's parameters.

#include <string>
#include <vector>

#include "../fit/fit.h"
#include "../scan/scan.h"

namespace goniofit {

/// "hemispherical" or "incidence plane".
[[nodiscard]] std::string geometry_name(ScanGeometry geometry);
/// The names of the effects, in the order of `all_effects`.
[[nodiscard]] std::vector<std::string> effect_names(EffectSet effects);
[[nodiscard]] std::string effects_text(EffectSet effects, const std::string& separator);
/// "um" as "µm".
[[nodiscard]] std::string unit_text(const std::string& unit);

/// "free", "fixed", "derived", "at lower bound", "at upper bound" or "undetermined".
[[nodiscard]] std::string state_of(const FittedParameter& parameter);
/// The state in words for the table; empty for a free parameter.
[[nodiscard]] std::string remark_of(const FittedParameter& parameter);
/// The same for a narrow column.
[[nodiscard]] std::string short_remark_of(const FittedParameter& parameter);

/// Null where the channel has no such parameter.
[[nodiscard]] const FittedParameter* find_parameter(const FitResult& result, const std::string& channel,
                                                    const std::string& name);
/// Each parameter name that some channel has, in the order they come.
[[nodiscard]] std::vector<std::string> channel_parameter_names(const FitResult& result);

/// At most `most` of `count` indices, evenly spaced, the first and the last among them. `most` is at least 2.
[[nodiscard]] std::vector<std::size_t> evenly_chosen(std::size_t count, std::size_t most);

}  // namespace goniofit
