// Replays what the fuzzer started from and what it once found: every file is read or refused with an Error, never
// anything else (an escaped exception or a crash fails the test).

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "fuzz/readers.h"
#include "support/paths.h"

namespace goniofit {
namespace {

class Corpus : public ::testing::TestWithParam<fuzz::Reader> {};

TEST_P(Corpus, IsReadOrRefused) {
  const std::filesystem::path folder = test::source_dir() / "tests" / "fuzz" / "corpus" / GetParam().name;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path());
  ASSERT_GE(files.size(), 4U) << "the seeds are missing";
  std::sort(files.begin(), files.end());
  for (const std::filesystem::path& file : files) {
    std::ifstream in(file, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    EXPECT_NO_THROW(GetParam().read(bytes)) << file;
    for (const std::size_t part : {bytes.size() / 2, bytes.size() - std::min<std::size_t>(bytes.size(), 1)}) {
      EXPECT_NO_THROW(GetParam().read(bytes.substr(0, part))) << file << " cut to " << part << " bytes";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Readers, Corpus, ::testing::ValuesIn(fuzz::readers),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace goniofit
