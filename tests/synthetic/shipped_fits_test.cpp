// What is under data/ and fits/ stays what the program makes of it; scripts/refit.sh makes it anew.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>

#include "fit/fit.h"
#include "io/material_io.h"
#include "io/recipe_io.h"
#include "io/scan_reader.h"
#include "support/paths.h"
#include "synthetic/simulate.h"

namespace goniofit {
namespace {

namespace fs = std::filesystem;

// In the order of fits/materials.csv.
const char* const samples[] = {"garnet_red_paint_13", "laser_paper_73", "ground_glass_41", "aluminium_coated_45"};

fs::path fits(const std::string& file) { return test::source_dir() / "fits" / file; }
fs::path data(const std::string& file) { return test::source_dir() / "data" / file; }

std::string text_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// The seed that the scan's own metadata name.
std::uint64_t seed_of(const Scan& scan) {
  const std::string flag = "--seed ";
  for (const auto& [key, value] : scan.metadata) {
    const std::size_t at = value.find(flag);
    if (key == "made_by" && at != std::string::npos) return std::stoull(value.substr(at + flag.size()));
  }
  throw std::runtime_error(scan.source + " does not say by which seed it was made");
}

void expect_same(const std::string& what, const std::optional<double>& now, const std::optional<double>& committed,
                 double relative) {
  ASSERT_EQ(now.has_value(), committed.has_value()) << what;
  if (!now) return;
  EXPECT_NEAR(*now, *committed, relative * std::fabs(*committed) + 1e-12) << what;
}

void expect_within(const std::string& what, const std::optional<double>& truth, const FittedParameter& p) {
  if (!truth || !p.value || !p.u) return;
  EXPECT_LT(std::fabs(*p.value - *truth), 4.0 * *p.u) << what;
}

class ShippedFit : public ::testing::TestWithParam<const char*> {
 protected:
  const std::string name_ = GetParam();
  const Recipe recipe_ = read_recipe(fits(name_ + ".toml"));
  const Material truth_ = read_material(fits(name_ + ".truth.json"));
  const Material committed_ = read_material(fits(name_ + ".json"));
};

TEST_P(ShippedFit, ScanIsTheSimulationOfItsTruth) {
  const fs::path path = data(name_ + ".csv");
  EXPECT_LT(fs::file_size(path), 300U * 1024U);
  const Scan committed = read_scan(path);
  ASSERT_TRUE(recipe_.verify);
  const Scan now = simulate(truth_, recipe_.verify->sampling, recipe_.verify->noise, seed_of(committed));

  ASSERT_EQ(committed.size(), now.size());
  ASSERT_EQ(committed.channels.size(), now.channels.size());
  EXPECT_EQ(committed.name, now.name);
  EXPECT_EQ(committed.geometry, now.geometry);
  EXPECT_EQ(committed.solid_angle_sr, now.solid_angle_sr);
  // Half a unit of the ninth digit, and 1e-9 between mathematical libraries.
  constexpr double relative = 5e-9 + 1e-9;
  for (std::size_t row = 0; row < now.size(); ++row) {
    ASSERT_NEAR(committed.theta_r_deg[row], now.theta_r_deg[row], relative * now.theta_r_deg[row]);
    ASSERT_NEAR(committed.phi_r_deg[row], now.phi_r_deg[row], relative * std::fabs(now.phi_r_deg[row]));
    for (std::size_t c = 0; c < now.channels.size(); ++c) {
      const double f = now.channels[c].values[row];
      ASSERT_NEAR(committed.channels[c].values[row], f, relative * std::fabs(f)) << "reading " << row;
    }
  }
}

TEST_P(ShippedFit, RefitsToTheCommittedMaterial) {
  ASSERT_EQ(recipe_.scans.size(), 1U);
  const Material now = fit(read_scan(recipe_.scans[0]), recipe_.settings).material;
  EXPECT_EQ(now.name, committed_.name);
  EXPECT_EQ(now.components, committed_.components);
  EXPECT_EQ(now.terms, committed_.terms);
  expect_same("slope", now.surface.slope, committed_.surface.slope, 1e-6);
  expect_same("sigma_um", now.surface.sigma_um, committed_.surface.sigma_um, 1e-6);
  expect_same("tau_um", now.surface.tau_um, committed_.surface.tau_um, 1e-6);
  ASSERT_EQ(now.channels.size(), committed_.channels.size());
  for (std::size_t c = 0; c < now.channels.size(); ++c) {
    EXPECT_EQ(now.channels[c].n, committed_.channels[c].n);
    EXPECT_EQ(now.channels[c].kappa, committed_.channels[c].kappa);
    for (const Coefficient k : all_coefficients) {
      expect_same(now.channels[c].name + "." + std::string(name_of(k)), now.channels[c].coefficient(k),
                  committed_.channels[c].coefficient(k), 1e-6);
    }
  }
  ASSERT_TRUE(now.fit && committed_.fit);
  EXPECT_TRUE(committed_.fit->converged);
  expect_same("loss", now.fit->loss, committed_.fit->loss, 1e-6);
  EXPECT_EQ(now.fit->samples, committed_.fit->samples);
  EXPECT_EQ(now.fit->identifiable, committed_.fit->identifiable);
  ASSERT_EQ(now.fit->shared_uncertainty.size(), committed_.fit->shared_uncertainty.size());
  for (const auto& [parameter, u] : committed_.fit->shared_uncertainty) {
    expect_same("u of " + parameter, now.fit->shared_uncertainty.at(parameter), u, 1e-4);
  }
}

TEST_P(ShippedFit, FindsTheTruthWithinItsUncertainty) {
  const FitResult result = fit(read_scan(recipe_.scans.at(0)), recipe_.settings);
  EXPECT_TRUE(result.converged);
  std::size_t stated = 0;
  for (const FittedParameter& p : result.parameters) {
    stated += p.u ? 1 : 0;
    if (p.name == "slope") expect_within(p.name, truth_.surface.slope, p);
    if (p.name == "sigma_um") expect_within(p.name, truth_.surface.sigma_um, p);
    if (p.name == "tau_um") expect_within(p.name, truth_.surface.tau_um, p);
    const std::optional<Coefficient> k = parse_name<Coefficient>(p.name);
    if (!k) continue;
    for (const MaterialChannel& channel : truth_.channels) {
      if (channel.name == p.channel) expect_within(p.channel + "." + p.name, channel.coefficient(*k), p);
    }
  }
  EXPECT_GE(stated, 2U);
}

INSTANTIATE_TEST_SUITE_P(Samples, ShippedFit, ::testing::ValuesIn(samples),
                         [](const auto& sample) { return std::string(sample.param); });

TEST(ShippedFits, TheTableIsThatOfTheCommittedMaterials) {
  std::vector<Material> materials;
  for (const char* sample : samples) materials.push_back(read_material(fits(std::string(sample) + ".json")));
  EXPECT_EQ(text_of(fits("materials.csv")), to_csv(materials));
}

TEST(ShippedFits, EveryRecipeIsChecked) {
  std::set<std::string> recipes;
  for (const fs::directory_entry& entry : fs::directory_iterator(fits(""))) {
    if (entry.path().extension() == ".toml") recipes.insert(entry.path().stem().string());
  }
  EXPECT_EQ(recipes, std::set<std::string>(std::begin(samples), std::end(samples)));
}

}  // namespace
}  // namespace goniofit
