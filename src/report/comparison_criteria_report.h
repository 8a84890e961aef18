#pragma once
// The criteria of a comparison: what the scan says of its models, whatever loss they were fitted by.

#include <string>
#include <vector>

#include "../fit/comparison.h"

namespace goniofit {

/// The rows by their verdict: the chosen one first, then by the score of left-out readings, else by the BIC.
[[nodiscard]] std::vector<const ComparedFit*> by_criteria(const Comparison& comparison);

/// "noise estimated: 2 % of the value and 1e-05 sr⁻¹", or whose uncertainties stand for it.
[[nodiscard]] std::string noise_text(const std::optional<Noise>& noise, double u_scale);

/// A table of them and the verdict below; empty where the comparison has none.
[[nodiscard]] std::string comparison_criteria_block(const Comparison& comparison, bool color);

}  // namespace goniofit
