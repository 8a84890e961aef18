#pragma once
// Why a plan is what it is: each decision undone, or taken the other way, one at a time. Private to the planner.

#include <vector>

#include "plan_search.h"
#include "planner.h"

namespace goniofit {

/// A line whose `saves` is still to be measured: `other` is the plan with this one decision the other way.
struct PlanAlternative {
  PlanLine line;
  PlanChoice other;
};

[[nodiscard]] std::vector<PlanAlternative> plan_alternatives(PlanSearch& search, const PlanChoice& chosen);

}  // namespace goniofit
