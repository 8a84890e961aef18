#pragma once
// Only the effects that a scene calls for: each of its materials planned (cost/planner.h) on just the pairs of
// directions that light takes through this scene to this camera, and by what an error there does to the image.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "../cost/planner.h"
#include "renderer.h"
#include "survey.h"

namespace goniofit {

struct MaterialPlan {
  std::string name;            ///< in the scene
  std::optional<Plan> plan{};  ///< null for what is not planned; its worst_l1 is the relative RMS error of the image,
                               ///< pixels by the part of their light that the material sends
  std::string why_not{};       ///< then: not seen, a peer model, ...
  bool follows = true;         ///< light that other surfaces send to it
  double indirect = 0.0;       ///< relative RMS change of the image without that, three standard errors included
  /// Of one pair of directions in one channel: as planned, and with all effects and exact terms, in double precision.
  double ns = 0.0, ns_exact = 0.0;
  MaterialSurvey survey{};
};

/// How many reflections of a light path are followed, and what leaving out the rest does to small pictures.
struct BouncePlan {
  int given = 1, planned = 1;
  double change = 0.0;  ///< relative RMS over lit pixels, of the planned number; of one less where nothing is left out
  double saves = 0.0;   ///< part of the time of small pictures, likewise
};

struct ScenePlan {
  double tolerance = 0.0;
  std::vector<MaterialPlan> materials;
  BouncePlan bounces;
  std::vector<RenderMaterial> exact;    ///< all effects, exact terms (he-torrance where sigma is known)
  std::vector<RenderMaterial> planned;  ///< to be rendered
  double predicted_error = 0.0;         ///< relative RMS over lit pixels, measured between small pictures of both
  double seconds = 0.0;                 ///< that planning took
};

struct ScenePlanSettings {
  SurveySettings survey{};
  PlanSettings plan = PlanSettings::quick();
  std::uint64_t seed = 1;
};

/// All effects that act with the most exact terms that each material knows the parameters of, in double precision; what
/// has no terms (peers, black) as it is.
[[nodiscard]] std::vector<RenderMaterial> exact_materials(const Scene& scene);
/// With the terms of Li & Torrance 2005 as published.
[[nodiscard]] std::vector<RenderMaterial> published_materials(const Scene& scene);

/// The scene as the plan renders it, with its number of reflections; the materials are plan.planned.
[[nodiscard]] Scene planned_scene(Scene scene, const ScenePlan& plan);

/// Told what is being done. Must not throw.
using ScenePlanProgress = std::function<void(const std::string& what)>;

/// The relative RMS error of the image over its lit pixels stays within the tolerance, first as predicted to first
/// order at the survey's pixels, then as measured between small pictures with other random numbers; planning is
/// repeated with a smaller aim where that is not so. coh stays wherever a light with a size may be seen in the mirror
/// and would stand out, however few pixels it takes, and within the tolerance as bright as it is. Throws Error
/// (bad_input) for a tolerance outside (0, 1), and what render() throws.
[[nodiscard]] ScenePlan plan_scene(const Scene& scene, double tolerance, const ScenePlanSettings& settings = {},
                                   const ScenePlanProgress& progress = {});

}  // namespace goniofit
