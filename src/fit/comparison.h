#pragma once
// The paper's comparison on one scan: the same readings, fitted by one model after the other.

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "../scan/scan.h"
#include "fit.h"
#include "selection.h"
#include "settings.h"

namespace goniofit {

/// One model's row. What else there is to say of it is in the fit.
struct ComparedFit {
  std::string model;  ///< as compare() was given it
  FitResult fit;
  std::size_t free_parameters = 0;  ///< that the scan determines; derived ones not counted again
  /// The same criteria as among sets of effects (selection.h), of a fit by inverse variance; chosen: the verdict's.
  SelectionRow criteria{};
};

struct Comparison {
  std::vector<ComparedFit> rows;   ///< by loss, the least first; equal ones in the order given
  std::vector<std::string> notes;  ///< settings that a model does not have and goes without
  std::optional<Noise> noise{};    ///< that all are judged by, estimated; empty: the scan's own uncertainties
  double u_scale = 1.0;            ///< of these, as in Selection
  std::size_t groups = 0;          ///< of incidence angles left out in turn; 0 where the BIC decides
  std::string verdict{};           ///< one sentence: the simplest model not distinguishable from the best
};

/// What of the default list cannot be fitted to a scan is left out, and a note says why.
struct ModelList {
  std::vector<std::string> models, notes;
};
/// From lambert to he-torrance: the peers, Oren & Nayar's grooves alone and under a glossy surface, Li & Torrance's
/// model as published and with long-tailed slopes, and, where every wavelength and n are known, He's terms. For
/// `settings.anisotropic` those with two widths too.
[[nodiscard]] ModelList default_models(const Scan& scan, const FitSettings& settings);

/// Settings for one model by its name: a peer's; "oren-nayar"; "li-torrance", "li-torrance-student-t" or "he-torrance",
/// with the components of `settings` or automatic ones; or effects such as "rough+dd", with the terms of `settings`.
/// Optics, weights, exclusions and the settings of those parameters that the model has are those of `settings`. Throws
/// Error (bad_input) for a name that is none of these.
[[nodiscard]] FitSettings settings_for_model(const std::string& model, const FitSettings& settings);

/// The models that `--model auto` chooses among: few, and each of another kind. Li & Torrance's with automatic
/// components, with long-tailed slopes and, where wavelengths and n are known, with He's terms; ggx, cook-torrance,
/// ward and lafortune-1.
[[nodiscard]] ModelList models_to_choose_from(const Scan& scan, const FitSettings& settings);

/// Told before each fit. Must not throw.
using ComparisonProgress = std::function<void(const std::string& model, std::size_t done, std::size_t total)>;

/// Throws Error (bad_input) for a model named twice or unknown, and for settings of a parameter that no model has; an
/// error of one fit names its model. Automatic components are chosen once, for li-torrance where it is among the models
/// and comes first: the others of its family differ from it by their terms alone. The criteria come last, for all rows
/// at once: the noise that they are weighed by is the likeliest of all.
[[nodiscard]] Comparison compare(const Scan& scan, const FitSettings& settings, const std::vector<std::string>& models,
                                 const ComparisonProgress& progress = {});

}  // namespace goniofit
