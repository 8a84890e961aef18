#pragma once
// Runs a program as a user does: arguments in, standard output, standard error and exit status out. No shell.

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/paths.h"

namespace goniofit::test {

[[nodiscard]] inline std::string slurp(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error("no file " + path.string());
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

inline void spit(const std::filesystem::path& path, const std::string& content) {
  std::ofstream out(path, std::ios::binary);
  out << content;
  out.close();
  if (!out) throw std::runtime_error("cannot write " + path.string());
}

struct Outcome {
  int status = -1;  ///< the exit status; 128 + the signal's number where one ended the program
  std::string out, err;
};

struct RunOptions {
  std::filesystem::path folder = ".";                  ///< working directory
  std::vector<std::string> environment = {};           ///< "NAME=value", added to the test's own
  std::filesystem::path stdout_path = {};              ///< where standard output goes instead (/dev/full)
  std::optional<std::size_t> largest_file_bytes = {};  ///< RLIMIT_FSIZE: what a full disk looks like
  std::optional<std::size_t> memory_bytes = {};        ///< RLIMIT_AS
};

namespace detail {

inline void limit(int resource, const std::optional<std::size_t>& bytes) {
  if (!bytes) return;
  const rlimit value{*bytes, *bytes};
  if (::setrlimit(static_cast<__rlimit_resource_t>(resource), &value) != 0) ::_exit(126);
}

inline void redirect(int descriptor, const char* path, int flags) {
  const int opened = ::open(path, flags, 0600);
  if (opened < 0 || ::dup2(opened, descriptor) < 0) ::_exit(126);
}

}  // namespace detail

[[nodiscard]] inline Outcome run(const std::vector<std::string>& arguments, const RunOptions& options = {}) {
  const ScratchDir scratch;
  const std::filesystem::path out = options.stdout_path.empty() ? scratch / "out" : options.stdout_path;
  const std::filesystem::path err = scratch / "err";
  std::vector<std::string> words = arguments;
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  std::vector<std::string> variables = options.environment;

  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("cannot fork");
  if (child == 0) {
    for (std::string& variable : variables) ::putenv(variable.data());
    if (::chdir(options.folder.c_str()) != 0) ::_exit(126);
    detail::redirect(STDIN_FILENO, "/dev/null", O_RDONLY);
    detail::redirect(STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT);
    detail::redirect(STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT);
    detail::limit(RLIMIT_FSIZE, options.largest_file_bytes);
    detail::limit(RLIMIT_AS, options.memory_bytes);
    ::execvp(argv[0], argv.data());
    ::_exit(127);
  }
  int status = 0;
  if (::waitpid(child, &status, 0) != child) throw std::runtime_error("cannot wait for " + words.front());
  Outcome outcome;
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  if (options.stdout_path.empty()) outcome.out = slurp(out);
  outcome.err = slurp(err);
  return outcome;
}

/// The program under test.
[[nodiscard]] inline Outcome goniofit(std::vector<std::string> arguments, const RunOptions& options = {}) {
  arguments.insert(arguments.begin(), GONIOFIT_PROGRAM);
  return run(arguments, options);
}

/// Every name in `folder`, hidden ones included: what a failed run must not add to.
[[nodiscard]] inline std::vector<std::string> names_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace goniofit::test
