#include "cli/fit_inputs.h"

#include <utility>

#include "io/recipe_io.h"
#include "io/scan_reader.h"
#include "support/error.h"

namespace goniofit::cli {

void add_scan_options(CLI::App& command, ScanOptions& options) {
  command.add_option("SCAN", options.scans, "scan CSV; the readings of several are fitted together")->type_name("");
  command.add_option("--recipe", options.recipe, "settings from a TOML file; flags win over it")->type_name("FILE");
  command.add_flag("--ignore-columns", options.ignore_columns, "skip columns that are no angle and no channel");
}

Recipe recipe_of(const ScanOptions& options) { return options.recipe ? read_recipe(*options.recipe) : Recipe{}; }

std::vector<std::filesystem::path> scans_of(const ScanOptions& options, const Recipe& recipe) {
  std::vector<std::filesystem::path> paths = options.scans.empty() ? recipe.scans : options.scans;
  if (paths.empty()) throw usage_error("no scan: name one, or a recipe that does (--recipe)");
  return paths;
}

NamedFiles named_inputs(const ScanOptions& options, const FitFlags& flags, const Recipe& recipe) {
  NamedFiles inputs;
  for (const std::filesystem::path& scan : scans_of(options, recipe)) inputs.emplace_back("scan", scan);
  if (options.recipe) inputs.emplace_back("recipe", *options.recipe);
  if (const auto constants = optical_constants_of(flags, recipe)) inputs.emplace_back("optical constants", *constants);
  if (const auto reflectances = reflectances_of(flags, recipe)) inputs.emplace_back("reflectances", *reflectances);
  return inputs;
}

std::vector<std::filesystem::path> inputs_of(const ScanOptions& options, const FitFlags& flags, const Recipe& recipe) {
  std::vector<std::filesystem::path> inputs;
  for (auto& [role, file] : named_inputs(options, flags, recipe)) inputs.push_back(std::move(file));
  return inputs;
}

Scan read_scans(const ScanOptions& options, const FitFlags& flags, const Recipe& recipe,
                const std::optional<std::string>& name) {
  std::vector<Scan> scans;
  for (const std::filesystem::path& path : scans_of(options, recipe)) {
    scans.push_back(read_scan(path, {.ignore_unknown_columns = options.ignore_columns}));
  }
  Scan scan = scans.size() == 1 ? std::move(scans.front()) : concatenate(scans);
  const std::vector<std::string> channels = channels_of(flags, recipe);
  if (!channels.empty()) scan = select_channels(scan, channels);
  if (name || !recipe.name.empty()) scan.name = name.value_or(recipe.name);
  return scan;
}

}  // namespace goniofit::cli
