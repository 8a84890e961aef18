#include "scan/scan.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/error.h"

namespace goniofit {
namespace {

Scan scan_of(const std::vector<AnglePair>& angles, const std::vector<std::string>& channels) {
  Scan scan;
  scan.source = "s.csv";
  scan.name = "s";
  for (const AnglePair& a : angles) {
    scan.theta_i_deg.push_back(a.theta_i_deg);
    scan.phi_i_deg.push_back(a.phi_i_deg);
    scan.theta_r_deg.push_back(a.theta_r_deg);
    scan.phi_r_deg.push_back(a.phi_r_deg);
  }
  double value = 0.0;
  for (const std::string& name : channels) {
    ScanChannel channel;
    channel.name = name;
    for (std::size_t row = 0; row < angles.size(); ++row) channel.values.push_back(++value);
    scan.channels.push_back(channel);
  }
  return scan;
}

template <class F>
std::string input_message(F&& f) {
  try {
    f();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

std::vector<std::string> names_of_channels(const Scan& scan) {
  std::vector<std::string> names;
  for (const ScanChannel& channel : scan.channels) names.push_back(channel.name);
  return names;
}

using Names = std::vector<std::string>;

struct SideCase {
  AnglePair angles;
  int side;
};

TEST(PlaneSide, IsExactAtTheDirectionsThatMatter) {
  const std::vector<SideCase> cases{
      {{30, 0, 30, 0}, -1},     {{30, 0, 30, 180}, 1},      {{30, 0, 30, -180}, 1},      {{30, 0, 30, 90}, 0},
      {{30, 0, 30, -90}, 0},    {{30, 17, 30, 17}, -1},     {{30, 17, 30, 197}, 1},      {{30, 17, 30, -163}, 1},
      {{30, 350, 50, -10}, -1}, {{30, 350, 50, 170}, 1},    {{30, 0, 50, 360}, -1},      {{30, 720, 50, 0}, -1},
      {{30, 0, 50, 0.5}, -1},   {{30, 0, 50, -0.5}, -1},    {{30, 0, 50, 0.5000001}, 0}, {{30, 0, 50, 179.5}, 1},
      {{30, 0, 50, 180.5}, 1},  {{30, 0, 50, 179.4999}, 0}, {{0, 0, 50, 0}, 1},          {{0, 0, 50, 90}, 1},
      {{30, 0, 0, 0}, 1},       {{30, 0, 0, 77}, 1},        {{0, 0, 0, 0}, 1},           {{90, 0, 90, 0}, -1},
  };
  for (const SideCase& c : cases) {
    const Scan scan = scan_of({c.angles}, {});
    const AnglePair& a = c.angles;
    EXPECT_EQ(scan.plane_side(0), c.side)
        << a.theta_i_deg << ' ' << a.phi_i_deg << ' ' << a.theta_r_deg << ' ' << a.phi_r_deg;
    EXPECT_EQ(scan.signed_theta_r_deg(0), c.side * a.theta_r_deg);
  }
}

TEST(PlaneSide, TheToleranceIsTheCallers) {
  const Scan scan = scan_of({{30, 0, 50, 3}, {30, 0, 50, 177}}, {});
  EXPECT_EQ(scan.plane_side(0, 2.0), 0);
  EXPECT_EQ(scan.plane_side(0, 3.0), -1);
  EXPECT_EQ(scan.plane_side(1, 3.0), 1);
  EXPECT_EQ(scan.plane_side(1, 0.0), 0);
}

TEST(PlaneSide, InPlaneRowsGiveTheirSignBack) {
  for (const double theta_r : {-89.0, -30.0, -1e-9, 1e-9, 45.0, 90.0}) {
    EXPECT_EQ(scan_of({in_plane(30, theta_r)}, {}).signed_theta_r_deg(0), theta_r);
  }
}

TEST(SelectChannels, KeepsTheOrderAskedForAndEverythingElse) {
  Scan scan = scan_of({{1, 2, 3, 4}, {5, 6, 7, 8}}, {"R", "G", "B"});
  scan.solid_angle_sr = 0.001;
  scan.metadata = {{"name", "s"}};
  scan.geometry = ScanGeometry::incidence_plane;
  scan.channels[1].u = {0.1, 0.2};
  const Scan chosen = select_channels(scan, {"b", "g"});
  EXPECT_EQ(names_of_channels(chosen), (Names{"B", "G"}));
  EXPECT_EQ(chosen.channels[0].values, (std::vector<double>{5, 6}));
  EXPECT_EQ(chosen.channels[1].u, (std::vector<double>{0.1, 0.2}));
  EXPECT_EQ(chosen.phi_r_deg, scan.phi_r_deg);
  EXPECT_EQ(chosen.source, "s.csv");
  EXPECT_EQ(chosen.name, "s");
  EXPECT_EQ(chosen.geometry, ScanGeometry::incidence_plane);
  EXPECT_EQ(chosen.solid_angle_sr, 0.001);
  EXPECT_EQ(chosen.metadata, scan.metadata);
}

TEST(SelectChannels, ReadsWavelengthsWithAndWithoutTheUnit) {
  const Scan scan = scan_of({{1, 2, 3, 4}}, {"450nm", "550nm", "632.8nm"});
  EXPECT_EQ(names_of_channels(select_channels(scan, {"550", "450NM", "632.80"})), (Names{"550nm", "450nm", "632.8nm"}));
}

TEST(SelectChannels, NoNamesAreAllChannels) {
  const Scan scan = scan_of({{1, 2, 3, 4}}, {"R", "G"});
  EXPECT_EQ(names_of_channels(select_channels(scan, {})), (Names{"R", "G"}));
}

TEST(SelectChannels, SaysWhichChannelsThereAre) {
  const Scan scan = scan_of({{1, 2, 3, 4}}, {"R", "550nm"});
  EXPECT_EQ(input_message([&] {
              (void)select_channels(scan, {"R", "B"});
            }),
            "s.csv: no channel 'B'; there are R, 550nm");
  EXPECT_EQ(input_message([&] { (void)select_channels(scan, {"55"}); }), "s.csv: no channel '55'; there are R, 550nm");
  EXPECT_EQ(input_message([&] {
              (void)select_channels(scan, {"550", "550nm"});
            }),
            "s.csv: channel 550nm is asked for twice");
}

TEST(Concatenate, AppendsReadingsInOrder) {
  Scan first = scan_of({{1, 2, 3, 4}}, {"R", "G"});
  Scan second = scan_of({{5, 6, 7, 8}, {9, 10, 11, 12}}, {"r", "g"});
  first.channels[0].u = {0.5};
  second.channels[0].u = {0.6, 0.7};
  second.channels[1].n = 1.5;
  second.channels[1].kappa = 0.0;
  second.solid_angle_sr = 0.002;
  second.source = "t.csv";
  const Scan all = concatenate({first, second});
  EXPECT_EQ(all.size(), 3U);
  EXPECT_EQ(all.theta_i_deg, (std::vector<double>{1, 5, 9}));
  EXPECT_EQ(all.phi_i_deg, (std::vector<double>{2, 6, 10}));
  EXPECT_EQ(all.theta_r_deg, (std::vector<double>{3, 7, 11}));
  EXPECT_EQ(all.phi_r_deg, (std::vector<double>{4, 8, 12}));
  EXPECT_EQ(all.channels[0].values, (std::vector<double>{1, 1, 2}));
  EXPECT_EQ(all.channels[0].u, (std::vector<double>{0.5, 0.6, 0.7}));
  EXPECT_EQ(all.channels[1].values, (std::vector<double>{2, 3, 4}));
  EXPECT_EQ(all.channels[1].n, 1.5) << "what only one scan states holds for all";
  EXPECT_EQ(all.solid_angle_sr, 0.002);
  EXPECT_EQ(all.name, "s");
  EXPECT_EQ(all.source, "s.csv, t.csv");
}

TEST(Concatenate, IsIncidencePlaneOnlyWhereAllAre) {
  Scan flat = scan_of({in_plane(30, -20)}, {"R"});
  flat.geometry = ScanGeometry::incidence_plane;
  const Scan round = scan_of({{30, 0, 20, 90}}, {"R"});
  EXPECT_EQ(concatenate({flat, flat}).geometry, ScanGeometry::incidence_plane);
  EXPECT_EQ(concatenate({flat, round}).geometry, ScanGeometry::hemispherical);
  EXPECT_EQ(concatenate({round, flat}).geometry, ScanGeometry::hemispherical);
}

TEST(Concatenate, RefusesScansThatDoNotBelongTogether) {
  const Scan first = scan_of({{1, 2, 3, 4}}, {"R", "G"});
  Scan second = first;
  second.source = "t.csv";
  second.channels[1].name = "B";
  EXPECT_EQ(input_message([&] {
              (void)concatenate({first, second});
            }),
            "t.csv: channels R, B; expected R, G as in the scans before it");
  second = first;
  second.source = "t.csv";
  second.channels[0].u = {0.1};
  EXPECT_EQ(
      input_message([&] {
        (void)concatenate({first, second});
      }),
      "t.csv: column R: has a u_R column unlike the scans before it; expected uncertainties in all of them or in none");
  EXPECT_EQ(input_message([&] {
              (void)concatenate({second, first});
            }),
            "s.csv: column R: has no u_R column unlike the scans before it; expected uncertainties in all of them or "
            "in none");
  Scan red = first;
  red.channels[0].wavelength_um = 0.65;
  Scan infrared = red;
  infrared.channels[0].wavelength_um = 0.66;
  EXPECT_EQ(input_message([&] {
              (void)concatenate({red, infrared});
            }),
            "s.csv: column R: wavelength_um differs from that of the scans before it; expected the same");
  EXPECT_EQ(input_message([] { (void)concatenate({}); }), "no scan is given");
}

}  // namespace
}  // namespace goniofit
