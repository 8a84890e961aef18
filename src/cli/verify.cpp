// goniofit verify: simulate, fit, compare.

#include "synthetic/verify.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "cli/commands.h"
#include "cli/console.h"
#include "cli/outputs.h"
#include "cli/selection_study_table.h"
#include "io/recipe_io.h"
#include "report/gnuplot.h"
#include "report/verify_report.h"
#include "support/error.h"

namespace goniofit::cli {
namespace {

struct Options {
  std::vector<std::filesystem::path> recipes;
  std::optional<std::size_t> trials;
  std::size_t random = 0, starts = 0, selection = 0, threads = 0;
  std::optional<std::uint64_t> seed;
  double level = default_level;
  std::vector<std::filesystem::path> plots;
  std::optional<std::filesystem::path> markdown;
  bool json = false, quiet = false;
};

std::vector<Recipe> read_recipes(const Options& options) {
  std::vector<Recipe> recipes;
  for (const std::filesystem::path& path : options.recipes) {
    recipes.push_back(read_recipe(path));
    if (!recipes.back().verify) {
      throw key_error(path.string(), "/verify", "missing, expected the truth to simulate and the bounds to meet");
    }
  }
  return recipes;
}

// A study of its own, hence alone.
int run_selection(const Options& options) {
  if (!options.recipes.empty() || options.random > 0)
    throw usage_error("--selection: expected without recipes and --random");
  const SelectionStudy study = [&] {
    ProgressLine progress("verify", options.quiet);
    return verify_selection(
        options.selection, options.seed.value_or(1),
        [&progress](std::size_t done, std::size_t total) { progress.show("choices", done, total); });
  }();
  to_stdout(options.json ? selection_study_json(study) : selection_study_text(study, stdout_style()));
  return study.passed() ? 0 : static_cast<int>(ErrorKind::failed_result);
}

// All that could fail for a slip of the user's is looked at before the trials, which may take an hour.
void check(const Options& options, const std::vector<Recipe>& recipes) {
  if (options.recipes.empty() && options.random == 0)
    throw usage_error("nothing to verify: name a recipe, or --random N, or --selection N");
  if (options.trials && *options.trials == 0) throw usage_error("--trials: expected 1 or more");
  if (!(options.level > 0.0 && options.level < 1.0)) throw usage_error("--level: expected a number between 0 and 1");
  if (options.recipes.empty() && !options.plots.empty()) throw usage_error("--plot: there is no recipe to draw");
  for (const std::filesystem::path& plot : options.plots) (void)is_png(plot);
  std::vector<std::filesystem::path> outputs = options.plots;
  if (options.markdown) outputs.push_back(*options.markdown);
  std::vector<std::filesystem::path> inputs = options.recipes;
  for (const Recipe& recipe : recipes) inputs.push_back(recipe.verify->truth);
  check_outputs(outputs, inputs);
}

int run(const Options& options) {
  if (options.selection > 0) return run_selection(options);
  // All are read first: a slip in the last recipe shall not cost the trials of those before it.
  const std::vector<Recipe> recipes = read_recipes(options);
  check(options, recipes);
  std::vector<VerifyReport> reports;
  std::optional<RandomRecoveryReport> random;
  {
    ProgressLine line("verify", options.quiet);
    for (const Recipe& recipe : recipes) {
      const std::string name = recipe.source.filename().string();
      const auto progress = [&](std::size_t done, std::size_t total) { line.show(name, done, total); };
      reports.push_back(verify_recipe(recipe, options.trials.value_or(0), options.seed.value_or(recipe.seed),
                                      {.threads = options.threads, .progress = progress}));
    }
    if (options.random > 0) {
      const auto progress = [&](std::size_t done, std::size_t total) { line.show("random materials", done, total); };
      random = verify_random(options.random, options.seed.value_or(1), options.starts, progress);
    }
  }
  judge(reports, options.level);
  const VerifyRunReport run{reports, random ? &*random : nullptr, options.level};
  for (const std::filesystem::path& plot : options.plots) plot_verify(plot, run);
  if (options.markdown) write_result(*options.markdown, verify_markdown(run));
  to_stdout(options.json ? verify_json(run) : verify_text(run, stdout_style()));
  return run.passed() ? 0 : static_cast<int>(ErrorKind::failed_result);
}

}  // namespace

void add_verify(CLI::App& program, int& status) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("verify", "Simulate, fit and compare: bias, spread and coverage");
  command->add_option("RECIPE", options->recipes, "recipes with a [verify] table")->type_name("");
  command->add_option("--trials", options->trials, "instead of the recipe's number")->type_name("N");
  command->add_option("--random", options->random, "recover this many random materials")->type_name("N");
  command->add_option("--starts", options->starts, "with --random: random starts of the polish alone, a material")
      ->type_name("N");
  command->add_option("--selection", options->selection, "choose the components of this many random scans")
      ->type_name("N");
  command->add_option("--seed", options->seed, "instead of the recipe's (1 for --random)")->type_name("INTEGER");
  command
      ->add_option("--threads", options->threads, "threads (all of the machine's by default); the result is the same")
      ->type_name("N");
  command
      ->add_option("--level", options->level,
                   "probability of blaming a fitter that meets all its bounds, over the whole run (0.05)")
      ->type_name("P");
  command->add_option("--plot", options->plots, "coverages against their bounds, .svg or .png; may be repeated")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command->add_option("--markdown", options->markdown, "a table with a row a recipe, and the bounds missed")
      ->type_name("FILE");
  command->add_flag("--json", options->json, "the tables as JSON");
  command->add_flag("-q,--quiet", options->quiet, "no progress on standard error");
  command->footer(
      "A bound is missed where exact binomial tests refute it, corrected (Holm) for the number of tests in the run; "
      "the\n"
      "slope's mean is held to slope_bias as it is. Exit status 1 where a bound is missed.\n"
      "Example:\n  goniofit verify fits/garnet_red_paint_13.toml fits/coverage/*.toml --trials 500 --plot "
      "coverage.svg");
  command->callback([options, &status] { status = run(*options); });
}

}  // namespace goniofit::cli
