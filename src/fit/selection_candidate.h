#pragma once
// A set of effects with its fits, on the way to a choice among them.

#include <Eigen/Core>
#include <memory>

#include "problem.h"
#include "search.h"
#include "selection.h"

namespace goniofit {

struct Candidate {
  SelectionRow row;
  std::unique_ptr<Problem> problem;
  FitPoint asked;            ///< the fit as asked
  FitPoint weighted;         ///< by inverse variance
  Eigen::VectorXd left_out;  ///< squared deviations of each group's readings where it was left out; empty: not computed
};

/// The fit as asked, to the accuracy that a choice needs. Throws Error (bad_input) like fit().
[[nodiscard]] Candidate fit_candidate(const Scan& scan, const FitSettings& settings, EffectSet set);

/// Model values of all channels and how far they are from the readings, 1/sr, by the weighted fit.
struct Prediction {
  Eigen::VectorXd f, residual;
};
[[nodiscard]] Prediction predict(const Candidate& candidate);

/// The fit by inverse variance, from the one before; fills the criteria of the row. `variance` is one a reading,
/// channel after channel, in 1/sr².
void fit_weighted(Candidate& candidate, const Eigen::VectorXd& variance);

/// Whether `larger` has all effects of `smaller`.
[[nodiscard]] bool contains(EffectSet larger, EffectSet smaller) noexcept;

}  // namespace goniofit
