#pragma once
// The [verify] table of a recipe: what to simulate, and the bounds that the fits have to meet.

#include <filesystem>

#include "../fit/settings.h"
#include "toml_value.h"

namespace goniofit {

/// Paths are resolved against the folder of `recipe`. Throws Error (bad_input).
[[nodiscard]] VerifySettings read_verify(const TomlValue& table, const std::filesystem::path& recipe);

}  // namespace goniofit
