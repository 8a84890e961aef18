#pragma once
// What is to be said of a fit's parameters: its notes and warnings, each with what to do next.

#include "fit.h"
#include "fit_evidence.h"
#include "problem.h"

namespace goniofit {

/// Appends to result.notes and result.warnings, from the finished rows and result.identifiability.
void add_fit_warnings(FitResult& result, const Problem& problem, const FitPoint& point, const FitEvidence& evidence);

}  // namespace goniofit
