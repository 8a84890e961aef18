#include "render/scene_plan.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "cost/reference.h"
#include "render/image_error.h"
#include "render/picture_difference.h"
#include "support/error.h"
#include "support/text.h"
#include "synthetic/random.h"

namespace goniofit {

namespace {

bool can_be_planned(const Material& m) { return m.model == surface_model && !acting_effects(m).empty(); }

template <class Change>
std::vector<RenderMaterial> changed(const Scene& scene, const Change& change) {
  std::vector<RenderMaterial> materials;
  for (const SceneMaterial& m : scene.materials) {
    materials.push_back({can_be_planned(m.material) ? change(m.material) : m.material, {}, false});
  }
  return materials;
}

// A small picture and what it took, the least of a few times.
struct SmallPicture {
  Picture picture;
  double seconds;
};
SmallPicture small_picture(const Scene& scene, std::span<const RenderMaterial> materials) {
  constexpr int times = 3;
  SmallPicture small{{}, std::numeric_limits<double>::infinity()};
  for (int i = 0; i < times; ++i) {
    Rendering r = render(scene, materials);
    small.seconds = std::min(small.seconds, r.seconds);
    small.picture = std::move(r.picture);
  }
  return small;
}

class Planner {
 public:
  Planner(const Scene& scene, double tolerance, const ScenePlanSettings& settings, const ScenePlanProgress& progress)
      : scene_(scene),
        tolerance_(tolerance),
        settings_(settings),
        progress_(progress),
        small_(in_small(scene, settings.survey.pixels, 2 * settings.survey.samples, subkey(settings.seed, "check"))) {}

  [[nodiscard]] ScenePlan run() {
    const auto start = std::chrono::steady_clock::now();
    result_.tolerance = tolerance_;
    result_.exact = exact_materials(scene_);
    plan_bounces();
    tell("the paths of light");
    SurveySettings survey_settings = settings_.survey;
    survey_settings.seed = settings_.seed;
    survey_ = survey(planned_scene(scene_, result_), result_.exact, survey_settings);
    plan_until_it_holds();
    for (std::size_t m = 0; m < result_.materials.size(); ++m) {
      result_.materials[m].survey = std::move(survey_.materials[m]);
    }
    result_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return std::move(result_);
  }

 private:
  void tell(const std::string& what) const {
    if (progress_) progress_(what);
  }

  // The fewest reflections whose picture stays within half of the tolerance; errors of materials have the rest.
  void plan_bounces() {
    BouncePlan& b = result_.bounces;
    b.given = b.planned = scene_.image.max_bounces;
    tell("light that is reflected more than once");
    const SmallPicture all = small_picture(small_, result_.exact);
    exact_ = all.picture;
    Scene fewer = small_;
    for (int bounces = b.given - 1; bounces >= 1; --bounces) {
      fewer.image.max_bounces = bounces;
      const SmallPicture less = small_picture(fewer, result_.exact);
      const double change = picture_difference(exact_, less.picture).rms_relative;
      const bool enough = change <= 0.5 * tolerance_;
      if (enough || bounces + 1 == b.given) {
        b.change = change;
        b.saves = 1.0 - less.seconds / all.seconds;
      }
      if (!enough) break;
      b.planned = bounces;
    }
  }

  // Small pictures by other random numbers than the survey's have the last word. A picture's rarest paths are not in a
  // small one: of the tolerance, small pictures may take the part `margin`. The material that errs most then plans anew
  // with half the aim, which at last leaves nothing but its exact terms.
  void plan_until_it_holds() {
    constexpr double margin = 0.6;
    constexpr double least_aim = 1e-3;
    const Scene planned_small = planned_scene(small_, result_);
    const auto error_with = [&](const std::vector<RenderMaterial>& materials) {
      return picture_difference(exact_, render(planned_small, materials).picture).rms_relative;
    };
    std::vector<double> aims(scene_.materials.size(), margin * tolerance_);
    result_.planned = result_.exact;
    result_.materials.resize(scene_.materials.size());
    for (std::size_t m = 0; m < aims.size(); ++m) plan_material(m, aims[m]);
    tell("the error of a small picture");
    result_.predicted_error = error_with(result_.planned);
    while (result_.predicted_error > margin * tolerance_) {
      std::size_t worst = aims.size();
      double most = 0.0;
      for (std::size_t m = 0; m < aims.size(); ++m) {
        if (aims[m] < least_aim * tolerance_) continue;
        std::vector<RenderMaterial> alone = result_.exact;
        alone[m] = result_.planned[m];
        const double error = error_with(alone);
        if (error > most) {
          most = error;
          worst = m;
        }
      }
      if (worst == aims.size()) break;
      aims[worst] *= 0.5;
      plan_material(worst, aims[worst]);
      result_.predicted_error = error_with(result_.planned);
    }
  }

  void plan_material(std::size_t m, double aim) {
    const SceneMaterial& given = scene_.materials[m];
    const MaterialSurvey& s = survey_.materials[m];
    MaterialPlan p{.name = given.name};
    result_.planned[m] = result_.exact[m];
    if (!s.seen) {
      p.why_not = "no light comes from it to the camera";
    } else if (given.material.model != surface_model) {
      p.why_not = "the model " + given.material.model + " has no effects or terms to choose";
    } else if (acting_effects(given.material).empty()) {
      p.why_not = "it reflects nothing";
    } else {
      tell("the plan of " + given.name);
      try {
        p.plan = planned(given.material, result_.exact[m].material, s, aim);
        result_.planned[m] = {p.plan->material, compile_settings(aim), true};
        add_times(result_.exact[m].material, result_.planned[m], p);
      } catch (const Error& e) {
        if (e.kind() != ErrorKind::failed_result) throw;
        p.why_not = "nothing simpler stays within the tolerance";
      }
    }
    p.indirect = indirect_part(survey_, s, scene_.channels.size());
    p.follows = p.indirect > 0.5 * aim || p.indirect == 0.0;  // nothing to leave out
    result_.planned[m].follows = p.follows;
    result_.materials[m] = std::move(p);
  }

  [[nodiscard]] Plan planned(const Material& given, const Material& exact, const MaterialSurvey& s, double aim) const {
    const std::vector<StandingImage> images = standing_images(scene_, survey_, s, exact, tolerance_);
    PlanSamples samples{.directions = image_error_samples(s, images, exact.solid_angle_sr),
                        .error = ImageError(survey_, s, scene_.channels.size()),
                        .channels = channels_in(given, {})};
    const auto brightest = std::max_element(images.begin(), images.end(),
                                            [](const auto& a, const auto& b) { return a.contrast < b.contrast; });
    if (brightest != images.end()) {
      samples.keep[Effect::coh] = fmt::format(
          "the mirror image of lights/{}, {:.2g} times as bright as its surroundings, "
          "would be missing",
          brightest->light, brightest->contrast);
    }
    PlanSettings plan_settings = settings_.plan;
    plan_settings.compile = compile_settings(aim);
    plan_settings.arithmetic = Arithmetic::batch_float;
    plan_settings.by_the_clock = false;
    plan_settings.seed = plan_settings.timing.seed = settings_.seed;
    Plan p = plan_on(samples, given, aim, plan_settings);
    p.domain = s.domain;
    p.tolerance = tolerance_;
    return p;
  }

  void add_times(const Material& exact, const RenderMaterial& planned, MaterialPlan& p) const {
    const DirectionBatch pairs = random_pairs(settings_.plan.pairs, settings_.seed);
    const std::array tasks{evaluation_task({.name = {},
                                            .material = planned.material,
                                            .compile = planned.compile,
                                            .arithmetic = Arithmetic::batch_float},
                                           pairs),
                           evaluation_task({.name = {}, .material = exact}, pairs)};
    const std::vector<Timing> times = time_interleaved(tasks, 0, settings_.plan.timing);
    p.ns = times[0].median_ns;
    p.ns_exact = times[1].median_ns;
  }

  // Terms with a tenth of the error that is allowed cost less, and are not seen.
  [[nodiscard]] static CompileSettings compile_settings(double aim) {
    return {.tolerance = std::clamp(0.1 * aim, 1e-9, 1e-3)};
  }

  const Scene& scene_;
  double tolerance_;
  const ScenePlanSettings& settings_;
  const ScenePlanProgress& progress_;
  Scene small_;
  Picture exact_;  // small, all effects
  SceneSurvey survey_;
  ScenePlan result_;
};

}  // namespace

std::vector<RenderMaterial> exact_materials(const Scene& scene) {
  return changed(scene, [](const Material& m) { return reference_of(m, WaveOptics::fast).material; });
}

std::vector<RenderMaterial> published_materials(const Scene& scene) {
  return changed(scene, [](Material m) {
    m.terms = published_terms(m);
    return m;
  });
}

Scene planned_scene(Scene scene, const ScenePlan& plan) {
  scene.image.max_bounces = plan.bounces.planned;
  return scene;
}

ScenePlan plan_scene(const Scene& scene, double tolerance, const ScenePlanSettings& settings,
                     const ScenePlanProgress& progress) {
  if (!(tolerance > 0.0 && tolerance < 1.0)) {
    throw usage_error("tolerance " + shortest(tolerance) + ": expected a number between 0 and 1");
  }
  return Planner(scene, tolerance, settings, progress).run();
}

}  // namespace goniofit
