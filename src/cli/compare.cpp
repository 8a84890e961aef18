// goniofit compare: the paper's comparison of models on one scan.

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/console.h"
#include "cli/fit_flags.h"
#include "cli/fit_inputs.h"
#include "cli/number_arguments.h"
#include "cli/outputs.h"
#include "fit/comparison.h"
#include "report/comparison_report.h"
#include "support/error.h"

namespace goniofit::cli {
namespace {

struct Options {
  ScanOptions scan;
  FitFlags flags;
  std::optional<std::string> models;
  std::vector<std::filesystem::path> plots;
  bool json = false, quiet = false;
};

void check_plots(const std::vector<std::filesystem::path>& plots) {
  for (const std::filesystem::path& plot : plots) {
    const std::string extension = plot.extension().string();
    if (extension != ".svg" && extension != ".png") {
      throw usage_error("--plot: a picture needs a file name ending in .svg or .png");
    }
  }
}

Comparison compared(const Options& options, const Scan& scan, const FitSettings& settings) {
  ModelList list;
  if (options.models) {
    list.models = parse_words(*options.models, "--models");
  } else {
    list = default_models(scan, settings);
  }
  ProgressLine progress("comparing", options.quiet);
  Comparison comparison =
      compare(scan, settings, list.models, [&progress](const std::string& model, std::size_t done, std::size_t total) {
        progress.show(model, done, total);
      });
  comparison.notes.insert(comparison.notes.begin(), list.notes.begin(), list.notes.end());
  return comparison;
}

int run(const Options& options) {
  const Recipe recipe = recipe_of(options.scan);
  check_plots(options.plots);
  check_outputs(options.plots, inputs_of(options.scan, options.flags, recipe));
  const Scan scan = read_scans(options.scan, options.flags, recipe);
  FitFlags flags = options.flags;
  flags.model = surface_model;  // a recipe's own model is one of many here
  const Comparison comparison = compared(options, scan, settings_of(flags, recipe, scan));
  for (const std::filesystem::path& plot : options.plots) plot_comparison(plot, comparison, scan);
  to_stdout(options.json ? comparison_json(comparison, scan) : comparison_report(comparison, scan, stdout_style()));
  const bool any_converged = std::any_of(comparison.rows.begin(), comparison.rows.end(),
                                         [](const ComparedFit& row) { return row.fit.converged; });
  return any_converged ? 0 : static_cast<int>(ErrorKind::failed_result);
}

}  // namespace

void add_compare(CLI::App& program, int& status) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("compare", "Fit a scan with one model after the other");
  add_scan_options(*command, options->scan);
  command
      ->add_option(
          "--models", options->models,
          "names of `goniofit models`, oren-nayar, li-torrance, li-torrance-student-t, he-torrance, or effects "
          "such as rough+dd (all of them by default)")
      ->type_name("LIST");
  command->add_option("--plot", options->plots, "a bar a model, .svg or .png; may be repeated")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command->add_flag("--json", options->json, "the table as JSON");
  command->add_flag("-q,--quiet", options->quiet, "no progress on standard error");
  add_fit_flags(*command, options->flags);
  command->footer(
      "--components and --anisotropic are those of the Li-Torrance models, the terms those of models named by their "
      "effects.\n"
      "Example:\n  goniofit compare data/garnet_red_paint_13.csv --n 1.7 --models lambert,ward,ggx,li-torrance");
  command->callback([options, &status] { status = run(*options); });
}

}  // namespace goniofit::cli
