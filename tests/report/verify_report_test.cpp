#include "report/verify_report.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "support/error.h"
#include "support/error_message.h"
#include "support/paths.h"

namespace goniofit {
namespace {

Recovery recovery(const std::string& name, double truth, Proportion in_68, Proportion in_95) {
  Recovery r;
  r.parameter = name;
  r.truth = truth;
  r.determined = 100;
  r.mean = truth + 0.001;
  r.bias = 0.001;
  r.bias_error = 0.0005;
  r.spread = 0.005;
  r.stated_u = 100;
  r.mean_u = 0.005;
  r.coverage_68 = in_68;
  r.coverage_95 = in_95;
  return r;
}

/// Two recipes: one sound, one whose k_dd is overconfident in both channels and whose k_uds states little.
std::vector<VerifyReport> reports() {
  std::vector<VerifyReport> run(2);
  run[0].name = "sound";
  run[0].seed = 7;
  run[0].trials = 100;
  run[0].settings.slope_bias = 0.02;
  run[0].settings.coverage_68 = {0.64, 0.73};
  run[0].settings.coverage_95 = {0.93, 0.97};
  run[1] = run[0];
  run[1].name = "over|confident";
  run[1].settings.known_noise = true;
  run[1].settings.noise = {0.02, 0.001};
  run[0].parameters = {recovery("slope", 0.1, {68, 100}, {95, 100})};
  run[1].parameters = {recovery("slope", 0.1, {69, 100}, {96, 100}), recovery("R.k_dd", 0.5, {40, 100}, {70, 100}),
                       recovery("G.k_dd", 0.6, {70, 100}, {72, 100}), recovery("R.k_uds", 0.0, {2, 3}, {3, 3})};
  run[1].undetermined = {"sigma_um"};
  judge(run);
  return run;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST(VerifyText, HasARowAParameterAndTheMissesInWords) {
  const std::vector<VerifyReport> run = reports();
  const std::string text = verify_text({run}, {});
  EXPECT_NE(text.find("sound: 100 trials (seed 7), 0 failed (at most 3 %)"), std::string::npos) << text;
  EXPECT_NE(text.find("0.00100 ± 0.00050"), std::string::npos) << text;
  EXPECT_NE(text.find("95.0 % (88.7–98.4)"), std::string::npos) << text;
  EXPECT_NE(text.find("3 of 100"), std::string::npos) << text;
  EXPECT_NE(text.find("never determined: sigma_um"), std::string::npos) << text;
  EXPECT_NE(text.find("G.k_dd: the 95 % intervals contain the truth in 72.0 %"), std::string::npos) << text;
  EXPECT_NE(text.find("3 of 12 tests missed at 5 %"), std::string::npos) << text;
  EXPECT_EQ(count(text, "passed"), 1U);
  EXPECT_EQ(count(text, "FAILED"), 1U);
}

TEST(VerifyJson, HoldsEveryCheck) {
  const std::vector<VerifyReport> run = reports();
  const auto json = nlohmann::json::parse(verify_json({run, nullptr, 0.05}));
  EXPECT_FALSE(json.at("passed"));
  EXPECT_EQ(json.at("tests"), 12);
  EXPECT_TRUE(json.at("recipes").at(0).at("passed"));
  const auto& bad = json.at("recipes").at(1);
  EXPECT_TRUE(bad.at("noise").at("known"));
  EXPECT_EQ(bad.at("undetermined").at(0), "sigma_um");
  EXPECT_EQ(bad.at("checks").size(), 10U);  // the slope's bias, four parameters' coverages, failures
  const auto& k_dd = bad.at("parameters").at(1);
  EXPECT_EQ(k_dd.at("coverage_95"), 0.70);
  EXPECT_NEAR(k_dd.at("coverage_95_limits").at(0), 0.600, 5e-4);
  EXPECT_EQ(k_dd.at("stated"), 100);
  std::size_t missed = 0;
  for (const auto& check : bad.at("checks")) missed += check.at("missed") ? 1U : 0U;
  EXPECT_EQ(missed, 3U);
  EXPECT_TRUE(bad.at("checks").at(0).at("p").is_null());  // slope_bias is no test
}

TEST(VerifyMarkdown, PutsTheChannelsOfAMissTogether) {
  const std::vector<VerifyReport> run = reports();
  const std::string text = verify_markdown({run});
  EXPECT_NE(text.find("| sound | hemisphere, 2 % | 0 of 100 | "), std::string::npos) << text;
  EXPECT_NE(text.find("| over\\|confident | hemisphere, 2 % + 0.001 sr⁻¹, u known |"), std::string::npos) << text;
  EXPECT_NE(text.find("| 3 (R.k_uds) | 3 of "), std::string::npos) << text;
  EXPECT_NE(text.find("| all | 0 of "), std::string::npos) << text;
  EXPECT_NE(text.find("| k_dd of R, G: coverage_95 | 70.0 to 72.0 % | 93.0 to 97.0 % |"), std::string::npos) << text;
  EXPECT_NE(text.find("| k_dd of R: coverage_68 | 40.0 % | 64.0 to 73.0 % |"), std::string::npos) << text;
}

TEST(VerifyMarkdown, OfASoundRunHasNoSecondTable) {
  const std::vector<VerifyReport> run = reports();
  std::vector<VerifyReport> sound{run[0]};
  judge(sound);
  EXPECT_EQ(verify_markdown({sound}).find("what misses"), std::string::npos);
  EXPECT_TRUE((VerifyRunReport{sound}).passed());
  const RandomRecoveryReport wrong{.materials = 1, .wrong_minima = 1, .failures = {}};
  EXPECT_FALSE((VerifyRunReport{sound, &wrong}).passed());
  EXPECT_NE(verify_markdown({{}, &wrong}).find("Random materials: 1 of 1 in a wrong minimum"), std::string::npos);
}

std::string content(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

TEST(PlotVerify, DrawsEveryRecipeAndMarksWhatMisses) {
  const test::ScratchDir scratch;
  const std::vector<VerifyReport> run = reports();
  plot_verify(scratch / "c.svg", {run});
  const std::string svg = content(scratch / "c.svg");
  for (const char* text : {"sound", "over|confident", "slope", "k_dd", "k_uds", "3 of 12 tests"}) {
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  }
  EXPECT_NE(svg.find("213,  94,   0"), std::string::npos) << "nothing is drawn in orange";
  plot_verify(scratch / "c.png", {run});
  EXPECT_EQ(content(scratch / "c.png").substr(1, 3), "PNG");
}

TEST(PlotVerify, RefusesWhatItCannotDraw) {
  std::vector<VerifyReport> empty(1);
  EXPECT_THROW(plot_verify("c.svg", {empty}), Error);
  EXPECT_THROW(plot_verify("c.pdf", {reports()}), Error);
}

}  // namespace
}  // namespace goniofit
