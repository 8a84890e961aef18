#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "io/scan_reader.h"
#include "report/fit_report.h"
#include "report/scan_statistics.h"
#include "support/paths.h"

namespace goniofit {
namespace {

Scan read(const std::string& text) {
  std::istringstream in(text);
  return read_scan(in, "folder/s.csv");
}

bool has_note(const Scan& scan, const std::string& text) {
  for (const std::string& note : scan_notes(scan, scan_statistics(scan))) {
    if (note.find(text) != std::string::npos) return true;
  }
  return false;
}

const std::string hemispherical = "theta_i,phi_i,theta_r,phi_r,R\n";

TEST(ScanStatistics, RangesAndIncidencesAreThoseOfTheReadings) {
  const ScanStatistics s =
      scan_statistics(read("theta_i,theta_r,R\n30,-40,1\n30,20.5,2\n60,80,3\n30,33,4\n60,-57,5\n"));
  EXPECT_EQ(s.theta_i_deg.min, 30);
  EXPECT_EQ(s.theta_i_deg.max, 60);
  EXPECT_EQ(s.theta_r_deg.min, -57);
  EXPECT_EQ(s.theta_r_deg.max, 80);
  ASSERT_EQ(s.incidences.size(), 2U);
  EXPECT_EQ(s.incidences[0].readings, 3U);
  EXPECT_EQ(s.incidences[0].theta_r_deg.min, -40);
  EXPECT_EQ(s.incidences[0].theta_r_deg.max, 33);
  EXPECT_NEAR(s.incidences[0].nearest_mirror_deg, 3.0, 1e-9);
  EXPECT_NEAR(s.incidences[0].nearest_retro_deg, 10.0, 1e-9);
  EXPECT_NEAR(s.incidences[1].nearest_mirror_deg, 20.0, 1e-9);
  EXPECT_NEAR(s.incidences[1].nearest_retro_deg, 3.0, 1e-9);
  EXPECT_EQ(s.forward, 3U);
  EXPECT_EQ(s.retro, 2U);
  EXPECT_FALSE(s.azimuth_gap);
}

// A cap of 60° on the equator of the mirror direction: the distance out of the plane follows from spherical geometry.
TEST(ScanStatistics, DistancesAreAnglesBetweenDirections) {
  const ScanStatistics s = scan_statistics(read(hemispherical + "45,0,45,90,1\n"));
  EXPECT_NEAR(s.incidences[0].nearest_mirror_deg, 60.0, 1e-9) << "cos = cos²45 + sin²45 cos 90 = 1/2";
  EXPECT_NEAR(s.incidences[0].nearest_retro_deg, 60.0, 1e-9);
}

TEST(ScanStatistics, CountsNegativesZerosAndReadingsAtTheHorizon) {
  const Scan scan =
      read(hemispherical + "10,0,90,180,-1\n90,0,10,180,0\n10,0,89.999,180,2\n10,0,20,0,-0.0\n10,0,30,0,4\n");
  const ScanStatistics s = scan_statistics(scan);
  EXPECT_EQ(s.at_horizon, 2U);
  EXPECT_EQ(s.channels[0].negative, 1U);
  EXPECT_EQ(s.channels[0].zero, 2U);
  EXPECT_EQ(s.channels[0].value.min, -1);
  EXPECT_EQ(s.channels[0].value.max, 4);
  EXPECT_EQ(s.channels[0].median, 0);
  EXPECT_TRUE(has_note(scan, "1 of 5 values are negative"));
  EXPECT_TRUE(has_note(scan, "2 of 5 values are exactly 0"));
  EXPECT_TRUE(has_note(scan, "2 of 5 readings are at θ = 90°; fits leave them out"));
}

TEST(ScanStatistics, FindsTheLargestAzimuthGapBetweenLeftAndRightAlike) {
  const ScanStatistics s =
      scan_statistics(read(hemispherical + "10,20,30,20,1\n10,20,30,50,1\n10,20,30,-90,1\n10,20,0,99,1\n"));
  ASSERT_TRUE(s.azimuth_gap);
  EXPECT_EQ(s.azimuth_gap->from_deg, 30);
  EXPECT_EQ(s.azimuth_gap->to_deg, 110);
  EXPECT_EQ(s.left, 1U);
  EXPECT_EQ(s.right, 1U);
  EXPECT_EQ(s.retro, 1U);
  const ScanStatistics open = scan_statistics(read(hemispherical + "10,0,30,0,1\n10,0,30,40,1\n"));
  EXPECT_EQ(open.azimuth_gap->from_deg, 40) << "the interval up to 180° counts";
  EXPECT_EQ(open.azimuth_gap->to_deg, 180);
}

TEST(ScanStatistics, ReciprocityComparesSwappedDirections) {
  // Ratios f(θi < θr) / f(θi > θr): 2, and (1 + 3)/2 over 4 = 0.5; the self-swapped and the lonely ones do not count.
  const Scan scan = read(hemispherical +
                         "10,0,40,60,4\n40,5,10,-55,2\n"
                         "20,0,50,90,1\n20,0,50,-90,3\n50,0,20,90,4\n"
                         "30,0,30,70,9\n60,0,70,10,8\n");
  const ScanStatistics s = scan_statistics(scan);
  EXPECT_EQ(s.reciprocal_pairs, 2U);
  ASSERT_TRUE(s.channels[0].reciprocity);
  EXPECT_EQ(s.channels[0].reciprocity->inner_90.min, 0.5);
  EXPECT_EQ(s.channels[0].reciprocity->inner_90.max, 2.0);
  EXPECT_TRUE(has_note(scan, "swapped directions differ by more than 10 %"));
}

TEST(ScanStatistics, AReciprocalScanIsSaidToBeOne) {
  std::string text = hemispherical;
  for (int i = 10; i <= 70; i += 10) {
    for (int r = 10; r <= 70; r += 10) {
      text += std::to_string(i) + ",0," + std::to_string(r) + ",120," + std::to_string(i * r) + "\n";
    }
  }
  const ScanStatistics s = scan_statistics(read(text));
  EXPECT_EQ(s.reciprocal_pairs, 21U);
  EXPECT_EQ(s.channels[0].reciprocity->median, 1.0);
  EXPECT_EQ(s.channels[0].reciprocity->inner_90.min, 1.0);
  EXPECT_EQ(s.channels[0].reciprocity->inner_90.max, 1.0);
}

TEST(ScanStatistics, RepeatsAreReadingsOfOneDirection) {
  // Two of mean 2 ± 1 (squares 1/4 + 1/4), three alike and two alike at the normal: sqrt(0.5 / (1 + 2 + 1)).
  const ScanStatistics s =
      scan_statistics(read(hemispherical + "10,0,20,90,1\n10,0,20,90,3\n30,0,40,180,10\n30,0,40,-180,10\n30,360,40,180,"
                                           "10\n10,0,20,-90,7\n0,0,0,5,1\n0,9,0,80,1\n"));
  EXPECT_EQ(s.repeated_directions, 3U);
  EXPECT_EQ(s.repeated_readings, 7U);
  ASSERT_TRUE(s.channels[0].repeat_spread);
  EXPECT_NEAR(*s.channels[0].repeat_spread, std::sqrt(0.5 / 4.0), 1e-15);
}

TEST(ScanStatistics, UncertaintiesAreReportedRelativeToTheValues) {
  const ScanStatistics s =
      scan_statistics(read("theta_i,theta_r,R,u_R,G\n10,20,2,0.2,1\n10,30,4,0.1,1\n10,40,1,0.9,1\n10,50,-1,0.5,1\n"));
  ASSERT_TRUE(s.channels[0].relative_u);
  EXPECT_NEAR(*s.channels[0].relative_u, 0.1, 1e-15);
  EXPECT_FALSE(s.channels[1].relative_u);
}

TEST(ScanNotes, NameTheGaps) {
  const Scan forward = read("theta_i,theta_r,R\n30,30,1\n40,44,1\n40,50,1\n");
  EXPECT_TRUE(has_note(forward, "no reading within 2° of the mirror direction at θᵢ = 40°"));
  EXPECT_TRUE(has_note(forward, "no reading within 2° of the retro direction at any θᵢ (nearest 60°)"));
  EXPECT_TRUE(has_note(forward, "no grazing incidence: θᵢ ends at 40°"));
  EXPECT_TRUE(has_note(forward, "no grazing reflection: θᵣ ends at 50°"));
  EXPECT_TRUE(has_note(forward, "forward side only"));
  EXPECT_TRUE(has_note(read("theta_i,theta_r,R\n30,-30,1\n"), "retro side only"));
  EXPECT_TRUE(has_note(read(hemispherical + "10,0,80,20,1\n"), "no reading at |Δφ| between 20° and 180°"));
}

TEST(ScanNotes, HaveNothingToSayOfACompleteScan) {
  std::string text = "theta_i,theta_r,R\n";
  for (int i = 0; i <= 80; i += 10) {
    for (int r = -80; r <= 80; ++r) text += std::to_string(i) + "," + std::to_string(r) + ",1\n";
  }
  const Scan scan = read(text);
  EXPECT_TRUE(scan_notes(scan, scan_statistics(scan)).empty());
  EXPECT_EQ(scan_summary(scan, {}).find("Notes"), std::string::npos);
}

TEST(ScanSummary, IsAPageThatAPersonCanRead) {
  const Scan scan = read(
      "# name: Paint\n# refractive_index: 1.5, 0.96+6.7i\n# solid_angle_sr: 0.001\ntheta_i,theta_r,550nm,R,u_R\n"
      "30,-80,0.5,-1,0.1\n30,30,2,4,0.2\n80,-30,0.25,2,0.2\n80,80,0.5,8,0.8\n30,-30,1,1,0.05\n80,-80,1,1,0.1\n");
  EXPECT_EQ(scan_summary(scan, {}), R"(Paint
  scan          folder/s.csv
  geometry      incidence plane, 6 directions × 2 channels
  θᵢ            30° to 80°, 2 angles
  θᵣ            -80° to 80°, positive on the forward side
  in the plane  2 forward, 4 retro
  at θ = 90°    none
  reciprocity   1 direction read with the swapped pair, |Δφ| alike; ratios below
  repeats       none
  solid angle   0.001 sr

Incidence angles
   θᵢ  readings           θᵣ  mirror within  retro within
  30°         3  -80° to 30°           0.0°          0.0°
  80°         3  -80° to 80°           0.0°          0.0°

Channels
  channel  λ [µm]       n + iκ  least [1/sr]  median  largest  below 0     u  swapped  9 of 10 within
  550nm      0.55          1.5          0.25       1        2                   2.000  2.000 to 2.000
  R                0.96 + 6.7i            -1       2        8        1  10 %

Notes
  · 1 of 12 values are negative; they are kept as noise
  · swapped directions differ by more than 10 % in 1 of 2 channels (median)
)");
}

TEST(ScanSummary, LongListsOfIncidencesAreOneLine) {
  std::string text = "theta_i,theta_r,R\n";
  for (int i = 1; i <= 40; ++i) text += std::to_string(i) + ",0,1\n";
  EXPECT_NE(scan_summary(read(text), {}).find("\n  40 incidence angles, 1 reading each\n"), std::string::npos);
  EXPECT_NE(scan_summary(read(text + "40,1,1\n"), {}).find("\n  40 incidence angles, 1 to 2 readings each\n"),
            std::string::npos);
}

TEST(ScanSummary, TextOfTheFileCannotSteerTheTerminal) {
  const Scan scan = read("# name: a\x1b[2Jb\ntheta_i,theta_r,R\n1,2,3\n");
  EXPECT_EQ(scan_summary(scan, {}).find('\x1b'), std::string::npos);
  EXPECT_NE(scan_summary(scan, {.color = true}).find("\x1b[1m"), std::string::npos) << "our own colours are there";
}

TEST(ScanSummaryJson, HasTheSameNumbers) {
  const Scan scan = read("# name: bytes \xFF\n" + hemispherical + "10,0,40,60,4\n40,5,10,-55,2\n40,5,10,-55,-2\n");
  const nlohmann::json json = nlohmann::json::parse(scan_summary_json(scan));
  EXPECT_EQ(json["geometry"], "hemispherical");
  EXPECT_EQ(json["readings"], 3);
  EXPECT_EQ(json["theta_i_deg"], (nlohmann::json{10.0, 40.0}));
  EXPECT_EQ(json["incidences"][1]["readings"], 2);
  EXPECT_EQ(json["channels"][0]["name"], "R");
  EXPECT_EQ(json["channels"][0]["negative"], 1);
  EXPECT_TRUE(json["channels"][0]["wavelength_um"].is_null());
  EXPECT_TRUE(json["channels"][0]["reciprocity"].is_null()) << "the mean of the swapped readings is 0";
  EXPECT_EQ(json["reciprocal_pairs"], 1);
  EXPECT_EQ(json["repeated_readings"], 2);
  EXPECT_EQ(json["coverage"]["azimuth_gap_deg"], (nlohmann::json{60.0, 180.0}));
  EXPECT_EQ(json["notes"].size(), scan_notes(scan, scan_statistics(scan)).size());
}

TEST(MeasuredScanSummaries, SayWhatIsKnownOfTheScans) {
  GONIOFIT_SKIP_WITHOUT_SHARED_DATA();
  const std::filesystem::path folder = *test::shared_data() / "measured";
  EXPECT_TRUE(has_note(read_scan(folder / "black_anodise_ec1.csv"), "retro direction at any θᵢ"));
  EXPECT_TRUE(has_note(read_scan(folder / "steel_sandblasted_mwir.csv"), "forward side only"));
  EXPECT_TRUE(has_note(read_scan(folder / "krylon_blue.csv"), "clamped"));
  EXPECT_NEAR(*scan_statistics(read_scan(folder / "ptfe.csv")).channels[1].repeat_spread, 0.011, 0.001);
}

}  // namespace
}  // namespace goniofit
