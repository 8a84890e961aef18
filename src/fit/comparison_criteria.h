#pragma once
// Which of the models compared does the scan call for?

#include "comparison.h"

namespace goniofit {

/// Fills the criteria of every row, the noise and the verdict: each model is fitted once more by inverse variance,
/// from its fit, and predicts incidence angles that are left out (cross_validation.h). As good as the best are models
/// within one standard error of its score, by the paired differences, and those of no larger BIC; the verdict is the
/// one of them with the fewest free parameters. With fewer than four incidence angles it is the least BIC.
void add_criteria(const Scan& scan, const FitSettings& settings, Comparison& comparison);

}  // namespace goniofit
