#pragma once
// Where tests find things: the source tree, measured scans that may be absent, a scratch folder that goes away.

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace goniofit::test {

[[nodiscard]] inline std::filesystem::path source_dir() { return GONIOFIT_SOURCE_DIR; }

/// Measured scans and peers' values, from GONIOFIT_SHARED_DATA; nullopt where they are not there (skip, and say so).
[[nodiscard]] inline std::optional<std::filesystem::path> shared_data() {
  const char* chosen = std::getenv("GONIOFIT_SHARED_DATA");
  const std::filesystem::path path = chosen != nullptr ? chosen : GONIOFIT_DEFAULT_SHARED_DATA;
  if (!std::filesystem::is_directory(path)) return std::nullopt;
  return path;
}

/// A new folder under the system's temporary one, removed with everything in it at the end of the scope.
class ScratchDir {
 public:
  ScratchDir() {
    std::string name = (std::filesystem::temp_directory_path() / "goniofit-test-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~ScratchDir() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchDir(const ScratchDir&) = delete;
  ScratchDir& operator=(const ScratchDir&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

}  // namespace goniofit::test

#define GONIOFIT_SKIP_WITHOUT_SHARED_DATA() \
  if (!::goniofit::test::shared_data())     \
  GTEST_SKIP() << "measured scans are not here (set GONIOFIT_SHARED_DATA to their folder)"
