#include "report/gnuplot.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <system_error>

#include "support/error.h"

extern char** environ;  // POSIX has every program declare it itself

namespace goniofit {
namespace {

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "goniofit-plot-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
      throw system_error("cannot create a temporary folder " + name + ": " + std::strerror(errno));
    }
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] std::filesystem::path operator/(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

class FileActions {
 public:
  FileActions() { ::posix_spawn_file_actions_init(&actions_); }
  ~FileActions() { ::posix_spawn_file_actions_destroy(&actions_); }
  FileActions(const FileActions&) = delete;
  FileActions& operator=(const FileActions&) = delete;
  void open(int descriptor, const char* path, int flags) {
    constexpr mode_t readable = 0666;
    ::posix_spawn_file_actions_addopen(&actions_, descriptor, path, flags, readable);
  }
  [[nodiscard]] const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

std::string read_all(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

// What gnuplot says, in one line: its echo of the script and its marks left aside.
std::string complaint(const std::filesystem::path& stderr_path) {
  std::ifstream in(stderr_path);
  std::string line;
  std::string last;
  while (std::getline(in, line)) {
    if (line.find_first_not_of(" \t^") != std::string::npos) last = line;
  }
  // "/tmp/.../plot.gp" line 7: what is wrong; the file is gone by the time anyone could look.
  const std::size_t place = last.find("\" line ");
  if (place != std::string::npos) last.erase(0, place + 2);
  return last.empty() ? "it said nothing" : last;
}

int run_and_wait(const std::filesystem::path& script, const std::filesystem::path& output,
                 const std::filesystem::path& errors) {
  FileActions actions;
  actions.open(STDIN_FILENO, "/dev/null", O_RDONLY);
  actions.open(STDOUT_FILENO, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC);
  actions.open(STDERR_FILENO, errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC);
  std::string program = "gnuplot";
  std::string defaults = "-d";  // the user's start-up files stay out of it
  std::string script_name = script.string();
  std::array<char*, 4> arguments{program.data(), defaults.data(), script_name.data(), nullptr};
  pid_t child = 0;
  const int failed = ::posix_spawnp(&child, program.c_str(), actions.get(), nullptr, arguments.data(), environ);
  if (failed == ENOENT) throw system_error("cannot draw the plot: gnuplot is not installed, or not in PATH");
  if (failed != 0) throw system_error(std::string("cannot start gnuplot: ") + std::strerror(failed));
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) throw system_error(std::string("cannot wait for gnuplot: ") + std::strerror(errno));
  }
  return status;
}

// gnuplot does not report a full disk: a picture that lacks its end is one.
bool is_whole(const std::filesystem::path& output) {
  const std::string content = read_all(output);
  const std::string tail = content.substr(content.size() - std::min<std::size_t>(content.size(), 16));
  return tail.find("</svg>") != std::string::npos || tail.find("IEND") != std::string::npos;
}

}  // namespace

std::string gnuplot_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7F) {
      quoted += ' ';
    } else {
      quoted += c;
      if (c == '\'') quoted += c;
    }
  }
  return quoted + "'";
}

bool is_png(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension != ".png" && extension != ".svg") {
    throw usage_error(path.string() + ": a plot is written as .svg or .png, not as '" + extension + "'");
  }
  return extension == ".png";
}

void run_gnuplot(const std::string& script, const std::filesystem::path& output) {
  const TemporaryFolder folder;
  const std::filesystem::path script_path = folder / "plot.gp";
  const std::filesystem::path error_path = folder / "stderr";
  {
    std::ofstream out(script_path, std::ios::binary);
    out << script;
    out.close();
    if (!out) throw system_error("cannot write " + script_path.string() + ": " + std::strerror(errno));
  }
  const int status = run_and_wait(script_path, output, error_path);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw system_error("gnuplot failed to draw the plot: " + complaint(error_path));
  }
  if (!is_whole(output))
    throw system_error("cannot write " + output.string() + ": the plot is incomplete (disk full?)");
}

}  // namespace goniofit
