#pragma once
// Outputs that are either whole or not there: written to a temporary file beside the target, renamed when complete.

#include <filesystem>
#include <functional>
#include <ostream>
#include <string>
#include <string_view>

namespace goniofit {

/// Writes `content` to `path` by way of a temporary file in the same folder and a rename. Whatever stood at `path`
/// stays untouched until the new content is complete and flushed to disk. Throws Error (system) and leaves nothing
/// behind when anything fails: missing folder, no permission, disk full.
void write_file(const std::filesystem::path& path, std::string_view content);

/// The same for writers that want a file name of their own (OpenEXR, gnuplot) or a stream too large for memory:
/// `write` gets the temporary path, which has the extension of `path`, and must have closed the file when it returns.
/// An exception from `write` removes the temporary file and passes on.
void write_file_with(const std::filesystem::path& path, const std::function<void(const std::filesystem::path&)>& write);

/// The same through a buffered stream whose state is checked at the end (a full disk becomes an Error).
void write_stream(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);

}  // namespace goniofit
