#pragma once
// From the best point of a problem to the result: the material, the rows of the report, the warnings.

#include "fit.h"
#include "fit_evidence.h"
#include "polish.h"
#include "problem.h"

namespace goniofit {

[[nodiscard]] FitResult assemble(const Problem& problem, const Scan& scan, const Polished& best,
                                 const FitEvidence& evidence);

}  // namespace goniofit
