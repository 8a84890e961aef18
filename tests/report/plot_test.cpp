#include "report/plot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "io/scan_reader.h"
#include "report/gnuplot.h"
#include "report/plot_plan.h"
#include "support/error_message.h"
#include "support/materials.h"
#include "support/paths.h"
#include "support/run_program.h"
#include "synthetic/simulate.h"

namespace goniofit {
namespace {

using test::error_message;
using test::names_in;
using test::ScratchDir;
using test::slurp;

constexpr Noise no_noise{.relative = 0.0, .additive = 0.0};

Scan scan_of(Sampling sampling) { return simulate(test::garnet_red_paint_13(), sampling, no_noise, 1); }

// One channel; a reading for each signed theta_r at each theta_i, `value(theta_i, theta_r)`.
template <class Value>
Scan plane_scan(const std::vector<double>& incidences, const std::vector<double>& reflected, Value value) {
  Scan scan;
  scan.source = "made.csv";
  scan.geometry = ScanGeometry::incidence_plane;
  scan.channels.push_back({.name = "R", .wavelength_um = {}, .n = {}, .kappa = {}, .values = {}, .u = {}});
  for (const double theta_i : incidences) {
    for (const double theta_r : reflected) {
      scan.theta_i_deg.push_back(theta_i);
      scan.phi_i_deg.push_back(0.0);
      scan.theta_r_deg.push_back(std::fabs(theta_r));
      scan.phi_r_deg.push_back(theta_r < 0.0 ? 0.0 : 180.0);
      scan.channels[0].values.push_back(value(theta_i, theta_r));
    }
  }
  return scan;
}

std::vector<double> incidences_of(const PlotPlan& plan) {
  std::vector<double> angles;
  for (const PlottedIncidence& group : plan.incidences) angles.push_back(group.theta_i_deg);
  return angles;
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++count;
  return count;
}

TEST(PlotPlan, TakesTheReadingsInThePlaneOfIncidence) {
  const PlotPlan plan = plan_plot(scan_of(Sampling::hemisphere), {});
  EXPECT_EQ(incidences_of(plan), (std::vector<double>{10, 20, 30, 40, 50, 60, 70, 80}));
  EXPECT_EQ(plan.azimuth_tolerance_deg, 0.5);
  for (const PlottedIncidence& group : plan.incidences) {
    EXPECT_EQ(group.rows.size(), 21U) << "the middle row of the 21 × 21 cells";
    EXPECT_LT(*std::min_element(group.signed_theta_r_deg.begin(), group.signed_theta_r_deg.end()), -80.0);
    EXPECT_GT(*std::max_element(group.signed_theta_r_deg.begin(), group.signed_theta_r_deg.end()), 80.0);
  }
}

TEST(PlotPlan, GoesTowardsTheNearestReadingsWhenNoneIsInThePlane) {
  Scan scan = scan_of(Sampling::hemisphere);
  for (double& phi : scan.phi_r_deg) phi += 3.0;
  const PlotPlan plan = plan_plot(scan, {});
  EXPECT_EQ(plan.azimuth_tolerance_deg, 5.0);
  EXPECT_GE(plan.incidences.at(3).rows.size(), 21U);
}

TEST(PlotPlan, RefusesAScanFarFromThePlane) {
  Scan scan = scan_of(Sampling::incidence_plane);
  for (double& phi : scan.phi_r_deg) phi += 90.0;
  for (double& theta : scan.theta_r_deg) theta = std::max(theta, 1.0);
  EXPECT_NE(
      error_message([&] { (void)plan_plot(scan, {}); }).find("no reading lies within 10° of the plane of incidence"),
      std::string::npos);
}

TEST(PlotPlan, PrefersRoundIncidencesAmongMany) {
  std::vector<double> incidences;
  for (int i = 1; i <= 87; ++i) incidences.push_back(i);
  const Scan scan =
      plane_scan(incidences, {15, 20, 30, 40, 45, 50, 60, 70, 80, 85}, [](double, double) { return 0.1; });
  const PlotPlan plan = plan_plot(scan, {});
  EXPECT_EQ(incidences_of(plan), (std::vector<double>{10, 20, 30, 40, 50, 60, 70, 80}));
  EXPECT_EQ(plan.incidences_available, 87U);
}

TEST(PlotPlan, LeavesOutIncidencesWithFewReadings) {
  Scan scan = plane_scan({30.0, 60.0}, {-60, -30, 0, 30, 60, 80}, [](double, double) { return 0.1; });
  const Scan stray = plane_scan({45.0}, {10.0}, [](double, double) { return 0.1; });
  scan = concatenate({scan, stray});
  EXPECT_EQ(incidences_of(plan_plot(scan, {})), (std::vector<double>{30, 60}));
}

TEST(PlotPlan, IsLogarithmicAboveAFactorThirty) {
  const std::vector<double> reflected{-60, -40, -20, 0, 20, 40, 60};
  const auto spanning = [&](double factor) {
    return plane_scan({30.0}, reflected, [=](double, double r) { return r == 40.0 ? factor : 1.0; });
  };
  EXPECT_FALSE(plan_plot(spanning(29.0), {}).log);
  EXPECT_TRUE(plan_plot(spanning(31.0), {}).log);
  EXPECT_FALSE(plan_plot(spanning(1000.0), {.axis = PlotAxis::linear}).log);
  EXPECT_TRUE(plan_plot(spanning(2.0), {.axis = PlotAxis::log}).log);
}

TEST(PlotPlan, CountsWhatALogAxisCannotShow) {
  const Scan scan = plane_scan({30.0, 50.0}, {-60, -40, -20, 0, 20, 40, 60}, [](double, double r) {
    return r == -20.0 ? -0.001 : r == -40.0 ? 0.0 : 0.1;
  });
  const PlotPlan plan = plan_plot(scan, {.axis = PlotAxis::log});
  EXPECT_EQ(plan.not_shown, 4U);
  EXPECT_EQ(plan.lowest, 0.1);
  EXPECT_EQ(plan_plot(scan, {.axis = PlotAxis::linear}).not_shown, 0U);
  EXPECT_EQ(plan_plot(scan, {.axis = PlotAxis::linear}).lowest, -0.001);
}

TEST(PlotPlan, ALogAxisSpansSevenDecadesAtMost) {
  const Scan scan =
      plane_scan({30.0}, {-60, -40, -20, 0, 20, 40}, [](double, double r) { return r < 0.0 ? 1e-200 : 5.0; });
  const PlotPlan plan = plan_plot(scan, {});
  EXPECT_EQ(plan.lowest, 5e-7);
  EXPECT_EQ(plan.not_shown, 3U);
}

TEST(PlotPlan, AScanOfNoiseAloneFallsBackToALinearAxis) {
  const Scan scan = plane_scan({30.0}, {-60, -40, -20, 0, 20, 40}, [](double, double) { return -0.01; });
  EXPECT_FALSE(plan_plot(scan, {.axis = PlotAxis::log}).log);
}

TEST(CurveAngles, AreDenseAtTheMirrorAndNowhereFarApart) {
  PlotPlan plan;
  plan.theta_min_deg = -88.0;
  plan.theta_max_deg = 88.0;
  for (const double lobe : {0.05, 0.7, 9.0}) {
    const std::vector<double> angles = curve_angles(plan, 40.0, lobe);
    EXPECT_EQ(angles.front(), -88.0);
    EXPECT_EQ(angles.back(), 88.0);
    std::size_t inside = 0;
    for (std::size_t i = 1; i < angles.size(); ++i) {
      EXPECT_GT(angles[i], angles[i - 1]);
      EXPECT_LE(angles[i] - angles[i - 1], 1.0 + 1e-12);
      inside += std::fabs(angles[i] - 40.0) < lobe ? 1U : 0U;
    }
    EXPECT_GE(inside, 10U) << "a lobe " << lobe << "° wide needs points to look like one";
    EXPECT_TRUE(std::find(angles.begin(), angles.end(), 40.0) != angles.end());
  }
}

TEST(GnuplotQuoted, LeavesNothingToEvaluate) {
  EXPECT_EQ(gnuplot_quoted("plain"), "'plain'");
  EXPECT_EQ(gnuplot_quoted("it's"), "'it''s'");
  EXPECT_EQ(gnuplot_quoted("a\nset output\tb"), "'a set output b'");
  EXPECT_EQ(gnuplot_quoted("`x` \"y\" \\n"), "'`x` \"y\" \\n'");
}

class PlotFile : public ::testing::Test {
 protected:
  void draw(const std::string& name, const Scan& scan, const Material& material,
            const PlotOptions& options = {}) const {
    plot_fit(folder_ / name, scan, material, options);
  }

  ScratchDir folder_;
  Material material_ = test::garnet_red_paint_13();
};

TEST_F(PlotFile, SvgHasOnePanelAChannelAndAKeyEntryAnIncidence) {
  draw("a.svg", scan_of(Sampling::incidence_plane), material_);
  const std::string svg = slurp(folder_ / "a.svg");
  EXPECT_EQ(svg.rfind("<?xml", 0), 0U);
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
  for (const char* text : {"Garnet Red Paint #13", ">R<", ">G<", ">B<", "θᵢ = 15°", "θᵢ = 75°", "measured", "fitted",
                           "θᵣ (degrees; positive = forward)", "BRDF (sr⁻¹)", "slope σ/τ = 0.0853659"}) {
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  }
  EXPECT_EQ(count_of(svg, "<text>θᵢ = "), 5U) << "one key for all panels";
  EXPECT_EQ(names_in(folder_.path()), std::vector<std::string>{"a.svg"}) << "nothing but the plot is left";
}

TEST_F(PlotFile, PngByExtensionInAnyCase) {
  draw("a.PNG", scan_of(Sampling::hemisphere), material_);
  EXPECT_EQ(slurp(folder_ / "a.PNG").substr(0, 8), "\x89PNG\r\n\x1a\n");
}

TEST_F(PlotFile, IsTheSameEveryTime) {
  const Scan scan = scan_of(Sampling::incidence_plane);
  draw("a.svg", scan, material_);
  draw("b.svg", scan, material_);
  EXPECT_EQ(slurp(folder_ / "a.svg"), slurp(folder_ / "b.svg"));
}

TEST_F(PlotFile, GrowsWithItsPanelsUpToThreeColumns) {
  const auto size_of = [&](std::size_t channels) {
    Scan scan = scan_of(Sampling::incidence_plane);
    Material material = material_;
    scan.channels.resize(1, scan.channels[0]);
    material.channels.resize(1);
    for (std::size_t c = 1; c < channels; ++c) {
      scan.channels.push_back(scan.channels[0]);
      scan.channels.back().name = material.channels.emplace_back(material.channels[0]).name = "C" + std::to_string(c);
    }
    draw("a.svg", scan, material);
    const std::string svg = slurp(folder_ / "a.svg");
    const std::size_t at = svg.find("width=\"");
    return std::pair{std::stoi(svg.substr(at + 7)), std::stoi(svg.substr(svg.find("height=\"") + 8))};
  };
  EXPECT_GT(size_of(3).first, size_of(2).first);
  EXPECT_EQ(size_of(6).first, size_of(3).first);
  EXPECT_GT(size_of(6).second, size_of(3).second);
  EXPECT_EQ(size_of(9), size_of(6)) << "six panels at most";
  EXPECT_NE(slurp(folder_ / "a.svg").find("6 of 9 channels"), std::string::npos);
}

TEST_F(PlotFile, NamesFromFilesAreDrawnAndNeverRun) {
  Scan scan = scan_of(Sampling::incidence_plane);
  const std::string trap = (folder_ / "trap").string();
  const std::string name = "it's `touch " + trap + "` @x $y {/Bold z}^2_3 \\n'; system('touch " + trap + "'); #";
  material_.name = name;
  scan.channels[0].name = material_.channels[0].name = name;
  draw("a.svg", scan, material_);
  EXPECT_FALSE(std::filesystem::exists(trap));
  EXPECT_EQ(count_of(slurp(folder_ / "a.svg"), "`touch " + trap + "` @x $y {/Bold z}^2_3 \\n"), 2U)
      << "title and panel, without markup";
}

TEST_F(PlotFile, SaysSoWhenReadingsWereTakenFromNearThePlane) {
  Scan scan = scan_of(Sampling::hemisphere);
  for (double& phi : scan.phi_r_deg) phi += 3.0;
  draw("a.svg", scan, material_);
  EXPECT_NE(slurp(folder_ / "a.svg").find("readings within 5° of the plane of incidence"), std::string::npos);
}

TEST(AtAzimuth, KeepsWholeReadings) {
  Scan scan = simulate(test::anisotropic_ggx(), Sampling::incidence_plane, {0.02, 1e-4}, 1, true);
  const Scan part = at_azimuth(scan, -315.0);
  ASSERT_EQ(part.size(), scan.size() / 3);
  for (std::size_t row = 0; row < part.size(); ++row) {
    ASSERT_EQ(part.phi_i_deg[row], 45.0);
    ASSERT_EQ(part.channels[1].values[row], scan.channels[1].values[part.size() + row]);
    ASSERT_EQ(part.channels[1].u[row], scan.channels[1].u[part.size() + row]);
  }
}

TEST_F(PlotFile, AnAnisotropicMaterialIsDrawnAtOneAzimuth) {
  const Material ggx = test::anisotropic_ggx();
  draw("a.svg", simulate(ggx, Sampling::incidence_plane, no_noise, 1), ggx);
  const std::string picture = slurp(folder_ / "a.svg");
  EXPECT_NE(picture.find("φᵢ = 0° alone"), std::string::npos);
  EXPECT_NE(picture.find("ggx-anisotropic   alpha_x = 0.1   alpha_y = 0.3"), std::string::npos);
  draw("b.svg", scan_of(Sampling::incidence_plane), material_);
  EXPECT_EQ(slurp(folder_ / "b.svg").find("° alone"), std::string::npos);
}

TEST_F(PlotFile, DrawsACoherentSpikeAndReadingsOfNothingButNoise) {
  material_.components.insert(Effect::coh);
  material_.surface = test::surface(0.05, 5.0);
  draw("spike.svg", simulate(material_, Sampling::incidence_plane, no_noise, 1), material_);
  Scan noise = plane_scan({30.0}, {-60, -40, -20, 0, 20, 40}, [](double, double) { return -0.01; });
  Material one = test::garnet_red_paint_13();
  one.channels.resize(1);
  draw("noise.svg", noise, one);
  EXPECT_EQ(names_in(folder_.path()), (std::vector<std::string>{"noise.svg", "spike.svg"}));
}

TEST_F(PlotFile, RefusesWhatItCannotDraw) {
  const Scan scan = scan_of(Sampling::incidence_plane);
  EXPECT_EQ(error_message([&] { draw("a.pdf", scan, material_); }).substr(0, 2), "2 ");
  Material other = material_;
  other.channels.pop_back();
  EXPECT_EQ(error_message([&] { draw("a.svg", scan, other); }),
            "2 the material has 2 channels and the scan 3: they cannot be drawn together");
  EXPECT_TRUE(names_in(folder_.path()).empty());
}

TEST_F(PlotFile, AMissingGnuplotIsASystemFailureThatLeavesNothing) {
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", folder_.path().c_str(), 1);
  const std::string message = error_message([&] { draw("a.svg", scan_of(Sampling::incidence_plane), material_); });
  ::setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(message, "3 cannot draw the plot: gnuplot is not installed, or not in PATH");
  EXPECT_TRUE(names_in(folder_.path()).empty());
}

TEST_F(PlotFile, GnuplotsComplaintIsPassedOn) {
  const std::string message =
      error_message([&] { run_gnuplot("set terminal svg\nplot 'no such file'\n", folder_ / "a.svg"); });
  EXPECT_EQ(message, "3 gnuplot failed to draw the plot: line 2: No data in plot");
}

TEST_F(PlotFile, AnIncompletePictureIsAnError) {
  const std::string message = error_message([&] { run_gnuplot("print 'nothing drawn'\n", folder_ / "a.svg"); });
  EXPECT_NE(message.find("the plot is incomplete"), std::string::npos) << message;
}

TEST_F(PlotFile, DrawsMeasuredScans) {
  GONIOFIT_SKIP_WITHOUT_SHARED_DATA();
  for (const char* name : {"steel_sandblasted_mwir", "curet_10", "ptfe_random", "starlink_chassis"}) {
    const Scan scan = read_scan(*test::shared_data() / "measured" / (std::string(name) + ".csv"));
    Material material = test::garnet_red_paint_13();
    material.channels.resize(1);
    draw(std::string(name) + ".svg", scan, material);
  }
  EXPECT_EQ(names_in(folder_.path()).size(), 4U);
  EXPECT_NE(slurp(folder_ / "steel_sandblasted_mwir.svg").find("8 of 87 incidence angles"), std::string::npos);
  EXPECT_NE(slurp(folder_ / "ptfe_random.svg").find("θᵢ pooled over 10°"), std::string::npos);
}

}  // namespace
}  // namespace goniofit
