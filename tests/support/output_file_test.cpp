#include "support/output_file.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "support/error.h"
#include "support/paths.h"

namespace goniofit {
namespace {

namespace fs = std::filesystem;
using test::ScratchDir;

std::string content_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

unsigned mode_of(const fs::path& path) { return static_cast<unsigned>(fs::status(path).permissions()); }

template <class F>
std::string system_message(F&& f) {
  try {
    f();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::system);
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

TEST(OutputFile, WritesAndReplacesTheWholeContent) {
  const ScratchDir dir;
  write_file(dir / "a.json", "a longer first content\n");
  EXPECT_EQ(content_of(dir / "a.json"), "a longer first content\n");
  write_file(dir / "a.json", std::string("short\0\n", 7));
  EXPECT_EQ(content_of(dir / "a.json"), std::string("short\0\n", 7));
  EXPECT_EQ(names_in(dir.path()), std::vector<std::string>{"a.json"});
}

TEST(OutputFile, WritesARelativePathIntoTheCurrentFolder) {
  const ScratchDir dir;
  const fs::path before = fs::current_path();
  fs::current_path(dir.path());
  write_file("here.txt", "x");
  fs::current_path(before);
  EXPECT_EQ(content_of(dir / "here.txt"), "x");
}

TEST(OutputFile, TheTemporaryHasTheExtensionAndStandsBesideTheTarget) {
  const ScratchDir dir;
  write_file(dir / "m.exr", "old");
  fs::path temporary;
  write_file_with(dir / "m.exr", [&](const fs::path& path) {
    temporary = path;
    EXPECT_EQ(content_of(dir / "m.exr"), "old") << "the earlier output stays until the new one is complete";
    std::ofstream(path) << "new";
  });
  EXPECT_EQ(temporary.extension(), ".exr");
  EXPECT_EQ(temporary.parent_path(), dir.path());
  EXPECT_EQ(content_of(dir / "m.exr"), "new");
  EXPECT_FALSE(fs::exists(temporary));
}

TEST(OutputFile, AnExceptionOfTheWriterPassesOnAndLeavesTheOldFile) {
  const ScratchDir dir;
  write_file(dir / "a", "old");
  EXPECT_THROW(write_stream(dir / "a",
                            [](std::ostream& out) {
                              out << "half";
                              throw usage_error("the fit failed");
                            }),
               Error);
  EXPECT_THROW(write_file_with(dir / "b", [](const fs::path&) { throw 42; }), int);
  EXPECT_EQ(content_of(dir / "a"), "old");
  EXPECT_EQ(names_in(dir.path()), std::vector<std::string>{"a"});
}

TEST(OutputFile, AMissingFolderIsASystemError) {
  const ScratchDir dir;
  const fs::path path = dir.path() / "none" / "a.json";
  EXPECT_EQ(system_message([&] { write_file(path, "x"); }),
            "cannot write " + path.string() + ": No such file or directory");
}

TEST(OutputFile, AFolderIsNotAFile) {
  const ScratchDir dir;
  EXPECT_EQ(system_message([&] { write_file(dir.path(), "x"); }),
            "cannot write " + dir.path().string() + ": Is a directory");
}

TEST(OutputFile, AWriterThatRemovesItsFileIsASystemError) {
  const ScratchDir dir;
  EXPECT_EQ(system_message([&] { write_file_with(dir / "a", [](const fs::path& path) { fs::remove(path); }); }),
            "cannot write " + (dir / "a").string() + ": No such file or directory");
  EXPECT_TRUE(names_in(dir.path()).empty());
}

TEST(OutputFile, KeepsThePermissionsOfWhatItReplaces) {
  const ScratchDir dir;
  write_file(dir / "a", "old");
  fs::permissions(dir / "a", fs::perms(0640));
  write_file(dir / "a", "new");
  EXPECT_EQ(mode_of(dir / "a"), 0640U);
}

TEST(OutputFile, ANewFileFollowsTheUmask) {
  const ScratchDir dir;
  const mode_t before = ::umask(027);
  write_file(dir / "a", "new");
  ::umask(before);
  EXPECT_EQ(mode_of(dir / "a"), 0640U);
}

TEST(OutputFile, WriteProtectedFilesAndFoldersStayAsTheyAre) {
  if (::geteuid() == 0) GTEST_SKIP() << "permissions do not stop the superuser";
  const ScratchDir dir;
  write_file(dir / "a", "old");
  fs::permissions(dir / "a", fs::perms(0444));
  EXPECT_EQ(system_message([&] { write_file(dir / "a", "new"); }),
            "cannot write " + (dir / "a").string() + ": Permission denied");
  EXPECT_EQ(content_of(dir / "a"), "old");
  fs::permissions(dir.path(), fs::perms(0555));
  const std::string message = system_message([&] { write_file(dir / "b", "new"); });
  fs::permissions(dir.path(), fs::perms(0755));
  EXPECT_EQ(message, "cannot write " + (dir / "b").string() + ": Permission denied");
}

TEST(OutputFile, WritesThroughASymbolicLink) {
  const ScratchDir dir;
  write_file(dir / "real", "old");
  fs::create_symlink("real", dir / "link");
  write_file(dir / "link", "new");
  EXPECT_TRUE(fs::is_symlink(dir / "link"));
  EXPECT_EQ(content_of(dir / "real"), "new");
}

TEST(OutputFile, ALongNameNeedsNoLongerTemporaryName) {
  const ScratchDir dir;
  const std::string name = std::string(250, 'n') + ".csv";
  write_file(dir / name, "x");
  EXPECT_EQ(content_of(dir / name), "x");
}

TEST(OutputFile, ADeviceIsWrittenIntoAndNotReplaced) {
  write_file("/dev/null", "x");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_EQ(system_message([] { write_file("/dev/full", "x"); }), "cannot write /dev/full: No space left on device");
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST(OutputFile, AFifoGetsTheContent) {
  const ScratchDir dir;
  ASSERT_EQ(::mkfifo((dir / "pipe").c_str(), 0600), 0);
  std::string received;
  std::thread reader([&] { received = content_of(dir / "pipe"); });
  const std::string content(200000, 'x');
  write_file(dir / "pipe", content);
  reader.join();
  EXPECT_EQ(received, content);
}

// The largest size of a file, for the time of a scope; the signal that goes with it is ignored so that write() fails.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    rlimit limited = before_;
    limited.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &limited);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  void (*handler_)(int);
  rlimit before_{};
};

TEST(OutputFile, AWriteThatFailsHalfwayLeavesTheOldFileAndNothingElse) {
  const ScratchDir dir;
  write_file(dir / "a", "old");
  std::string message;
  int rows = 0;
  {
    const FileSizeLimit limit(1 << 16);
    message = system_message([&] {
      write_stream(dir / "a", [&](std::ostream& out) {
        for (; rows < 100000; ++rows) out << "a line of some length " << 0.25 << '\n';
      });
    });
  }
  EXPECT_EQ(message, "cannot write " + (dir / "a").string() + ": File too large");
  EXPECT_LT(rows, 10000) << "the failure ends the work at once";
  EXPECT_EQ(content_of(dir / "a"), "old");
  EXPECT_EQ(names_in(dir.path()), std::vector<std::string>{"a"});
}

// Runs in a child with a mount namespace of its own: 0 passed, 1 failed, 77 no tmpfs may be mounted here.
int write_to_full_disk(const fs::path& folder) {
  if (::unshare(CLONE_NEWNS) != 0 || ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
      ::mount("none", folder.c_str(), "tmpfs", 0, "size=64k") != 0) {
    return 77;
  }
  write_file(folder / "a", "old");
  try {
    write_file(folder / "a", std::string(1 << 20, 'x'));
  } catch (const Error& error) {
    const std::string expected = "cannot write " + (folder / "a").string() + ": No space left on device";
    const bool right = error.what() == expected && error.kind() == ErrorKind::system;
    return right && content_of(folder / "a") == "old" && names_in(folder).size() == 1 ? 0 : 1;
  }
  return 1;
}

TEST(OutputFile, AFullDiskLeavesTheOldFileAndNothingElse) {
  const ScratchDir dir;
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) ::_exit(write_to_full_disk(dir.path()));
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == 77) GTEST_SKIP() << "no tmpfs can be mounted here";
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(OutputFile, ConcurrentWritersLeaveOneWholeContent) {
  const ScratchDir dir;
  std::vector<std::thread> writers;
  for (char letter = 'a'; letter < 'i'; ++letter) {
    writers.emplace_back([&, letter] {
      for (int i = 0; i < 10; ++i) write_file(dir / "out", std::string(100000, letter));
    });
  }
  for (std::thread& writer : writers) writer.join();
  const std::string content = content_of(dir / "out");
  ASSERT_EQ(content.size(), 100000U);
  EXPECT_EQ(content, std::string(100000, content.front()));
  EXPECT_EQ(names_in(dir.path()), std::vector<std::string>{"out"});
}

}  // namespace
}  // namespace goniofit
