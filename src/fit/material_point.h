#pragma once
// A material as a point of a problem's parameters.

#include "../brdf/material.h"
#include "problem.h"
#include "search.h"

namespace goniofit {

/// Within the problem's bounds. A shape parameter that the material leaves open stands at 1, a coefficient at 0. The
/// loss is not filled.
[[nodiscard]] FitPoint point_of(const Problem& problem, const Material& material);

}  // namespace goniofit
