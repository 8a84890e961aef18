#pragma once
// Looking up what recipe or flags say of a parameter, and checking that they speak of parameters there are.

#include <string>
#include <utility>
#include <vector>

#include "settings.h"

namespace goniofit {

/// "CHANNEL.name" over "name"; an empty setting where neither is there.
[[nodiscard]] ParameterSetting setting_of(const FitSettings& settings, const std::string& name,
                                          const std::string& channel = {});

/// The interval that a setting leaves of [lower, upper]; equal ends where it fixes. Throws Error (bad_input) naming the
/// parameter when the setting lies outside or its bounds cross.
[[nodiscard]] std::pair<double, double> interval_of(const ParameterSetting& setting, const std::string& name,
                                                    double lower, double upper);

/// Throws Error (bad_input) naming the setting where the value lies outside.
void check_range(double value, double lower, double upper, const std::string& name);

/// Throws Error (bad_input) for a name that is no parameter of the model or a channel that the scan does not have.
void check_parameter_names(const FitSettings& settings, const std::vector<std::string>& channels);

}  // namespace goniofit
