#pragma once
// The cheapest way to evaluate a material within a tolerance: which effects may be left out and which tier of each term
// is enough, on a domain. Errors and times are measured, not assumed; coefficients stay as they are.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "../brdf/batch_evaluator.h"
#include "../brdf/material.h"
#include "../geometry/domain.h"
#include "candidate.h"
#include "error_samples.h"
#include "model_error.h"
#include "timing.h"

namespace goniofit {

/// One decision: an effect or a term, kept or not, and why.
struct PlanLine {
  std::string subject;  ///< "fs", "fresnel"
  std::string choice;   ///< "kept", "left out", or the tier
  std::string instead;  ///< of a term: the tier that the change is from (a cheaper one) or to (one that was refused)
  bool simplified;      ///< left out, or a tier below the reference's
  /// Largest l1 error over the domain: what this simplification alone does to the reference, or what it would do to
  /// the plan where it was refused.
  double change;
  /// The part of the time that it saves, or would save; negative where it costs.
  double saves;
  std::string because{};  ///< of an effect that stays whatever its error: the caller's reason
  [[nodiscard]] std::string text() const;
};

struct Plan {
  Material material;  ///< to be used instead: fewer effects, other tiers; no fit summary
  Domain domain;
  double tolerance = 0.0;
  bool bound_rms = false;  ///< so is the RMS relative error
  std::string reference;   ///< what errors are against
  std::vector<PlanLine> lines;
  ModelError error;         ///< of the plan; worst_l1_bound is at most the tolerance
  ModelError error_before;  ///< of the material as it was given
  /// Of one pair of directions in one channel, the domain's channels together; medians of one interleaved run.
  double ns = 0.0, ns_before = 0.0, ns_reference = 0.0;
  double ratio_before = 1.0, ratio_reference = 1.0;  ///< of these times over the plan's, round by round
  std::size_t searched = 0, within = 0, timed = 0;   ///< combinations
};

struct PlanSettings {
  /// Close incidences: between them an error may be larger than at both.
  ErrorSettings errors{.incidences = 25, .directions = 512};
  TimingSettings timing{};
  std::size_t pairs = 4096;
  /// How the caller compiles what is planned: it decides what a term costs, and its tolerance is part of the error.
  CompileSettings compile{};
  Arithmetic arithmetic = Arithmetic::batch_double;  ///< likewise
  std::uint64_t seed = 1;
  /// Bound the RMS relative error as well: dark directions then count as bright ones do.
  bool bound_rms = false;
  /// Which plan is the fastest is measured; else it is told by a table of what effects and terms usually cost, so that
  /// the same input has the same plan on every run (its times are measured all the same).
  bool by_the_clock = true;
  /// Few repetitions and directions: for trying out.
  [[nodiscard]] static PlanSettings quick();
};

/// Where errors are measured when that is no Domain: the directions of a scene, say.
struct PlanSamples {
  ErrorSamples directions;  ///< where the material is evaluated; at the mirror directions its coherent part
  /// Of another version's values there; its worst_l1_bound is what the tolerance bounds, its worst_l1 what a decision
  /// is said to change. Need not bother about the rest.
  std::function<ModelError(const ModelValues& reference, const ModelValues& other)> error;
  std::vector<std::size_t> channels;     ///< that are timed
  std::map<Effect, std::string> keep{};  ///< effects that stay whatever the error says, and why
};

/// Told what is being done. Must not throw.
using PlanProgress = std::function<void(const std::string& what)>;

/// The tolerance bounds the l1 error (model_error.h) of every incidence angle and channel of the domain, three standard
/// errors of its estimate included; the relative errors are stated beside it, and the RMS one is bounded on request.
/// Throws Error (bad_input) for a tolerance outside (0, 1), an invalid material or domain, a peer, wavelengths that no
/// channel has, and a material of which no effect acts.
[[nodiscard]] Plan plan(const Material& material, const Domain& domain, double tolerance,
                        const PlanSettings& settings = {}, const PlanProgress& progress = {});

/// The same where the caller knows the very directions; the plan's domain is left as it is by default, and `errors` and
/// `bound_rms` are not read.
[[nodiscard]] Plan plan_on(const PlanSamples& samples, const Material& material, double tolerance,
                           const PlanSettings& settings = {}, const PlanProgress& progress = {});

/// The channels that a domain asks for: all, or those of its wavelengths (to 0.5 nm). Throws Error (bad_input) for a
/// wavelength that no channel has.
[[nodiscard]] std::vector<std::size_t> channels_in(const Material& material, const Domain& domain);

/// The error of another version of a material within the domain, by `settings`: to check a plan on fresh directions.
[[nodiscard]] ModelError error_within(const Material& reference, const Material& other, const Domain& domain,
                                      const ErrorSettings& settings);

}  // namespace goniofit
