#pragma once
// The drawing program behind the plots.

#include <filesystem>
#include <string>

namespace goniofit {

/// `text` as a gnuplot string constant. Single quotes: no backquote command, no escape and no variable is evaluated in
/// it. Control characters become blanks.
[[nodiscard]] std::string gnuplot_quoted(const std::string& text);

/// Whether a plot goes to a PNG file; else it is an SVG. Throws Error (bad_input) for any other extension, in any case
/// of its letters.
[[nodiscard]] bool is_png(const std::filesystem::path& path);

/// Runs gnuplot on `script`, whose terminal writes to standard output, into `output`. No shell is involved and the
/// user's start-up files are not read. Throws Error (system) with what gnuplot said when it is missing or fails.
void run_gnuplot(const std::string& script, const std::filesystem::path& output);

}  // namespace goniofit
