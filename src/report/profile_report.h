#pragma once
// What the report says of profile likelihoods.

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "../fit/likelihood_profile.h"

namespace goniofit {

/// A table: parameter, value, u, the interval that u gives and the one of the profile, remark.
[[nodiscard]] std::string profile_block(const std::vector<LikelihoodProfile>& profiles, bool color);
/// The same with the points of each profile. An end that no bound limits is null.
[[nodiscard]] nlohmann::ordered_json profiles_json(const std::vector<LikelihoodProfile>& profiles);

}  // namespace goniofit
