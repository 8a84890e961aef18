#pragma once
// Recipes: everything a fit needs beside the scan, so that a fit can be repeated (TOML).

#include <filesystem>
#include <string>
#include <string_view>

#include "../fit/settings.h"

namespace goniofit {

/// Throws Error (bad_input): "FILE: /parameters/k_fs: ..." by key, "FILE:LINE: ..." for syntax. Paths in the result are
/// resolved against the recipe's folder.
[[nodiscard]] Recipe read_recipe(const std::filesystem::path& path);
[[nodiscard]] Recipe parse_recipe(std::string_view toml, const std::string& source);

}  // namespace goniofit
