#pragma once
// A scene's plan as text and JSON.

#include <string>

#include "../report/fit_report.h"
#include "scene_plan.h"

namespace goniofit {

[[nodiscard]] std::string scene_plan_text(const ScenePlan& plan, const ReportStyle& style);

/// {"tolerance", "predicted_error", "seconds", "reflections": {"given", "planned", "change", "saves"}, "materials":
/// [{"name", "planned": null or the plan as plan_json() has it, "why_not", "theta_i_deg", "theta_r_max_deg",
/// "left_out", "follows", "indirect", "ns_per_evaluation", "ns_exact", "material": as a file holds it}]}.
[[nodiscard]] std::string scene_plan_json(const ScenePlan& plan);

/// "coh, fs", then terms and the light of other surfaces: "shadowing, interreflection"; "nothing" where all is kept.
[[nodiscard]] std::string left_out_text(const MaterialPlan& plan);

}  // namespace goniofit
