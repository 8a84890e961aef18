#include "render/scene_plan.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "brdf/evaluator.h"
#include "cost/reference.h"
#include "geometry/angles.h"
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

// A weighted mean and its standard error.
class Moments {
 public:
  void add(double weight, double x) noexcept {
    w_ += weight;
    wx_ += weight * x;
    ww_ += weight * weight;
    wwx_ += weight * weight * x;
    wwxx_ += weight * weight * x * x;
  }
  [[nodiscard]] double mean() const noexcept { return w_ > 0.0 ? wx_ / w_ : 0.0; }
  [[nodiscard]] double standard_error() const noexcept {
    if (!(w_ > 0.0)) return 0.0;
    return std::sqrt(std::max(0.0, wwxx_ - 2.0 * mean() * wwx_ + mean() * mean() * ww_)) / w_;
  }

 private:
  double w_ = 0.0, wx_ = 0.0, ww_ = 0.0, wwx_ = 0.0, wwxx_ = 0.0;
};

// What an error of a material does to the image: the relative RMS over pixels and channels, each by the part of its
// light that the material sends, so that a pixel which the material hardly touches does not thin out one that shows it.
class ImageError {
 public:
  ImageError(const SceneSurvey& survey, const MaterialSurvey& material, std::size_t channels)
      : survey_(survey), material_(material), channels_(channels), lit_from_(lit_from(survey.radiance, channels)) {
    std::map<std::uint32_t, std::size_t> rows;
    const auto row_of = [&](std::uint32_t pixel) {
      const auto [at, is_new] = rows.try_emplace(pixel, pixels_.size());
      if (is_new) pixels_.push_back(pixel);
      return at->second;
    };
    for (const std::uint32_t p : material.lobes.pixel) lobe_rows_.push_back(row_of(p));
    for (const std::uint32_t p : material.mirrors.pixel) mirror_rows_.push_back(row_of(p));
  }

  [[nodiscard]] ModelError operator()(const ModelValues& reference, const ModelValues& other) const {
    const std::vector<double> sent = totals(reference.f, reference.mirror_energy, {}, {});
    const std::vector<double> change = totals(other.f, other.mirror_energy, reference.f, reference.mirror_energy);
    ModelError e;
    Moments squares;
    double changes = 0.0;
    double light = 0.0;
    for (std::size_t row = 0; row < pixels_.size(); ++row) {
      for (std::size_t c = 0; c < channels_; ++c) {
        const double radiance = survey_.radiance[pixels_[row] * channels_ + c];
        if (!(radiance > lit_from_[c])) continue;
        const double relative = change[row * channels_ + c] / radiance;
        squares.add(std::min(1.0, sent[row * channels_ + c] / radiance), relative * relative);
        changes += std::fabs(change[row * channels_ + c]);
        light += radiance;
        e.max_relative = std::max(e.max_relative, std::fabs(relative));
      }
    }
    if (!(light > 0.0)) return e;
    e.l1 = changes / light;
    e.rms_relative = e.worst_l1 = std::sqrt(squares.mean());
    e.worst_l1_bound = std::sqrt(squares.mean() + 3.0 * squares.standard_error());
    return e;
  }

 private:
  // Per pixel and channel the sum of weight * (value - from).
  [[nodiscard]] std::vector<double> totals(const std::vector<double>& f, const std::vector<double>& mirror,
                                           std::span<const double> from_f, std::span<const double> from_mirror) const {
    std::vector<double> sums(pixels_.size() * channels_, 0.0);
    const auto add = [&](const PathFactors& factors, const std::vector<std::size_t>& rows,
                         const std::vector<double>& values, std::span<const double> from) {
      const std::size_t n = factors.size();
      for (std::size_t c = 0; c < channels_; ++c) {
        for (std::size_t i = 0; i < n; ++i) {
          const double value = values[c * n + i] - (from.empty() ? 0.0 : from[c * n + i]);
          sums[rows[i] * channels_ + c] += factors.weights[c * n + i] * value;
        }
      }
    };
    add(material_.lobes, lobe_rows_, f, from_f);
    add(material_.mirrors, mirror_rows_, mirror, from_mirror);
    return sums;
  }

  const SceneSurvey& survey_;
  const MaterialSurvey& material_;
  std::size_t channels_;
  std::vector<double> lit_from_;
  std::vector<std::uint32_t> pixels_;
  std::vector<std::size_t> lobe_rows_, mirror_rows_;
};

ErrorSamples directions_of(const MaterialSurvey& s, const Material& material) {
  return {.theta_i_deg = {},
          .first = {0, s.lobes.size()},
          .directions = s.lobes.directions,
          .weights = {},
          .drawn = 1.0,
          .mirrors = s.mirrors.directions,
          .theta_r_max_deg = 90.0,
          .solid_angle_sr = material.solid_angle_sr};
}

double disc_solid_angle(double diameter_deg) { return 2.0 * pi * (1.0 - cos_deg(0.5 * diameter_deg)); }

// Radiance of what a mirror shows of a light.
double image_radiance(const Light& light, std::size_t channel) {
  struct Radiance {
    std::size_t c;
    double operator()(const PointLight& l) const { return l.intensity[c] / (pi * l.radius * l.radius); }
    double operator()(const DirectionalLight& l) const { return l.irradiance[c] / disc_solid_angle(l.diameter_deg); }
    double operator()(const AreaLight& l) const { return l.radiance[c]; }
    double operator()(const EnvironmentLight& l) const { return l.radiance[c]; }
  };
  return std::visit(Radiance{channel}, light);
}

// An image of a light is a few pixels of a picture, which no mean over pixels notices: coh stays where it stands out.
void keep_mirror_images(const Scene& scene, const SceneSurvey& survey, const MaterialSurvey& s, const Material& exact,
                        double tolerance, PlanSamples& samples) {
  if (!acting_effects(exact).has(Effect::coh)) return;
  const Evaluator evaluator(exact);
  const std::size_t channels = scene.channels.size();
  double most = 0.0;
  std::size_t light = 0;
  for (const MirrorImage& image : s.images) {
    const Pair pair = make_pair(mirrored(image.v), image.v);
    for (std::size_t c = 0; c < channels; ++c) {
      const double part = evaluator.value(pair, c, Effect::coh) * pair.cos_i * exact.solid_angle_sr;
      const double around = survey.radiance[image.pixel * channels + c];
      const double contrast = around > 0.0 ? part * image_radiance(scene.lights[image.light], c) / around : 0.0;
      if (contrast > most) {
        most = contrast;
        light = image.light;
      }
    }
  }
  if (!(most > tolerance)) return;
  samples.keep[Effect::coh] = "the mirror image of lights/" + std::to_string(light) + ", " +
                              fmt::format("{:.2g}", most) + " times as bright as what is around it, would be missing";
}

class Planner {
 public:
  Planner(const Scene& scene, double tolerance, const ScenePlanSettings& settings, const ScenePlanProgress& progress)
      : scene_(scene), tolerance_(tolerance), settings_(settings), progress_(progress) {}

  [[nodiscard]] ScenePlan run() {
    const auto start = std::chrono::steady_clock::now();
    result_.tolerance = tolerance_;
    result_.exact = exact_materials(scene_);
    tell("the paths of light");
    SurveySettings survey_settings = settings_.survey;
    survey_settings.seed = settings_.seed;
    survey_ = survey(scene_, result_.exact, survey_settings);
    // Small pictures with other random numbers than the survey's.
    const Scene small =
        in_small(scene_, settings_.survey.pixels, 2 * settings_.survey.samples, subkey(settings_.seed, "check"));
    const Picture exact = render(small, result_.exact).picture;
    double aim = tolerance_;
    constexpr int most_attempts = 5;
    for (int attempt = 1;; ++attempt) {
      plan_materials(aim);
      tell("the error of a small picture");
      result_.predicted_error = picture_difference(exact, render(small, result_.planned).picture).rms_relative;
      if (result_.predicted_error <= tolerance_ || attempt == most_attempts) break;
      aim *= 0.9 * std::min(1.0, tolerance_ / result_.predicted_error);
    }
    if (result_.predicted_error > tolerance_) result_.planned = result_.exact;
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

  void plan_materials(double aim) {
    result_.materials.clear();
    result_.planned = result_.exact;
    for (std::size_t m = 0; m < scene_.materials.size(); ++m) {
      const SceneMaterial& given = scene_.materials[m];
      MaterialPlan p{.name = given.name};
      const MaterialSurvey& s = survey_.materials[m];
      if (given.material.model != surface_model) {
        p.why_not = "the model " + given.material.model + " has no effects or terms to choose";
      } else if (acting_effects(given.material).empty()) {
        p.why_not = "it reflects nothing";
      } else if (!s.seen) {
        p.why_not = "no light comes from it to the camera";
      } else {
        tell("the plan of " + given.name);
        p.plan = planned(given.material, result_.exact[m].material, s, aim);
        result_.planned[m] = {p.plan->material, compile_settings(), true};
      }
      result_.materials.push_back(std::move(p));
    }
  }

  [[nodiscard]] Plan planned(const Material& given, const Material& exact, const MaterialSurvey& s, double aim) const {
    PlanSamples samples{.directions = directions_of(s, exact),
                        .error = ImageError(survey_, s, scene_.channels.size()),
                        .channels = channels_in(given, {})};
    keep_mirror_images(scene_, survey_, s, exact, tolerance_, samples);
    PlanSettings plan_settings = settings_.plan;
    plan_settings.compile = compile_settings();
    plan_settings.arithmetic = Arithmetic::batch_float;
    plan_settings.seed = plan_settings.timing.seed = settings_.seed;
    Plan p = plan_on(samples, given, aim, plan_settings);
    p.domain = s.domain;
    p.tolerance = tolerance_;
    return p;
  }

  // Terms that are a tenth as exact as the picture cost less and are not seen.
  [[nodiscard]] CompileSettings compile_settings() const {
    return {.tolerance = std::clamp(0.1 * tolerance_, 1e-9, 1e-3)};
  }

  const Scene& scene_;
  double tolerance_;
  const ScenePlanSettings& settings_;
  const ScenePlanProgress& progress_;
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

ScenePlan plan_scene(const Scene& scene, double tolerance, const ScenePlanSettings& settings,
                     const ScenePlanProgress& progress) {
  if (!(tolerance > 0.0 && tolerance < 1.0)) {
    throw usage_error("tolerance " + shortest(tolerance) + ": expected a number between 0 and 1");
  }
  return Planner(scene, tolerance, settings, progress).run();
}

}  // namespace goniofit
