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
#include "cli/selection_study_table.h"
#include "cli/verify_table.h"
#include "io/recipe_io.h"
#include "support/error.h"

namespace goniofit::cli {
namespace {

struct Options {
  std::vector<std::filesystem::path> recipes;
  std::optional<std::size_t> trials;
  std::size_t random = 0, starts = 0, selection = 0;
  std::optional<std::uint64_t> seed;
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

void print(const std::vector<VerifyReport>& reports, const std::optional<RandomRecoveryReport>& random, bool json) {
  if (json) {
    to_stdout(verify_json(reports, random ? &*random : nullptr));
    return;
  }
  const ReportStyle style = stdout_style();
  std::string text;
  for (const VerifyReport& report : reports) text += verify_table(report, style) + '\n';
  if (random) text += random_recovery_text(*random, style);
  to_stdout(text);
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

int run(const Options& options) {
  if (options.selection > 0) return run_selection(options);
  if (options.recipes.empty() && options.random == 0)
    throw usage_error("nothing to verify: name a recipe, or --random N, or --selection N");
  if (options.trials && *options.trials == 0) throw usage_error("--trials: expected 1 or more");
  // All are read first: a slip in the last recipe shall not cost the trials of those before it.
  const std::vector<Recipe> recipes = read_recipes(options);
  std::vector<VerifyReport> reports;
  std::optional<RandomRecoveryReport> random;
  {
    const std::size_t parts = recipes.size() + (options.random > 0 ? 1 : 0);
    ProgressLine progress("verify", options.quiet);
    for (const Recipe& recipe : recipes) {
      progress.show(recipe.source.filename().string(), reports.size(), parts);
      reports.push_back(verify_recipe(recipe, options.trials.value_or(0), options.seed.value_or(recipe.seed)));
    }
    if (options.random > 0) {
      progress.show("random materials", reports.size(), parts);
      random = verify_random(options.random, options.seed.value_or(1), options.starts);
    }
  }
  print(reports, random, options.json);
  const bool good = std::all_of(reports.begin(), reports.end(), [](const VerifyReport& r) { return passed(r); }) &&
                    (!random || passed(*random));
  return good ? 0 : static_cast<int>(ErrorKind::failed_result);
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
  command->add_flag("--json", options->json, "the tables as JSON");
  command->add_flag("-q,--quiet", options->quiet, "no progress on standard error");
  command->footer(
      "Exit status 1 where a bound is missed.\n"
      "Example:\n  goniofit verify fits/garnet_red_paint_13.toml --trials 200");
  command->callback([options, &status] { status = run(*options); });
}

}  // namespace goniofit::cli
