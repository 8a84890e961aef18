#pragma once
// What the page of a report says of where it comes from.

#include <filesystem>
#include <string>
#include <vector>

#include "../report/page.h"

namespace goniofit::cli {

/// The program's arguments, for pages to repeat. Called once, before any command runs.
void remember_command(std::vector<std::string> arguments);

/// The command as a shell would take it, `page` itself as PAGE: the same command gives the same bytes whatever the page
/// is called.
[[nodiscard]] std::string command_text(const std::filesystem::path& page);

/// Versions, command and the inputs' names and hashes, each with its role. Throws Error (system) where one cannot be
/// read.
[[nodiscard]] PageSource page_source(const std::filesystem::path& page,
                                     const std::vector<std::pair<std::string, std::filesystem::path>>& inputs);

}  // namespace goniofit::cli
