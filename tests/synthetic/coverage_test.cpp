// A short run of scripts/verify.sh: every shipped recipe and every coverage scenario on scans that nobody has seen.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "io/recipe_io.h"
#include "support/paths.h"
#include "synthetic/verify.h"

namespace goniofit {
namespace {

namespace fs = std::filesystem;

/// A fitter that meets its bounds is blamed by one run of all recipes with no more than this probability.
constexpr double false_alarms = 1e-4;

std::vector<std::string> shipped_recipes() {
  std::vector<std::string> names;
  for (const char* folder : {"fits", "fits/coverage"}) {
    for (const fs::directory_entry& entry : fs::directory_iterator(test::source_dir() / folder)) {
      if (entry.path().extension() == ".toml") names.push_back(folder + ("/" + entry.path().stem().string()));
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::uint64_t fresh_seed() {
  std::random_device device;
  return device();
}

// A scan of 31 channels has as many intervals to judge and takes its time; the paper's samples are scenarios too.
std::size_t trials_of(const fs::path& recipe) {
  if (recipe.stem() == "spectral_mixed_residuals") return 12;
  return recipe.parent_path().filename() == "coverage" ? 60 : 25;
}

class Coverage : public ::testing::TestWithParam<std::string> {};

TEST_P(Coverage, IsAsStated) {
  const Recipe recipe = read_recipe(test::source_dir() / (GetParam() + ".toml"));
  const std::uint64_t seed = fresh_seed();
  const std::size_t trials = trials_of(recipe.source);
  VerifyReport report = verify_recipe(recipe, trials, seed);
  judge({&report, 1}, false_alarms / static_cast<double>(shipped_recipes().size()));
  for (const std::string& missed : report.missed) ADD_FAILURE() << missed << "; seed " << seed;
  EXPECT_FALSE(report.parameters.empty());
  EXPECT_TRUE(recipe.verify->coverage_95);
}

INSTANTIATE_TEST_SUITE_P(Recipes, Coverage, ::testing::ValuesIn(shipped_recipes()), [](const auto& recipe) {
  std::string name = recipe.param;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return name;
});

// The four samples' own, and one for each scenario of fits/coverage/README.md.
TEST(CoverageScenarios, AreAllThere) { EXPECT_EQ(shipped_recipes().size(), 14U); }

}  // namespace
}  // namespace goniofit
