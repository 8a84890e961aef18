#pragma once
// Reading what `fit` and `compare` are asked to fit.

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../fit/settings.h"
#include "../scan/scan.h"
#include "fit_flags.h"

namespace goniofit::cli {

struct ScanOptions {
  std::vector<std::filesystem::path> scans;
  std::optional<std::filesystem::path> recipe;
  bool ignore_columns = false;
};
void add_scan_options(CLI::App& command, ScanOptions& options);

/// The recipe named, or an empty one.
[[nodiscard]] Recipe recipe_of(const ScanOptions& options);
/// The scans of the command line, else the recipe's. Throws Error (bad_input) where there are none.
[[nodiscard]] std::vector<std::filesystem::path> scans_of(const ScanOptions& options, const Recipe& recipe);
/// Every file that the command reads, with its role: "scan", "recipe", "optical constants", "reflectances".
using NamedFiles = std::vector<std::pair<std::string, std::filesystem::path>>;
[[nodiscard]] NamedFiles named_inputs(const ScanOptions& options, const FitFlags& flags, const Recipe& recipe);
/// The same without the roles: what none of the outputs may overwrite.
[[nodiscard]] std::vector<std::filesystem::path> inputs_of(const ScanOptions& options, const FitFlags& flags,
                                                           const Recipe& recipe);
/// The readings of all scans, their channels selected, under `name` or the recipe's.
[[nodiscard]] Scan read_scans(const ScanOptions& options, const FitFlags& flags, const Recipe& recipe,
                              const std::optional<std::string>& name = {});

}  // namespace goniofit::cli
