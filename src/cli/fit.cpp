// goniofit fit: the main job.

#include "fit/fit.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/console.h"
#include "cli/fit_flags.h"
#include "cli/fit_inputs.h"
#include "cli/fit_outputs.h"
#include "cli/outputs.h"
#include "fit/comparison.h"
#include "io/exr_table.h"
#include "io/material_io.h"
#include "report/comparison_criteria_report.h"
#include "report/comparison_report.h"
#include "report/plot.h"
#include "support/error.h"
#include "support/text.h"

namespace goniofit::cli {
namespace {

using Path = std::filesystem::path;

struct Options {
  ScanOptions scan;
  Path output, table, exr;
  bool has_output = false;
  std::vector<Path> plots;
  std::string plot_axis = "auto";
  FitFlags flags;
  FitOutputs extra;
  std::optional<std::string> name;
  bool json = false, quiet = false;
};

PlotOptions plot_options(const Options& options) {
  PlotOptions plot;
  if (options.plot_axis == "linear") {
    plot.axis = PlotAxis::linear;
  } else if (options.plot_axis == "log") {
    plot.axis = PlotAxis::log;
  } else if (options.plot_axis != "auto") {
    throw usage_error("--plot-axis: " + in_quotes(options.plot_axis) + ", expected auto, linear or log");
  }
  return plot;
}

void check_usage(const Options& options, const Recipe& recipe) {
  const std::vector<Path> inputs = inputs_of(options.scan, options.flags, recipe);
  const bool material_on_stdout = options.has_output && is_stdout(options.output);
  if (material_on_stdout && options.json) {
    throw usage_error("--json: the report and the material (-o -) cannot both go to standard output");
  }
  for (const Path& plot : options.plots) {
    if (is_stdout(plot)) throw usage_error("--plot: a picture needs a file name ending in .svg or .png");
  }
  check_fit_outputs(options.extra);
  std::vector<Path> outputs = options.extra.files();
  outputs.insert(outputs.end(), {options.output, options.table, options.exr});
  outputs.insert(outputs.end(), options.plots.begin(), options.plots.end());
  check_outputs(outputs, inputs);
}

void write_outputs(const Options& options, const Recipe& recipe, const Scan& scan, const FitResult& result) {
  // First, since it is what may be refused.
  const auto table = options.exr.empty() ? std::nullopt : std::optional(tabulate(result.material));
  if (options.has_output && !is_stdout(options.output)) write_material(options.output, result.material);
  if (!options.table.empty()) write_result(options.table, to_csv({result.material}));
  if (table) write_exr(options.exr, result.material, *table);
  for (const Path& plot : options.plots) plot_fit(plot, scan, result.material, plot_options(options));
  draw_fit_outputs(options.extra, scan, result, named_inputs(options.scan, options.flags, recipe));
}

// The fit, and where `--model auto` chose it, what it was compared with.
struct Outcome {
  FitResult result;
  std::optional<Comparison> comparison;
};

// Leaves the settings of the model chosen. Profiles are its alone.
Outcome chosen_fit(const Options& options, const Scan& scan, FitSettings& asked) {
  FitSettings settings = asked;
  settings.model = surface_model;
  settings.profile.reset();
  const ModelList list = models_to_choose_from(scan, settings);
  ProgressLine progress("comparing", options.quiet);
  Outcome outcome;
  outcome.comparison = compare(
      scan, settings, list.models,
      [&](const std::string& model, std::size_t done, std::size_t total) { progress.show(model, done, total); });
  Comparison& comparison = *outcome.comparison;
  comparison.notes.insert(comparison.notes.begin(), list.notes.begin(), list.notes.end());
  const ComparedFit& chosen = *by_criteria(comparison).front();
  FitSettings own = settings_for_model(chosen.model, settings);
  own.profile = asked.profile;
  asked = own;
  outcome.result = own.profile ? fit(scan, own) : chosen.fit;
  outcome.result.notes.insert(outcome.result.notes.begin(), "model auto: " + comparison.verdict);
  return outcome;
}

std::string json_of(const Outcome& outcome, const Scan& scan) {
  const std::string report = fit_report_json(outcome.result, scan);
  if (!outcome.comparison) return report;
  auto json = nlohmann::ordered_json::parse(report);
  json["comparison"] = nlohmann::ordered_json::parse(comparison_json(*outcome.comparison, scan));
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
}

void print_result(const Options& options, const Scan& scan, const Outcome& outcome) {
  const FitResult& result = outcome.result;
  if (options.json) {
    to_stdout(json_of(outcome, scan));
  } else if (options.has_output && is_stdout(options.output)) {
    // Standard output is the material's: the report goes beside it.
    if (!options.quiet) std::cerr << fit_report(result, scan, {.color = false, .show_reflectance = true});
    to_stdout(to_json(result.material));
  } else {
    const std::string table =
        outcome.comparison ? comparison_report(*outcome.comparison, scan, stdout_style()) + '\n' : std::string();
    to_stdout(table + fit_report(result, scan, stdout_style()));
  }
}

// Whether some parameter is known to no better than a tenth: only then a report asks for more angles.
bool is_weak(const FitResult& result) {
  return std::any_of(result.parameters.begin(), result.parameters.end(), [](const FittedParameter& p) {
    return !p.derived && (!p.identifiable || (p.value && p.u && *p.u > 0.1 * std::fabs(*p.value)));
  });
}

int run(const Options& options) {
  const Recipe recipe = recipe_of(options.scan);
  check_usage(options, recipe);
  const PlotOptions plot = plot_options(options);
  const Scan scan = read_scans(options.scan, options.flags, recipe, options.name);
  for (const Path& path : options.plots) check_plot(path, scan, plot);
  FitFlags flags = options.flags;
  const bool choose = flags.model == "auto";
  if (choose) flags.model = surface_model;
  FitSettings settings = settings_of(flags, recipe, scan);
  apply_fit_outputs(options.extra, settings);
  Outcome outcome;
  if (choose) {
    outcome = chosen_fit(options, scan, settings);
  } else {
    const ProgressLine progress("fitting " + in_quotes(scan.name), options.quiet);
    outcome.result = fit(scan, settings);
  }
  FitResult& result = outcome.result;
  add_reflectance(result, scan);
  if (options.json || is_weak(result)) add_measurement_design(result, scan, settings);
  write_outputs(options, recipe, scan, result);
  print_result(options, scan, outcome);
  const bool described = !result.diagnostics || result.diagnostics->verdict != FitVerdict::fails;
  return result.converged && described ? 0 : static_cast<int>(ErrorKind::failed_result);
}

}  // namespace

void add_fit(CLI::App& program, int& status) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("fit", "Fit the model to scans and report on the fit");
  add_scan_options(*command, options->scan);
  CLI::Option* output =
      command->add_option("-o,--output", options->output, "the material as JSON ('-': standard output)")
          ->type_name("FILE");
  command->add_option("--plot", options->plots, "measured and fitted, .svg or .png; may be repeated")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command->add_option("--plot-axis", options->plot_axis, "auto, linear or log")->type_name("AXIS");
  command->add_option("--table", options->table, "the parameters as a CSV table")->type_name("FILE");
  command->add_option("--exr", options->exr, "the fitted BRDF tabulated in OpenEXR")->type_name("FILE");
  command->add_option("--name", options->name, "name of the material, instead of the scan's")->type_name("NAME");
  command->add_flag("--json", options->json, "the report as JSON");
  command->add_flag("-q,--quiet", options->quiet, "no progress on standard error");
  add_model_flag(*command, options->flags);
  add_fit_flags(*command, options->flags);
  add_fit_outputs(*command, options->extra);
  command->footer(
      "Example:\n  goniofit fit data/garnet_red_paint_13.csv --n 1.7 --components dd,uds,fs -o garnet.json --plot "
      "garnet.svg\n  goniofit fit data/garnet_red_paint_13.csv --profile slope,R.k_fs --profile-plot profiles.svg "
      "--residual-plot residuals.svg --report garnet.html");
  command->callback([options, output, &status] {
    options->has_output = output->count() > 0;
    status = run(*options);
  });
}

}  // namespace goniofit::cli
