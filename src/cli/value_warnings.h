#pragma once
// What `eval` and `simulate` say on standard error of values that are not what the formula gives.

#include <string>
#include <vector>

#include "../brdf/evaluator.h"

namespace goniofit::cli {

/// Counts values saturated at 1e300 and directions at which the functional form of rough was cut at zero; says so where
/// there are any, naming `source`.
void warn_of_values(const Evaluator& evaluator, const std::vector<AnglePair>& directions, const std::string& source);

}  // namespace goniofit::cli
