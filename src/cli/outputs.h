#pragma once
// Where results go, and what they must not overwrite.

#include <filesystem>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

namespace goniofit::cli {

/// Absent and "-" are standard output.
[[nodiscard]] bool is_stdout(const std::filesystem::path& output);

/// To be called before the work starts. Throws Error: bad_input when an output is one of the inputs or two outputs are
/// one file; system when an output's folder is missing or the output is a folder.
void check_outputs(const std::vector<std::filesystem::path>& outputs, const std::vector<std::filesystem::path>& inputs);

/// Writes whole or not at all, or to standard output. Throws Error (system).
void write_result(const std::filesystem::path& output, const std::function<void(std::ostream&)>& write);
void write_result(const std::filesystem::path& output, const std::string& text);

}  // namespace goniofit::cli
