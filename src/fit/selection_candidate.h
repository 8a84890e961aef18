#pragma once
// A set of effects with its fits, on the way to a choice among them.

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "cross_validation.h"
#include "problem.h"
#include "search.h"
#include "selection.h"

namespace goniofit {

struct Candidate {
  SelectionRow row;
  std::unique_ptr<Problem> problem;
  FitPoint asked;             ///< the fit as asked
  FitPoint weighted;          ///< by inverse variance
  Eigen::VectorXd in_sample;  ///< scores of each group's readings in the weighted fit
  Eigen::VectorXd left_out;   ///< the same of the fits that leave the group out; empty: not computed
};

/// The fit as asked, to the accuracy that a choice needs. From the shape of a set that contains this one and has the
/// same shape parameters, where there is one: if the smaller set is the truth, the larger has its shape. Else by the
/// global search. Throws Error (bad_input) like fit().
[[nodiscard]] Candidate fit_candidate(const Scan& scan, const FitSettings& settings, EffectSet set,
                                      const Candidate* larger = nullptr);

/// Model values of all channels and how far they are from the readings, 1/sr, by the weighted fit.
struct Prediction {
  Eigen::VectorXd f, residual;
};
[[nodiscard]] Prediction predict(const Candidate& candidate);

/// The fit by inverse variance, from the one before; fills the criteria of the row. `variance` is one a reading,
/// channel after channel, in 1/sr².
void fit_weighted(Candidate& candidate, const Eigen::VectorXd& variance);

/// Squared standard uncertainties that the scan itself states, channel after channel; empty where some channel states
/// none.
[[nodiscard]] Eigen::VectorXd stated_variance(const Problem& problem);

/// The weights of AICc and BIC among the rows, of all together 1.
void add_weights(const std::vector<SelectionRow*>& rows);

/// Not to be told from the best by what the scan says: the left-out readings, or what the row costs by the BIC.
[[nodiscard]] bool as_good(const SelectionRow& row, const SelectionRow& best);

/// Whether `larger` has all effects of `smaller`.
[[nodiscard]] bool contains(EffectSet larger, EffectSet smaller) noexcept;

}  // namespace goniofit
