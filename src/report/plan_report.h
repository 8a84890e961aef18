#pragma once
// A plan as text and JSON.

#include <string>

#include "../cost/planner.h"
#include "fit_report.h"

namespace goniofit {

[[nodiscard]] std::string plan_text(const Plan& plan, const ReportStyle& style);

/// {"material", "components", "terms", "forms", "reference", "tolerance", "bound_rms", "domain", "l1_error",
/// "worst_l1_error", "worst_l1_bound", "worst_theta_i_deg", "rms_relative_error", "max_relative_error",
/// "l1_error_before", "worst_l1_error_before", "ns_per_evaluation", "ns_before", "ns_reference", "ratio_before",
/// "ratio_reference", "searched", "within_tolerance", "timed", "lines": [{"subject", "choice", "instead", "simplified",
/// "change", "saves", "text"}]}.
[[nodiscard]] std::string plan_json(const Plan& plan);

}  // namespace goniofit
