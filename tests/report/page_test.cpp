// The report's page: what it holds, that nothing from a file becomes markup, and that it is the same every time.

#include "report/page.h"

#include <gtest/gtest.h>

#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "brdf/evaluator.h"
#include "brdf/paper_samples.h"
#include "io/material_io.h"
#include "io/scan_reader.h"
#include "report/digest.h"
#include "report/material_result.h"
#include "support/error_message.h"
#include "support/paths.h"
#include "support/run_program.h"
#include "synthetic/simulate.h"

namespace goniofit::test {
namespace {

using Json = nlohmann::ordered_json;

Scan paint_scan(Sampling sampling = Sampling::incidence_plane) {
  return simulate(garnet_red_paint_13(), sampling, {.relative = 0.02, .additive = 0.0}, 7);
}

FitResult paint_fit(const Scan& scan) {
  FitSettings settings;
  settings.components = EffectSet{Effect::dd, Effect::uds, Effect::fs};
  settings.n = {1.7};
  return fit(scan, settings);
}

// What a browser would hand to the page's script.
Json data_of(const std::string& page) {
  const std::string open = R"(<script type="application/json" id="report-data">)";
  const std::size_t begin = page.find(open);
  if (begin == std::string::npos) return nullptr;
  const std::size_t end = page.find("</script>", begin);
  return Json::parse(page.substr(begin + open.size(), end - begin - open.size()));
}

std::vector<float> floats(const std::string& text) {
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint32_t> bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6U | static_cast<std::uint32_t>(letters.find(c));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes.push_back(bits >> static_cast<unsigned>(count) & 0xFFU);
  }
  std::vector<float> out;
  for (std::size_t i = 0; i + 3 < bytes.size(); i += 4)
    out.push_back(std::bit_cast<float>(bytes[i] | bytes[i + 1] << 8U | bytes[i + 2] << 16U | bytes[i + 3] << 24U));
  return out;
}

std::size_t count_of(const std::string& text, const std::string& what) {
  std::size_t count = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
  return count;
}

TEST(Digest, OfKnownBytes) {
  const ScratchDir folder;
  spit(folder / "abc", "abc");  // FIPS 180-4's example
  EXPECT_EQ(sha256_of_file(folder / "abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");  // RFC 4648, section 10
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(floats(base64_floats(std::vector{1.5, -0.1})), (std::vector<float>{1.5F, -0.1F}));
}

TEST(Page, HoldsEveryParameterWithAllDigits) {
  const Scan scan = paint_scan();
  const FitResult result = paint_fit(scan);
  const Json data = data_of(report_page(result, scan, {}));
  EXPECT_EQ(data.at("material"), Json::parse(to_json(result.material)));
  ASSERT_EQ(data.at("fit").at("parameters").size(), result.parameters.size());
  ASSERT_EQ(data.at("texts").size(), result.parameters.size());
  for (std::size_t i = 0; i < result.parameters.size(); ++i) {
    const FittedParameter& p = result.parameters[i];
    const Json& shown = data.at("fit").at("parameters").at(i);
    EXPECT_EQ(shown.at("value").is_null(), !p.value.has_value()) << p.name;
    EXPECT_EQ(shown.at("standard_uncertainty").is_null(), !p.u.has_value()) << p.name;
    if (!p.value || !p.u) continue;
    EXPECT_EQ(shown.at("value").get<double>(), *p.value) << p.name;
    EXPECT_EQ(shown.at("standard_uncertainty").get<double>(), *p.u) << p.name;
  }
  EXPECT_EQ(data.at("verdict").at("name"), "describes");
  EXPECT_EQ(data.at("verdict").at("words"), "The model describes the scan");
}

TEST(Page, ReadingsAndCurvesAreTheScansAndTheMaterials) {
  const Scan scan = paint_scan();
  const FitResult result = paint_fit(scan);
  const Evaluator evaluator(result.material);
  const Json plots = data_of(report_page(result, scan, {})).at("plots");
  const Json& curves = plots.at("curves").at("incidences");
  ASSERT_EQ(curves.size(), 5U);  // 15, 30, 45, 60, 75
  std::size_t readings = 0;
  for (const Json& curve : curves) {
    const double theta_i = curve.at("theta_i");
    const std::vector<float> theta_r = floats(curve.at("theta_r"));
    const std::vector<float> fitted = floats(curve.at("channels").at(1).at("fitted"));
    ASSERT_EQ(theta_r.size(), fitted.size());
    readings += theta_r.size();
    for (std::size_t i = 0; i < fitted.size(); ++i) {
      const double f = evaluator.value(make_pair(in_plane(theta_i, theta_r[i])), 1);
      EXPECT_NEAR(fitted[i], f, 1e-4 * f + 1e-9) << theta_i << ' ' << theta_r[i];
    }
    const std::vector<float> angles = floats(curve.at("curve_theta_r"));
    const std::vector<float> values = floats(curve.at("curve").at(2));
    ASSERT_EQ(angles.size(), values.size());
    EXPECT_GT(angles.size(), 100U);
    const double middle = evaluator.value(make_pair(in_plane(theta_i, angles[angles.size() / 2])), 2);
    EXPECT_NEAR(values[angles.size() / 2], middle, 1e-4 * middle);
  }
  EXPECT_EQ(readings, scan.size());
  EXPECT_FALSE(plots.at("maps").at("available").get<bool>());
}

TEST(Page, MapsAndLobesOfAHemisphericalScan) {
  const Scan scan = paint_scan(Sampling::hemisphere);
  const FitResult result = paint_fit(scan);
  const Evaluator evaluator(result.material);
  const Json plots = data_of(report_page(result, scan, {})).at("plots");
  EXPECT_TRUE(plots.at("maps").at("available").get<bool>());
  std::size_t row = 0;  // a simulated scan lies in the order of its incidence angles
  for (const Json& panel : plots.at("maps").at("panels")) {
    const std::vector<float> measured = floats(panel.at("channels").at(0).at("measured"));
    for (const float value : measured) EXPECT_EQ(value, static_cast<float>(scan.channels[0].values[row++]));
  }
  EXPECT_EQ(row, scan.size());
  const Json& lobe = plots.at("lobes").at("lobes").at(3);
  const std::vector<float> theta = floats(lobe.at("theta"));
  const std::vector<float> phi = floats(lobe.at("phi"));
  const std::vector<float> values = floats(lobe.at("values").at(0));
  ASSERT_EQ(values.size(), theta.size() * phi.size());
  EXPECT_EQ(phi.back(), 180.0F);  // the left half is the right one's mirror image
  for (const std::size_t t : {0UL, theta.size() / 2, theta.size() - 1}) {
    for (const std::size_t p : {0UL, phi.size() / 2, phi.size() - 1}) {
      const double f = evaluator.value(make_pair({lobe.at("theta_i"), 0.0, theta[t], phi[p]}), 0);
      EXPECT_NEAR(values[t * phi.size() + p], f, 1e-3 * f) << theta[t] << ' ' << phi[p];
    }
  }
}

TEST(Page, OfAnAnisotropicMaterialOneAzimuthIsDrawn) {
  Material material = garnet_red_paint_13();
  material.surface = {.slope = 0.1, .slope_y = 0.3};
  Scan scan = paint_scan(Sampling::hemisphere);
  const std::size_t each = scan.size();
  for (auto* angles : {&scan.theta_i_deg, &scan.theta_r_deg})
    angles->insert(angles->end(), angles->begin(), angles->begin() + static_cast<std::ptrdiff_t>(each));
  for (auto* azimuths : {&scan.phi_i_deg, &scan.phi_r_deg}) {
    for (std::size_t row = 0; row < each; ++row) azimuths->push_back((*azimuths)[row] + 90.0);
  }
  for (ScanChannel& channel : scan.channels) channel.values.resize(2 * each, 7.0);
  const Json plots = Json::parse(page_data(result_of_material(material, scan), scan, {})).at("plots");
  EXPECT_TRUE(plots.at("anisotropic").get<bool>());
  EXPECT_EQ(plots.at("maps").at("note"), "φᵢ = 0° alone");
  std::size_t readings = 0;
  for (const Json& panel : plots.at("maps").at("panels")) {
    for (const float value : floats(panel.at("channels").at(0).at("measured"))) EXPECT_NE(value, 7.0F);
    readings += floats(panel.at("theta_r")).size();
  }
  EXPECT_EQ(readings, each);
  EXPECT_GT(floats(plots.at("lobes").at("lobes").at(0).at("phi")).back(), 350.0F) << "both halves";
}

TEST(Page, NothingFromAFileBecomesMarkup) {
  const std::string evil = "</script><script>alert('x')</script><img src=x onerror=\"alert(1)\">&amp;";
  Material material = garnet_red_paint_13();
  material.name = evil;
  material.channels[0].name = "<b>R</b>";
  Scan scan = paint_scan();
  scan.name = scan.source = evil;
  scan.metadata.emplace_back(evil, evil);
  scan.channels[0].name = "<b>R</b>";
  const PageSource source{.inputs = {{"scan", evil, "00"}}, .command = "goniofit report " + evil, .fitted = false};
  const std::string page = report_page(result_of_material(material, scan), scan, source);
  const std::string plain = report_page(result_of_material(garnet_red_paint_13(), paint_scan()), paint_scan(), {});
  for (const char* const markup : {"<script", "</script", "<img", "<b>"})
    EXPECT_EQ(count_of(page, markup), count_of(plain, markup)) << markup;
  const Json data = data_of(page);
  EXPECT_EQ(data.at("title"), evil);
  EXPECT_EQ(data.at("source").at("command"), "goniofit report " + evil);
  EXPECT_EQ(data.at("plots").at("channels").at(0), "<b>R</b>");
  EXPECT_NE(page.find("<title>&lt;/script&gt;&lt;script&gt;alert"), std::string::npos);
}

TEST(Page, ItsPolicyForbidsAllButItsOwnScript) {
  const Scan scan = paint_scan();
  const std::string page = report_page(result_of_material(garnet_red_paint_13(), scan), scan, {});
  EXPECT_EQ(count_of(page, "Content-Security-Policy"), 1U);
  EXPECT_NE(page.find("default-src 'none'; script-src 'sha256-"), std::string::npos);
  EXPECT_LT(page.find("Content-Security-Policy"), page.find("<style"));
  EXPECT_EQ(page.find("<link rel=\"stylesheet\""), std::string::npos);
}

TEST(Page, TheSameArgumentsGiveTheSameBytes) {
  const Scan scan = paint_scan();
  const FitResult first = paint_fit(scan);
  FitResult second = paint_fit(scan);
  second.seconds += 1.0;
  EXPECT_EQ(report_page(first, scan, {}), report_page(second, scan, {}));
}

TEST(Page, OfAMaterialSaysWhatTheFitSaid) {
  const Scan scan = paint_scan(Sampling::hemisphere);
  const FitResult fitted = paint_fit(scan);
  const FitResult again = result_of_material(parse_material(to_json(fitted.material), "m.json"), scan);
  const Json before = Json::parse(page_data(fitted, scan, {}));
  const Json after = Json::parse(page_data(again, scan, {.fitted = false}));
  ASSERT_EQ(before.at("texts").size(), after.at("texts").size());
  for (std::size_t i = 0; i < before.at("texts").size(); ++i) {
    EXPECT_EQ(before.at("fit").at("parameters").at(i).at("name"), after.at("fit").at("parameters").at(i).at("name"));
    EXPECT_EQ(before.at("texts").at(i), after.at("texts").at(i)) << before.at("fit").at("parameters").at(i);
  }
  EXPECT_EQ(before.at("verdict").at("name"), after.at("verdict").at("name"));
  EXPECT_NEAR(again.loss, fitted.loss, 1e-9 * fitted.loss);
  EXPECT_NEAR(again.rms, fitted.rms, 1e-9 * fitted.rms);
  ASSERT_EQ(again.channel_rms.size(), fitted.channel_rms.size());
  EXPECT_NEAR(again.channel_rms[2], fitted.channel_rms[2], 1e-9 * fitted.channel_rms[2]);
  EXPECT_EQ(before.at("plots"), after.at("plots"));
}

TEST(Page, OtherChannelsAreAnError) {
  const Scan scan = select_channels(paint_scan(), {"R", "G"});
  EXPECT_NE(error_message([&] {
              static_cast<void>(result_of_material(garnet_red_paint_13(), scan));
            }).find("have different channels"),
            std::string::npos);
}

// The bounds are a fifth of what a slow machine may take; sanitizers take as much again.
TEST(Page, OfAWholeScanIsWrittenInAMomentAndSmall) {
  const Scan scan = read_scan(source_dir() / "data/garnet_red_paint_13.csv");
  ASSERT_EQ(scan.size(), 3528U);
  const FitResult result = paint_fit(scan);
  const auto start = std::chrono::steady_clock::now();
  const std::string page = report_page(result, scan, {});
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  EXPECT_LT(taken.count(), 5.0);
  EXPECT_LT(page.size(), 4'000'000U);
}

TEST(Page, ManyReadingsAndChannelsAreThinnedAndItSaysSo) {
  Scan scan = paint_scan(Sampling::hemisphere);
  Material material = garnet_red_paint_13();
  while (scan.channels.size() < 40) {
    scan.channels.push_back(scan.channels[0]);
    material.channels.push_back(material.channels[0]);
    scan.channels.back().name = material.channels.back().name = "c" + std::to_string(scan.channels.size());
  }
  for (ScanChannel& channel : scan.channels) channel.u.assign(scan.size(), 0.01);
  const std::string page = report_page(result_of_material(material, scan), scan, {.fitted = false});
  EXPECT_LT(page.size(), 4'000'000U);
  const Json plots = data_of(page).at("plots");
  EXPECT_EQ(plots.at("note"), "32 of 40 channels are drawn");
  EXPECT_NE(plots.at("maps").at("note").get<std::string>().find("of the readings, evenly chosen"), std::string::npos);
  EXPECT_TRUE(plots.at("residual").at("by_u").get<bool>());
}

}  // namespace
}  // namespace goniofit::test
