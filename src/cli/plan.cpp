// goniofit plan: the cheapest effects and tiers within a tolerance.

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "cli/console.h"
#include "cli/number_arguments.h"
#include "cli/outputs.h"
#include "cost/planner.h"
#include "io/material_io.h"
#include "io/number.h"
#include "io/scan_reader.h"
#include "render/scene_plan_report.h"
#include "render/scene_reader.h"
#include "report/plan_report.h"
#include "scan/scan_domain.h"
#include "support/error.h"
#include "support/text.h"

namespace goniofit::cli {
namespace {

struct Options {
  std::filesystem::path material;
  std::optional<std::filesystem::path> scan, output;
  double tolerance = 0.0, terms_to = 0.0;
  std::optional<double> max_theta, solid_angle;
  std::optional<std::string> theta_i, wavelengths;
  std::uint64_t seed = 1;
  bool json = false, rms = false, quick = false, quiet = false;
};

// The scan's domain, else the default one; each flag replaces its part.
Domain domain_of(const Options& options) {
  Domain d = options.scan ? domain_of(read_scan(*options.scan)) : Domain{};
  if (options.theta_i) {
    const std::vector<double> range = parse_numbers(*options.theta_i, "--theta-i");
    if (range.size() != 2) {
      throw usage_error("--theta-i: " + in_quotes(*options.theta_i) + ", expected two angles such as 0,60");
    }
    d.theta_i_min_deg = range[0];
    d.theta_i_max_deg = range[1];
  }
  if (options.max_theta) {
    d.theta_r_max_deg = *options.max_theta;
    if (!options.theta_i) d.theta_i_max_deg = std::min(d.theta_i_max_deg, *options.max_theta);
  }
  if (options.wavelengths) d.wavelengths_um = parse_numbers(*options.wavelengths, "--wavelengths");
  if (options.solid_angle) d.solid_angle_sr = options.solid_angle;
  validate(d);
  return d;
}

void expect_no_flags_of_materials(const Options& o) {
  const std::pair<bool, const char*> flags[] = {{o.scan.has_value(), "--scan"},
                                                {o.theta_i.has_value(), "--theta-i"},
                                                {o.max_theta.has_value(), "--max-theta"},
                                                {o.wavelengths.has_value(), "--wavelengths"},
                                                {o.solid_angle.has_value(), "--solid-angle"},
                                                {o.terms_to != 0.0, "--terms-to"},
                                                {o.rms, "--rms"},
                                                {o.quick, "--quick"}};
  for (const auto& [given, name] : flags) {
    if (given) throw usage_error(std::string(name) + ": a scene says itself what matters, expected a material");
  }
}

int plan_of_scene(const Options& options) {
  expect_no_flags_of_materials(options);
  if (options.output) check_outputs({*options.output}, {options.material});
  const Scene scene = read_scene(options.material);
  const ScenePlan planned = [&] {
    ProgressLine line("plan", options.quiet);
    ScenePlanSettings settings;
    settings.seed = options.seed;
    return plan_scene(scene, options.tolerance, settings, [&line](const std::string& what) { line.show(what, 0, 0); });
  }();
  const std::string json = scene_plan_json(planned);
  if (options.output) write_result(*options.output, json);
  if (options.output && is_stdout(*options.output)) return 0;
  to_stdout(options.json ? json : scene_plan_text(planned, stdout_style()));
  return 0;
}

int run(const Options& options) {
  if (lower_case(options.material.extension().string()) == ".toml") return plan_of_scene(options);
  if (!(options.tolerance > 0.0 && options.tolerance < 1.0)) {
    throw usage_error("--tolerance: " + shortest(options.tolerance) + ", expected a number between 0 and 1");
  }
  if (options.terms_to != 0.0 && !(options.terms_to >= 1e-9 && options.terms_to < options.tolerance)) {
    throw usage_error("--terms-to: " + shortest(options.terms_to) + ", expected 0 or from 1e-9 to below --tolerance");
  }
  std::vector<std::filesystem::path> inputs{options.material};
  if (options.scan) inputs.push_back(*options.scan);
  if (options.output) check_outputs({*options.output}, inputs);
  const Material material = read_material(options.material);
  const Domain domain = domain_of(options);
  PlanSettings settings = options.quick ? PlanSettings::quick() : PlanSettings{};
  settings.bound_rms = options.rms;
  settings.compile.tolerance = options.terms_to;
  settings.seed = settings.timing.seed = options.seed;
  const Plan planned = [&] {
    ProgressLine line("plan", options.quiet);
    return plan(material, domain, options.tolerance, settings,
                [&line](const std::string& what) { line.show(what, 0, 0); });
  }();
  if (options.output) write_result(*options.output, to_json(planned.material));
  const bool material_is_out = options.output && is_stdout(*options.output);
  if (!material_is_out) to_stdout(options.json ? plan_json(planned) : plan_text(planned, stdout_style()));
  return 0;
}

}  // namespace

void add_plan(CLI::App& program, int& status) {
  const auto options = std::make_shared<Options>();
  CLI::App* command =
      program.add_subcommand("plan", "Find the cheapest effects and tiers that stay within a tolerance");
  command->add_option("INPUT", options->material, "material JSON, or a scene (.toml): all of its materials")
      ->type_name("")
      ->required();
  command
      ->add_option(
          "--tolerance", options->tolerance,
          "largest L1 error at any incidence angle and in any channel, such as 0.01; of a scene the relative RMS "
          "error of its picture over lit pixels")
      ->type_name("PART")
      ->required();
  command->add_option("--scan", options->scan, "take angles, wavelengths and solid angle from this scan")
      ->type_name("FILE");
  command->add_option("--theta-i", options->theta_i, "incidence angles from, to (0,80)")->type_name("A,B");
  command->add_option("--max-theta", options->max_theta, "largest angle of incidence and of viewing that matters")
      ->type_name("DEG");
  command->add_option("--wavelengths", options->wavelengths, "channels that matter, in um (all)")->type_name("LIST");
  command->add_option("--solid-angle", options->solid_angle, "of the source, in sr (the material's)")->type_name("SR");
  command
      ->add_option("-o,--output", options->output,
                   "write the planned material here; of a scene the plan as JSON, with its materials")
      ->type_name("FILE");
  command
      ->add_option("--terms-to", options->terms_to,
                   "relative error that terms are compiled to where the plan will be used (0, or 1e-9 and more)")
      ->type_name("E");
  command->add_option("--seed", options->seed, "of the directions")->type_name("INTEGER")->capture_default_str();
  command->add_flag("--rms", options->rms, "hold the RMS relative error to the tolerance too: dark directions count");
  command->add_flag("--quick", options->quick, "few rounds and directions: for trying out");
  command->add_flag("--json", options->json, "the plan as JSON");
  command->add_flag("-q,--quiet", options->quiet, "no progress on standard error");
  command->footer(
      "The error is against the most exact terms that the material has the parameters for, with its own coefficients.\n"
      "Example:\n  goniofit plan fits/laser_paper_73.json --tolerance 0.01 --max-theta 75 -o planned.json\n"
      "  goniofit plan data/scenes/five_materials.toml --tolerance 0.01");
  command->callback([options, &status] { status = run(*options); });
}

}  // namespace goniofit::cli
