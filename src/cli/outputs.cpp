#include "cli/outputs.h"

#include <system_error>

#include "cli/console.h"
#include "support/error.h"
#include "support/output_file.h"

namespace goniofit::cli {

namespace fs = std::filesystem;

namespace {

// Through links, relative paths and names of files that do not exist yet. Devices are nobody's input to protect.
bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code ignored;
  if (fs::exists(a, ignored) && !fs::is_regular_file(a, ignored)) return false;
  if (fs::equivalent(a, b, ignored)) return true;
  const fs::path canonical_a = fs::weakly_canonical(fs::absolute(a, ignored), ignored);
  const fs::path canonical_b = fs::weakly_canonical(fs::absolute(b, ignored), ignored);
  return !canonical_a.empty() && canonical_a == canonical_b;
}

void check_folder(const fs::path& output) {
  std::error_code ignored;
  const fs::path folder = output.has_parent_path() ? output.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, ignored)) {
    throw system_error("cannot write " + output.string() + ": there is no folder " + folder.string());
  }
  if (fs::is_directory(output, ignored)) throw system_error("cannot write " + output.string() + ": it is a folder");
}

}  // namespace

bool is_stdout(const fs::path& output) { return output.empty() || output == "-"; }

void check_outputs(const std::vector<fs::path>& outputs, const std::vector<fs::path>& inputs) {
  for (auto output = outputs.begin(); output != outputs.end(); ++output) {
    if (is_stdout(*output)) continue;
    for (const fs::path& input : inputs) {
      if (same_file(*output, input)) {
        throw usage_error(output->string() +
                          ": is an input of this command and would be overwritten; name another output");
      }
    }
    for (auto other = outputs.begin(); other != output; ++other) {
      if (!is_stdout(*other) && same_file(*output, *other)) {
        throw usage_error(output->string() + ": two outputs have this name; give each its own");
      }
    }
    check_folder(*output);
  }
}

void write_result(const fs::path& output, const std::function<void(std::ostream&)>& write) {
  if (is_stdout(output)) {
    to_stdout(write);
  } else {
    write_stream(output, write);
  }
}

void write_result(const fs::path& output, const std::string& text) {
  write_result(output, [&text](std::ostream& out) { out << text; });
}

}  // namespace goniofit::cli
