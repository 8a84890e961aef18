#include "report/fit_report.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "report/fit_rows.h"
#include "report/number_text.h"
#include "report/text_table.h"

namespace goniofit {
namespace {

using ::testing::Test;

constexpr double infinity = std::numeric_limits<double>::infinity();

FittedParameter parameter(const std::string& channel, const std::string& name, std::optional<double> value,
                          std::optional<double> u) {
  FittedParameter p;
  p.name = name;
  p.channel = channel;
  p.value = value;
  p.u = u;
  p.lower = 0.0;
  p.upper = 1.0;
  return p;
}

// A fit of `channels` bands in which every kind of parameter occurs.
struct Sample {
  FitResult result;
  Scan scan;

  explicit Sample(std::size_t channels) {
    scan.source = "dir/paint.csv";
    scan.name = "Paint";
    scan.theta_i_deg.assign(900, 30.0);
    Material& material = result.material;
    material.name = "Paint";
    material.components = {Effect::dd, Effect::uds, Effect::fs};
    material.surface.slope = 0.085374;
    result.parameters.push_back(parameter("", "slope", 0.085374, 0.000213));
    result.parameters.push_back(parameter("", "sigma_um", std::nullopt, std::nullopt));
    result.parameters.back().unit = "um";
    result.parameters.back().upper = infinity;
    for (std::size_t c = 0; c < channels; ++c) add_channel(std::to_string(400 + 10 * c) + "nm");
    for (const double theta : {10.0, 80.0}) {
      result.reflectance.push_back({theta, std::vector<double>(channels, theta > 50.0 ? 1.25 : 0.5)});
    }
    result.samples = 880;
    result.left_out.at_90 = 12;
    result.left_out.beyond_max_theta = 8;
    result.left_out.negative_values = 3;
    result.loss = 0.0125;
    result.rms = 0.0031;
    result.search_evaluations = 121;
    result.polish_starts = 3;
    result.polish_iterations = 27;
    result.seconds = 0.25;
    result.converged = true;
    result.components_were_auto = true;
    result.notes = {"auto: dd + uds + fs"};
    result.warnings = {"k_uds is on a bound; widen it with --bound"};
  }

  void add_channel(const std::string& name) {
    MaterialChannel channel;
    channel.name = name;
    channel.n = 1.7;
    channel.kappa = 0.0;
    result.material.channels.push_back(channel);
    scan.channels.push_back({.name = name, .wavelength_um = {}, .n = {}, .kappa = {}, .values = {}, .u = {}});
    result.parameters.push_back(parameter(name, "k_dd", 0.59123, 0.0141));
    FittedParameter bounded = parameter(name, "k_uds", 1.0, std::nullopt);
    bounded.at_upper = true;
    result.parameters.push_back(bounded);
    FittedParameter fixed = parameter(name, "k_fs", 1.1, std::nullopt);
    fixed.fixed = true;
    result.parameters.push_back(fixed);
    result.channel_rms.push_back(0.0042);
  }
};

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::string line_with(const std::string& text, const std::string& part) {
  for (const std::string& line : lines_of(text)) {
    if (line.find(part) != std::string::npos) return line;
  }
  return "no line with " + part;
}

// Code points: every character these reports add is one column wide.
std::size_t columns(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string without_colour(const std::string& text) {
  return std::regex_replace(text, std::regex("\x1b\\[[0-9]*m"), "");
}

TEST(SelectionBlock, MarksTheChosenSetAndCountsWhatWasNotTried) {
  Sample sample(1);
  Selection selection;
  selection.rows.resize(2);
  selection.rows[0].components = {Effect::dd, Effect::uds};
  selection.rows[0].bic = 120.0;
  selection.rows[0].cross_validated = 1.0125;
  selection.rows[0].chosen = true;
  selection.rows[1].components = {Effect::udf};
  selection.rows[1].bic = 150.0;
  selection.not_fitted = {{Effect::rough}};
  selection.noise = {0.021, 0.0003};
  selection.reason = "because";
  sample.result.selection = selection;
  const std::string text = fit_report(sample.result, sample.scan, {});
  EXPECT_NE(line_with(text, "dd + uds  ").find("1.0125"), std::string::npos) << text;
  EXPECT_NE(line_with(text, "→").find("dd + uds"), std::string::npos) << text;
  EXPECT_NE(line_with(text, "  udf ").find("30"), std::string::npos) << text;
  EXPECT_NE(text.find("2.1 % of the value and 0.0003 sr⁻¹"), std::string::npos) << text;
  EXPECT_NE(text.find("1 more set was not tried"), std::string::npos) << text;
  const auto json = nlohmann::json::parse(fit_report_json(sample.result, sample.scan)).at("selection");
  EXPECT_EQ(json.at("reason"), "because");
  EXPECT_EQ(json.at("sets").at(0).at("chosen"), true);
  EXPECT_TRUE(json.at("sets").at(1).at("cross_validated").is_null());
  EXPECT_EQ(json.at("not_tried").at(0).at(0), "rough");
}

TEST(MisfitBlock, VerdictFirstThenWhyThenTheWorstReadings) {
  Sample sample(1);
  FitDiagnostics d;
  d.verdict = FitVerdict::fails;
  d.findings = {"the first finding", "the second \x1b[31mfinding"};
  d.channels.resize(1);
  d.outlier_count = 12;
  for (std::size_t i = 0; i < 5; ++i) d.outliers.push_back({i, 0, 0.25 + static_cast<double>(i), 0.125, 9.0});
  sample.scan.phi_i_deg = sample.scan.theta_r_deg = sample.scan.phi_r_deg = sample.scan.theta_i_deg;
  EXPECT_EQ(fit_report(sample.result, sample.scan, {}).find("Misfit"), std::string::npos) << "none was asked for";
  sample.result.diagnostics = d;
  const std::string text = fit_report(sample.result, sample.scan, {});
  EXPECT_EQ(line_with(text, "FAILS"), "  verdict       FAILS");
  EXPECT_EQ(line_with(text, "first finding"), "  because       the first finding");
  EXPECT_EQ(line_with(text, "second"), "                the second ?[31mfinding");
  EXPECT_NE(line_with(text, "2.25").find("0.125"), std::string::npos) << text;
  EXPECT_EQ(line_with(text, "3.25"), "no line with 3.25") << "three are enough";
  EXPECT_NE(text.find("(3 of 12; --json has 5)"), std::string::npos) << text;
  const auto json = nlohmann::json::parse(fit_report_json(sample.result, sample.scan)).at("diagnostics");
  EXPECT_EQ(json.at("verdict"), "fails");
  EXPECT_EQ(json.at("outliers").size(), 5U);
  EXPECT_EQ(json.at("outliers")[1].at("value"), 1.25);
  EXPECT_TRUE(json.at("chi_square").is_null());
  EXPECT_TRUE(json.at("channels")[0].at("runs").at("p").is_null());
}

TEST(ValueText, RoundsBothToTwoDigitsOfTheUncertainty) {
  struct Case {
    double value, u;
    std::string value_text, u_text;
  };
  for (const Case& c : std::vector<Case>{{0.085374, 0.000213, "0.08537", "0.00021"},
                                         {1.0, 0.0996, "1.00", "0.10"},  // rounding carries into the next digit
                                         {1.0, 0.0994, "1.000", "0.099"},
                                         {12345.6, 123.4, "12350", "120"},
                                         {-0.0004, 0.013, "0.000", "0.013"},  // no negative zero
                                         {-1.25, 0.5, "-1.25", "0.50"},
                                         {0.0, 0.02, "0.000", "0.020"},
                                         {0.0013, 4.1e12, "0.0013", "4.1e+12"},
                                         {3.21e-9, 4.2e-10, "(3.21", "0.42)e-09"},
                                         {2.5e12, 3e9, "(2.5000", "0.0030)e+12"}}) {
    const ValueText text = value_text(c.value, c.u);
    EXPECT_EQ(text.value, c.value_text) << c.value << " ± " << c.u;
    EXPECT_EQ(text.uncertainty, c.u_text) << c.value << " ± " << c.u;
  }
}

TEST(NumberText, PercentAndDuration) {
  EXPECT_EQ(percent_text(0.0025), "0.25 %");
  EXPECT_EQ(percent_text(0.13), "13 %");
  EXPECT_EQ(percent_text(0.0), "0 %");
  EXPECT_EQ(percent_text(infinity), "");
  EXPECT_EQ(duration_text(0.0382), "38.2 ms");
  EXPECT_EQ(duration_text(12.34), "12.3 s");
  EXPECT_EQ(duration_text(200.0), "3 min 20 s");
}

TEST(TextTable, AlignsColumnsThatHoldOtherAlphabets) {
  TextTable table({{"name", TextTable::Align::left}, {"value", TextTable::Align::right}});
  table.add_row({"µθκ", "1"});
  table.add_row({"abcdef", "22"});
  EXPECT_EQ(table.str(2, false), "  name    value\n  µθκ         1\n  abcdef     22\n");
}

TEST(TextTable, LeavesOutColumnsThatStayEmpty) {
  TextTable table({{"a", TextTable::Align::left}, {"never", TextTable::Align::left}, {"b", TextTable::Align::left}});
  table.add_row({"1", "", "2"});
  EXPECT_EQ(table.str(0, false), "a  b\n1  2\n");
}

TEST(EvenlyChosen, KeepsBothEnds) {
  EXPECT_EQ(evenly_chosen(3, 6), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(evenly_chosen(31, 6), (std::vector<std::size_t>{0, 6, 12, 18, 24, 30}));
  EXPECT_EQ(evenly_chosen(1, 6), (std::vector<std::size_t>{0}));
  EXPECT_TRUE(evenly_chosen(0, 6).empty());
}

TEST(FitReport, StatesEveryParameterWithItsUncertaintyAndState) {
  const Sample sample(3);
  const std::string report = fit_report(sample.result, sample.scan, {});
  EXPECT_TRUE(
      std::regex_search(line_with(report, "slope  "), std::regex("slope +0\\.08537 +± 0\\.00021 +0\\.25 % +0 … 1$")))
      << report;
  EXPECT_TRUE(std::regex_search(line_with(report, "sigma_um"), std::regex("– +µm +not determined by this scan")));
  EXPECT_TRUE(std::regex_search(line_with(report, "400nm.k_dd"), std::regex("0\\.591 +± 0\\.014 +2\\.4 %")));
  EXPECT_TRUE(std::regex_search(line_with(report, "410nm.k_uds"), std::regex(" 1 .*at upper bound$")));
  EXPECT_TRUE(std::regex_search(line_with(report, "420nm.k_fs"), std::regex(" 1\\.1 +fixed$")));
  EXPECT_LT(report.find("slope  "), report.find("400nm.k_dd")) << "shared parameters come first";
}

TEST(FitReport, SaysWhatWasUsedAndWhatWasNot) {
  const Sample sample(3);
  const std::string report = fit_report(sample.result, sample.scan, {});
  EXPECT_NE(report.find("880 of 900 used; 12 left out at θ = 90°; 8 left out beyond the largest θ asked for"),
            std::string::npos)
      << report;
  EXPECT_NE(report.find("3 negative values"), std::string::npos);
  EXPECT_NE(report.find("121 evaluations, 3 starts, 27 iterations; 250 ms"), std::string::npos);
  EXPECT_NE(report.find("400nm 0.00420, 410nm 0.00420, 420nm 0.00420 sr⁻¹ (RMS, unweighted)"), std::string::npos);
  EXPECT_NE(report.find("converged     yes"), std::string::npos);
  EXPECT_NE(report.find("dd + uds + fs (chosen automatically)"), std::string::npos);
  EXPECT_NE(report.find("Warnings\n  • k_uds is on a bound"), std::string::npos);
  EXPECT_NE(report.find("Notes\n  • auto"), std::string::npos);
}

TEST(FitReport, NamesTheModelAndTheFormsThatAreRead) {
  Sample sample(1);
  EXPECT_EQ(line_with(fit_report(sample.result, sample.scan, {}), "  model "), "  model         surface");
  EXPECT_EQ(line_with(fit_report(sample.result, sample.scan, {}), "  forms "), "  forms         fs printed");
  Material& m = sample.result.material;
  m.components = {Effect::dd, Effect::rough};
  m.forms.rough = RoughForm::qualitative;
  m.surface.slope_y = 0.2;
  const std::string report = fit_report(sample.result, sample.scan, {});
  EXPECT_EQ(line_with(report, "  model "), "  model         surface, anisotropic");
  EXPECT_EQ(line_with(report, "  forms "), "  forms         rough qualitative, anisotropy consistent");
}

TEST(FitReport, APeerHasNoEffectsAndOneTerm) {
  Sample sample(1);
  Material& m = sample.result.material;
  m.model = "ggx";
  m.components = {};
  m.surface = {};
  sample.result.parameters.insert(sample.result.parameters.begin(), parameter("", "alpha", 0.25, 0.01));
  const std::string report = fit_report(sample.result, sample.scan, {});
  EXPECT_EQ(line_with(report, "  model "), "  model         ggx");
  EXPECT_EQ(line_with(report, "  terms "), "  terms         Fresnel schlick");
  EXPECT_EQ(report.find("  components"), std::string::npos);
  EXPECT_EQ(report.find("  forms"), std::string::npos);
  EXPECT_NE(line_with(report, "  alpha ").find("± 0.010"), std::string::npos) << report;
  const auto json = nlohmann::json::parse(fit_report_json(sample.result, sample.scan));
  EXPECT_EQ(json.at("model").at("name"), "ggx");
  EXPECT_FALSE(json.at("model").contains("components"));
  EXPECT_EQ(json.at("model").at("terms"), (nlohmann::json{{"fresnel", "schlick"}}));
}

TEST(FitReport, ANonConvergedFitCannotBeOverlooked) {
  Sample sample(1);
  sample.result.converged = false;
  EXPECT_NE(fit_report(sample.result, sample.scan, {}).find("converged     NO"), std::string::npos);
}

TEST(FitReport, FlagsReflectanceAboveOne) {
  const Sample sample(2);
  const std::string report = fit_report(sample.result, sample.scan, {});
  EXPECT_TRUE(std::regex_search(line_with(report, "1.2500"), std::regex("80 .*> 1")));
  EXPECT_EQ(line_with(report, "0.5000").find("> 1"), std::string::npos);
  EXPECT_EQ(fit_report(sample.result, sample.scan, {.color = false, .show_reflectance = false}).find("1.2500"),
            std::string::npos);
}

TEST(FitReport, ThirtyOneBandsStayReadable) {
  const Sample sample(31);
  const std::string report = fit_report(sample.result, sample.scan, {});
  std::set<std::size_t> places;
  std::size_t rows = 0;
  for (const std::string& line : lines_of(report)) {
    EXPECT_LE(columns(line), 100U) << line;
    if (!std::regex_search(line, std::regex("^  [4-7][0-9]0nm "))) continue;
    ++rows;
    places.insert(columns(line.substr(0, line.find("±"))));
    EXPECT_TRUE(std::regex_search(line, std::regex("0\\.591 +± 0\\.014 +1 +max +1\\.1 +fixed +0\\.00420$"))) << line;
  }
  EXPECT_EQ(rows, 31U);
  EXPECT_EQ(places.size(), 1U) << "the ± stand below one another";
  EXPECT_NE(report.find("2 of 2 incidence angles, 8 of 31 channels"), std::string::npos);
}

TEST(FitReport, ColoursOnlyWhenAsked) {
  const Sample sample(6);
  const std::string plain = fit_report(sample.result, sample.scan, {.color = false, .show_reflectance = true});
  const std::string coloured = fit_report(sample.result, sample.scan, {.color = true, .show_reflectance = true});
  EXPECT_EQ(plain.find('\x1b'), std::string::npos);
  EXPECT_NE(coloured.find('\x1b'), std::string::npos);
  EXPECT_EQ(without_colour(coloured), plain) << "colour changes no text and no alignment";
}

TEST(FitReport, NamesFromFilesCannotDriveTheTerminal) {
  Sample sample(1);
  sample.result.material.name = "evil\x1b[2Jname\x07";
  sample.scan.source =
      "\xC2\x9B"
      "31m.csv";
  const std::string report = fit_report(sample.result, sample.scan, {});
  EXPECT_EQ(report.find('\x1b'), std::string::npos);
  EXPECT_EQ(report.find('\x07'), std::string::npos);
  EXPECT_EQ(report.find("\xC2\x9B"), std::string::npos);
  EXPECT_NE(report.find("evil?[2Jname?"), std::string::npos);
}

TEST(FitReportJson, HoldsTheSameNumbersUnrounded) {
  const Sample sample(31);
  const auto json = nlohmann::json::parse(fit_report_json(sample.result, sample.scan));
  EXPECT_EQ(json.at("parameters").size(), 2U + 3U * 31U);
  const auto& slope = json["parameters"][0];
  EXPECT_EQ(slope.at("value"), 0.085374);
  EXPECT_EQ(slope.at("standard_uncertainty"), 0.000213);
  EXPECT_EQ(slope.at("state"), "free");
  EXPECT_TRUE(slope.at("channel").is_null());
  const auto& sigma = json["parameters"][1];
  EXPECT_TRUE(sigma.at("value").is_null());
  EXPECT_TRUE(sigma.at("max").is_null()) << "JSON has no infinity";
  EXPECT_EQ(sigma.at("state"), "undetermined");
  EXPECT_EQ(json["parameters"][3].at("state"), "at upper bound");
  EXPECT_EQ(json["parameters"][4].at("state"), "fixed");
  EXPECT_EQ(
      json.at("left_out"),
      (nlohmann::json{
          {"theta_90", 12}, {"max_theta", 8}, {"retro_cone", 0}, {"saturated_values", 0}, {"clamped_values", 0}}));
  EXPECT_EQ(json.at("reflectance").at(1).at("by_channel").size(), 31U);
  EXPECT_EQ(json.at("channels").at(30).at("rms"), 0.0042);
  EXPECT_EQ(json.at("warnings").size(), 1U);
  EXPECT_TRUE(json.at("converged"));
  EXPECT_EQ(json.at("model").at("name"), "surface");
  EXPECT_EQ(json.at("model").at("forms"),
            (nlohmann::json{{"fs", "printed"}, {"rough", "functional"}, {"anisotropy", "consistent"}}));
}

TEST(FitReportJson, SurvivesNamesThatAreNotUtf8) {
  Sample sample(1);
  sample.result.material.name = "caf\xE9";
  EXPECT_EQ(nlohmann::json::parse(fit_report_json(sample.result, sample.scan)).at("name"), "caf\xEF\xBF\xBD");
}

}  // namespace
}  // namespace goniofit
