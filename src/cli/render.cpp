// goniofit render: pictures of scenes, and of materials on spheres.

#include "render/renderer.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/console.h"
#include "cli/number_arguments.h"
#include "cli/outputs.h"
#include "cli/render_comparison.h"
#include "io/material_io.h"
#include "io/number.h"
#include "render/material_variants.h"
#include "render/picture_file.h"
#include "render/scene_plan_report.h"
#include "render/scene_reader.h"
#include "render/sphere_scene.h"
#include "support/error.h"
#include "support/text.h"

namespace goniofit::cli {
namespace {

struct Options {
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path output;
  std::optional<std::size_t> size, samples;
  std::optional<std::uint64_t> seed;
  std::optional<std::string> exposure, models, effects;
  std::optional<double> tolerance;
  std::string light_angles = "45";
  double sky = 0.0;
  std::size_t threads = 0;
  bool json = false, quiet = false, compare = false;
};

bool is_scene(const std::filesystem::path& path) { return lower_case(path.extension().string()) == ".toml"; }

// What a picture shows, from left to right, and what it took.
struct Result {
  Picture picture;
  std::vector<std::string> captions;
  std::vector<std::string> notes;
  RenderWork work;
  double seconds = 0.0, preparation_s = 0.0;
  std::optional<double> exposure_stops;
  std::optional<ScenePlan> plan;
  std::optional<RenderComparison> comparison;
};

void apply(const Options& options, ImageSettings& image) {
  if (options.samples) image.samples = *options.samples;
  if (options.seed) image.seed = *options.seed;
  if (options.size) {
    image.width = std::max<std::size_t>(1, image.width * *options.size / image.height);
    image.height = *options.size;
  }
}

void add(Result& result, Rendering&& rendering, std::vector<Picture>& pictures) {
  pictures.push_back(std::move(rendering.picture));
  result.work += rendering.work;
  result.seconds += rendering.seconds;
  result.preparation_s += rendering.preparation_s;
  for (std::string& note : rendering.notes) result.notes.push_back(std::move(note));
}

Rendering render_with_progress(const Scene& scene, const std::vector<RenderMaterial>& materials, const Options& options,
                               const std::string& label, ProgressLine& line) {
  line.show(label, 0, 0);
  return render(scene, materials, {.threads = options.threads},
                [&](std::size_t done, std::size_t total) { line.show(label, done, total); });
}

// What the picture is made with.
enum class Effects { given, all, published, planned };
Effects effects_of(const Options& options, const Scene& scene) {
  const bool asked = options.tolerance || scene.plan_tolerance || options.compare;
  if (!options.effects) return asked ? Effects::planned : Effects::given;
  if (options.compare && *options.effects != "planned") {
    throw usage_error("--compare compares a plan, expected --effects planned beside it");
  }
  if (*options.effects == "given") return Effects::given;
  if (*options.effects == "all") return Effects::all;
  if (*options.effects == "published") return Effects::published;
  if (*options.effects == "planned") return Effects::planned;
  throw usage_error("--effects: " + in_quotes(*options.effects) + ", expected planned, given, all or published");
}

std::vector<RenderMaterial> materials_of(Effects effects, const Scene& scene, const Options& options, Result& result,
                                         ProgressLine& line) {
  switch (effects) {
    case Effects::given:
      return given_materials(scene);
    case Effects::all:
      return exact_materials(scene);
    case Effects::published:
      return published_materials(scene);
    case Effects::planned:
      break;
  }
  constexpr double default_tolerance = 0.01;
  ScenePlanSettings settings;
  settings.seed = scene.image.seed;
  result.plan = plan_scene(scene, options.tolerance.value_or(scene.plan_tolerance.value_or(default_tolerance)),
                           settings, [&line](const std::string& what) { line.show(what, 0, 0); });
  return result.plan->planned;
}

Result render_scene(const Options& options) {
  if (options.models) throw usage_error("--models shows a material's models, expected materials and no scene");
  Scene scene = read_scene(options.inputs.front());
  apply(options, scene.image);
  Result result;
  result.exposure_stops = scene.image.exposure_stops;
  ProgressLine line("render", options.quiet);
  const std::vector<RenderMaterial> materials = materials_of(effects_of(options, scene), scene, options, result, line);
  if (options.compare) {
    result.comparison = compare_renders(scene, *result.plan, options.threads,
                                        [&line](const std::string& what) { line.show(what, 0, 0); });
    result.picture = std::move(result.comparison->picture);
    result.work = result.comparison->work;
    result.seconds = result.comparison->seconds.median;
    return result;
  }
  std::vector<Picture> pictures;
  if (result.plan) scene = planned_scene(scene, *result.plan);
  add(result, render_with_progress(scene, materials, options, "render", line), pictures);
  result.picture = std::move(pictures.front());
  return result;
}

Result render_spheres(const Options& options) {
  if (options.compare || options.tolerance || options.effects) {
    throw usage_error("--tolerance, --effects and --compare are of scenes, expected one .toml");
  }
  const std::vector<std::string> models =
      options.models ? parse_words(*options.models, "--models") : std::vector<std::string>{"given"};
  const std::vector<double> angles = parse_numbers(options.light_angles, "--light-angle");
  SphereSettings settings{.sky = options.sky};
  if (options.size) settings.size = *options.size;
  if (options.samples) settings.samples = *options.samples;
  if (options.seed) settings.seed = *options.seed;
  Result result;
  std::vector<Picture> pictures;
  ProgressLine line("render", options.quiet);
  for (const std::filesystem::path& path : options.inputs) {
    const Material material = read_material(path);
    for (const std::string& model : models) {
      const std::string name = material.name.empty() ? path.stem().string() : material.name;
      for (const double angle : angles) {
        std::string caption = model == "given" ? name : name + ": " + model;
        if (angles.size() > 1) caption += ", light at " + shortest(angle) + "°";
        result.captions.push_back(std::move(caption));
        settings.light_angle_deg = angle;
        const Scene scene = sphere_scene(variant_of(material, model), settings);
        add(result, render_with_progress(scene, given_materials(scene), options, result.captions.back(), line),
            pictures);
      }
    }
  }
  result.picture = side_by_side(pictures);
  return result;
}

std::optional<double> exposure_of(const Options& options) {
  if (!options.exposure || *options.exposure == "auto") return std::nullopt;
  return parse_number(*options.exposure, "--exposure");
}

std::string rays_text(const Result& r) {
  const std::uint64_t rays = r.work.camera_rays + r.work.path_rays + r.work.mirror_rays + r.work.shadow_rays;
  const double all = r.work.trace_s + r.work.evaluate_s + r.work.draw_s + r.work.other_s;
  const auto share = [all](double part) { return all > 0.0 ? 100.0 * part / all : 0.0; };
  return fmt::format(
      "{} x {} pixels in {:.2f} s and {:.2f} s of preparation: {:.3g} million rays, {:.3g} million evaluations\n"
      "processor time {:.2f} s: rays {:.0f} %, reflectance {:.0f} %, drawing {:.0f} %, the rest {:.0f} %\n",
      r.picture.width, r.picture.height, r.seconds, r.preparation_s, static_cast<double>(rays) * 1e-6,
      static_cast<double>(r.work.evaluations) * 1e-6, all, share(r.work.trace_s), share(r.work.evaluate_s),
      share(r.work.draw_s), share(r.work.other_s));
}

std::string text_of(const Result& r) {
  std::string text;
  if (r.plan) text += scene_plan_text(*r.plan, stdout_style());
  if (r.comparison) text += comparison_text(*r.comparison);
  if (!r.captions.empty()) {
    text += "from left to right:";
    for (const std::string& caption : r.captions) text += (&caption == r.captions.data() ? " " : " | ") + caption;
    text += '\n';
  }
  for (const std::string& note : r.notes) text += "note: " + note + '\n';
  return text + rays_text(r);
}

std::string json_of(const Result& r) {
  const RenderWork& w = r.work;
  nlohmann::ordered_json json{
      {"width", r.picture.width},
      {"height", r.picture.height},
      {"pictures", r.captions},
      {"notes", r.notes},
      {"seconds", r.seconds},
      {"preparation_s", r.preparation_s},
      {"rays",
       {{"camera", w.camera_rays}, {"path", w.path_rays}, {"mirror", w.mirror_rays}, {"shadow", w.shadow_rays}}},
      {"evaluations", w.evaluations},
      {"processor_seconds",
       {{"trace", w.trace_s}, {"evaluate", w.evaluate_s}, {"draw", w.draw_s}, {"other", w.other_s}}}};
  if (r.plan) json["plan"] = nlohmann::ordered_json::parse(scene_plan_json(*r.plan));
  if (r.comparison) json["comparison"] = nlohmann::ordered_json::parse(comparison_json(*r.comparison));
  return json.dump(2) + '\n';
}

void expect_sizes(const Options& options) {
  constexpr std::size_t largest = 16384;
  if (options.size && (*options.size == 0 || *options.size > largest)) {
    throw usage_error("--size: " + std::to_string(*options.size) + ", expected 1 to " + std::to_string(largest));
  }
  if (options.samples && (*options.samples == 0 || *options.samples > most_samples)) {
    throw usage_error("--samples: " + std::to_string(*options.samples) + ", expected 1 to " +
                      std::to_string(most_samples));
  }
  for (const double angle : parse_numbers(options.light_angles, "--light-angle")) {
    if (!(angle >= -180.0 && angle <= 180.0)) {
      throw usage_error("--light-angle: " + shortest(angle) + ", expected degrees from -180 to 180");
    }
  }
  if (!(options.sky >= 0.0 && options.sky <= 1e6)) {
    throw usage_error("--sky: " + shortest(options.sky) + ", expected a radiance of 0 to 1e6");
  }
}

int run(const Options& options) {
  expect_sizes(options);
  expect_picture_name(options.output);
  check_outputs({options.output}, options.inputs);
  const bool scene = is_scene(options.inputs.front());
  if (scene && options.inputs.size() > 1) throw usage_error("one scene at a time, expected one .toml or materials");
  const std::optional<double> exposure = exposure_of(options);
  Result result = scene ? render_scene(options) : render_spheres(options);
  if (options.exposure) result.exposure_stops = exposure;
  PictureNotes notes;
  for (const std::string& caption : result.captions) {
    if (notes.empty()) notes.emplace_back("goniofit.pictures", "");
    notes.front().second += (notes.front().second.empty() ? "" : " | ") + caption;
  }
  if (result.plan) notes.emplace_back("goniofit.plan", scene_plan_text(*result.plan, {}));
  if (result.comparison) notes.emplace_back("goniofit.comparison", comparison_text(*result.comparison));
  write_picture(options.output, result.picture, result.exposure_stops, notes);
  to_stdout(options.json ? json_of(result) : text_of(result));
  return 0;
}

}  // namespace

void add_render(CLI::App& program, int& status) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("render", "Make a picture of a scene, or of materials on spheres");
  command->add_option("INPUT", options->inputs, "a scene (.toml), or material JSON: spheres side by side")
      ->type_name("")
      ->required();
  command->add_option("-o,--output", options->output, "the picture, .exr or .png")->type_name("FILE")->required();
  command->add_option("--size", options->size, "pixels of the picture's height (the scene's; 256 of spheres)")
      ->type_name("N");
  command->add_option("--samples", options->samples, "a pixel (the scene's; 16 of spheres); 1 is the pixel's centre")
      ->type_name("N");
  command->add_option("--seed", options->seed, "of the samples (the scene's, or 1)")->type_name("INTEGER");
  command->add_option("--exposure", options->exposure, "of a PNG: stops, or auto")->type_name("STOPS");
  command
      ->add_option("--light-angle", options->light_angles,
                   "of a sphere: between eye and light, above 90 from behind; several side by side")
      ->type_name("LIST")
      ->capture_default_str();
  command
      ->add_option("--sky", options->sky,
                   "of a sphere: radiance of what surrounds it, where a white facing the light has 1")
      ->type_name("RADIANCE")
      ->capture_default_str();
  command->add_option("--models", options->models, std::string("of each sphere: ") + variant_words)->type_name("LIST");
  command
      ->add_option("--tolerance", options->tolerance,
                   "of a scene's picture: leave out what changes it by less (relative RMS over lit pixels)")
      ->type_name("PART");
  command
      ->add_option(
          "--effects", options->effects,
          "of a scene: planned (to the tolerance; default where there is one), given (as the materials are), all "
          "(exact terms) or published (Li & Torrance's terms)")
      ->type_name("WHICH");
  command->add_flag(
      "--compare", options->compare,
      "of a scene: render the plan, all effects and the published terms in turn; state differences and times");
  command->add_option("--threads", options->threads, "0 is all there are; the picture is the same")
      ->type_name("N")
      ->capture_default_str();
  command->add_flag("--json", options->json, "what was done as JSON");
  command->add_flag("-q,--quiet", options->quiet, "no progress on standard error");
  command->footer(
      "Example:\n  goniofit render fits/ground_glass_41.json --models lambert,li-torrance,no-roughness "
      "--light-angle 110 -o spheres.png\n  goniofit render data/scenes/five_materials.toml --tolerance 0.01 --compare "
      "-o "
      "scene.exr");
  command->callback([options, &status] { status = run(*options); });
}

}  // namespace goniofit::cli
