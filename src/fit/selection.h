#pragma once
// Which effects does a scan call for? What "auto" does for the surface family.
//
// Sets of effects are fitted as asked (global search, polish, the loss of the settings). That loss cannot rank them:
// bright readings decide it, while measured BRDFs have relative noise. So each set is fitted once more by inverse
// variance, and chi², AICc and BIC are of these fits. The variance is that of the scan's own uncertainties where it
// states them, enlarged where the residuals' median is larger than they allow (Birge ratio: misfit is no evidence),
// else
//
//   variance = a² + (r f)²,
//
// estimated, robustly, from the likeliest of the sets that no other contains. What decides is the prediction of
// incidence angles that were left out of the fit (cross_validation.h). As good as the best are the sets within one
// standard error of its score, the error being that of the paired differences over the groups of angles, and those of
// no larger BIC. A set that leaves out an effect standing at five of its standard uncertainties in another set is none
// to choose where the other has the smaller AICc, be it within the other or not: grooves can stand in for udf and uds
// (selection_guard.h). Of the rest the one with the fewest effects is chosen. With fewer than four incidence angles the
// BIC decides.
//
// The largest sets are fitted first. One that leaves twice the least loss, or scores worse than the best by more than
// chance, spares the sets within it; coh, where it does not pay in the largest set, all sets with it. Of more than six
// channels the six that tell most are compared (selection_bands.h), and the choice is held against the largest set on
// all of them: a channel that shows an effect which the choice lacks joins the six.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "../brdf/material.h"
#include "../scan/scan.h"
#include "settings.h"

namespace goniofit {

/// One set of effects that was tried.
struct SelectionRow {
  EffectSet components;
  std::size_t free_parameters = 0;  ///< neither fixed nor on a bound nor without effect, in the inverse-variance fit
  double loss = 0.0;                ///< of the fit as asked, sr⁻²
  double chi2 = 0.0;                ///< of the inverse-variance fit, over all readings and channels
  double aicc = 0.0, bic = 0.0;     ///< chi² and penalties: constants common to all sets are left out
  double aicc_weight = 0.0;         ///< of all sets together 1 (Burnham & Anderson 2002)
  double bic_weight = 0.0;
  /// Mean score of left-out readings; a perfect model has 1 (cross_validation.h). Null: not computed, since the set
  /// cannot win (it leaves twice as much as the best, or a set within it has the smaller AICc).
  std::optional<double> cross_validated;
  std::optional<double> difference, difference_error;  ///< of the score to the best one, and its standard error
  bool chosen = false;
};

struct Selection {
  std::vector<SelectionRow> rows;  ///< chosen first, then by score, then by BIC; empty where nothing was to be chosen
  /// Not fitted, each being part of a set that leaves far more than the best.
  std::vector<EffectSet> not_fitted;
  std::optional<Noise> noise{};  ///< estimated; empty: the scan's own uncertainties stand for it
  double u_scale = 1.0;          ///< of these: above 1 where the residuals are larger (Birge ratio)
  /// The channels that the sets were compared on, where these are not all: those that tell most (see below).
  std::vector<std::string> channels{};
  std::size_t groups = 0;  ///< of incidence angles left out in turn; 0 where BIC decided
  std::string reason;      ///< one sentence

  [[nodiscard]] EffectSet chosen() const;
};

/// The sets that are tried: of effects that the optics (no light from below the surface of a metal), the readings (coh
/// needs one in the mirror cone and wavelengths; udf and uds a range of angles that tells them apart) and the settings
/// (an effect whose coefficient is fixed to 0 is out, to another value in) allow. coh and fs come with dd, whose
/// surface they are of; rough stands in for udf and uds. Throws Error like fit().
[[nodiscard]] std::vector<EffectSet> sensible_components(const Scan& scan, const FitSettings& settings);

/// Deterministic. Ignores settings.components. Throws Error (bad_input) like fit().
[[nodiscard]] Selection select_components(const Scan& scan, const FitSettings& settings);

}  // namespace goniofit
