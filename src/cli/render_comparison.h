#pragma once
// What a scene's plan costs and saves, measured: the same picture by the plan, with all effects, and by the published
// model.

#include <functional>
#include <string>

#include "render/picture_difference.h"
#include "render/scene_plan.h"

namespace goniofit::cli {

struct Spread {
  double median = 0.0, min = 0.0, max = 0.0;
};

struct RenderComparison {
  PictureDifference difference;                      ///< of the plan against all effects with exact terms
  PictureDifference published;                       ///< of Li & Torrance's terms against the same
  Spread seconds, exact_seconds, published_seconds;  ///< materials compiled and samplers measured included
  Spread exact_ratio, published_ratio;               ///< of their times over the plan's, round by round
  Picture picture;                                   ///< by the plan
  RenderWork work;                                   ///< likewise, of one round
};

/// Renders the scene in turn by each, in three rounds.
[[nodiscard]] RenderComparison compare_renders(const Scene& scene, const ScenePlan& plan, std::size_t threads,
                                               const std::function<void(const std::string&)>& tell);

[[nodiscard]] std::string comparison_text(const RenderComparison& comparison);
[[nodiscard]] std::string comparison_json(const RenderComparison& comparison);

}  // namespace goniofit::cli
