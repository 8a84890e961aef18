#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cmath>
#include <locale>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "io/scan_reader.h"
#include "support/error_message.h"
#include "support/paths.h"

namespace goniofit {
namespace {

using test::error_message;

std::string written(const Scan& scan, int digits = 17) {
  std::ostringstream out;
  write_scan(out, scan, digits);
  return out.str();
}

Scan read(const std::string& text) {
  std::istringstream in(text);
  return read_scan(in, "s.csv");
}

bool same_channel(const ScanChannel& a, const ScanChannel& b) {
  return a.name == b.name && a.wavelength_um == b.wavelength_um && a.n == b.n && a.kappa == b.kappa &&
         a.values == b.values && a.u == b.u;
}

// Everything but the metadata lines, which a written file may have more of.
bool same_scan(const Scan& a, const Scan& b) {
  return a.name == b.name && a.geometry == b.geometry && a.theta_i_deg == b.theta_i_deg && a.phi_i_deg == b.phi_i_deg &&
         a.theta_r_deg == b.theta_r_deg && a.phi_r_deg == b.phi_r_deg && a.solid_angle_sr == b.solid_angle_sr &&
         std::equal(a.channels.begin(), a.channels.end(), b.channels.begin(), b.channels.end(), same_channel);
}

rc::Gen<double> between(double low, double high) {
  return rc::gen::map(rc::gen::inRange<std::int64_t>(0, (std::int64_t{1} << 53) + 1), [=](std::int64_t i) {
    return std::fmin(high, low + (high - low) * (static_cast<double>(i) / static_cast<double>(std::int64_t{1} << 53)));
  });
}

// Any finite double, subnormals and -0 included.
rc::Gen<double> any_value() {
  return rc::gen::map(rc::gen::suchThat(rc::gen::arbitrary<std::uint64_t>(),
                                        [](std::uint64_t bits) { return std::isfinite(std::bit_cast<double>(bits)); }),
                      [](std::uint64_t bits) { return std::bit_cast<double>(bits); });
}

template <class T>
std::optional<T> maybe(const rc::Gen<T>& gen) {
  return *rc::gen::arbitrary<bool>() ? std::optional<T>(*gen) : std::nullopt;
}

ScanChannel any_channel(const std::string& name, std::optional<double> wavelength_um, std::size_t rows) {
  ScanChannel channel;
  channel.name = name;
  channel.wavelength_um = wavelength_um;
  channel.n = maybe(between(0.01, 5.0));
  if (channel.n) channel.kappa = *rc::gen::element(0.0, *between(0.0, 10.0));
  channel.values = *rc::gen::container<std::vector<double>>(rows, any_value());
  if (*rc::gen::arbitrary<bool>()) channel.u = *rc::gen::container<std::vector<double>>(rows, between(1e-300, 1.0));
  return channel;
}

void add_angles(Scan& scan) {
  const double theta_i = *rc::gen::oneOf(between(0.0, 90.0), rc::gen::element(0.0, 30.0, 90.0));
  const double theta_r = *rc::gen::oneOf(between(0.0, 90.0), rc::gen::element(0.0, 30.0, 90.0));
  const bool in_the_plane = scan.geometry == ScanGeometry::incidence_plane;
  const double sign = *rc::gen::element(-1.0, 1.0);
  const AnglePair a = in_the_plane ? in_plane(theta_i, sign * theta_r)
                                   : AnglePair{theta_i, *between(-360, 360), theta_r, *between(-360, 360)};
  // -0 is written as 0, which is on the forward side by convention.
  scan.theta_i_deg.push_back(a.theta_i_deg);
  scan.phi_i_deg.push_back(a.phi_i_deg);
  scan.theta_r_deg.push_back(a.theta_r_deg);
  scan.phi_r_deg.push_back(a.phi_r_deg);
}

Scan any_scan() {
  Scan scan;
  scan.name = *rc::gen::element<std::string>("paint", "A name, with: all, sorts; of # signs", "Grün µm");
  scan.geometry = *rc::gen::element(ScanGeometry::hemispherical, ScanGeometry::incidence_plane);
  scan.solid_angle_sr = maybe(between(1e-6, 6.0));
  const auto rows = *rc::gen::inRange<std::size_t>(1, 12);
  for (std::size_t row = 0; row < rows; ++row) add_angles(scan);
  const std::vector<std::pair<std::string, std::optional<double>>> kinds{
      {"R", maybe(between(0.1, 20.0))}, {"550nm", 0.55}, {"632.8nm", 0.6328}, {"Band 1", maybe(between(0.1, 20.0))}};
  for (const auto& [name, wavelength] : kinds) {
    if (scan.channels.empty() || *rc::gen::arbitrary<bool>())
      scan.channels.push_back(any_channel(name, wavelength, rows));
  }
  return scan;
}

RC_GTEST_PROP(ScanWriter, WhatIsWrittenIsReadBackIdentically, ()) {
  const Scan scan = any_scan();
  const std::string text = written(scan);
  RC_ASSERT(same_scan(read(text), scan));
}

RC_GTEST_PROP(ScanWriter, WritingAgainChangesNothing, ()) {
  const std::string once = written(any_scan());
  RC_ASSERT(written(read(once)) == once);
}

TEST(ScanWriter, WritesTheColumnsOfEachGeometry) {
  const std::string flat = "# goniofit-scan: 1\n# name: s\ntheta_i,theta_r,R,u_R\n30,-45,0.125,0.5\n0,-20,1,0.25\n";
  EXPECT_EQ(written(read(flat)), flat) << "at theta_i = 0 the sign of theta_r stays too";
  const std::string round =
      "# goniofit-scan: 1\n# name: s\n# operator: "
      "me\ntheta_i,phi_i,theta_r,phi_r,B,400nm,u_400nm\n30,5,45,-175,0.125,2,0.5\n";
  EXPECT_EQ(written(read(round)), round);
}

TEST(ScanWriter, KeepsMetadataAsTheyStoodWhileTheyHold) {
  const std::string head =
      "# goniofit-scan: 1\n# Refractive_Index: 1.50, 1.70+0.10i\n# date: 2004-05-06\n# wavelength_um: 0.650, none\n# "
      "name: n\n";
  const std::string body = "theta_i,theta_r,R,G\n30,-45,1,2\n";
  Scan scan = read(head + body);
  EXPECT_EQ(written(scan), head + body);
  scan.channels[1].kappa = 0.2;
  scan.channels.front().wavelength_um = std::nullopt;
  scan.name = "two\nlines";
  EXPECT_EQ(written(scan),
            "# goniofit-scan: 1\n# Refractive_Index: 1.5, 1.7+0.2i\n# date: 2004-05-06\n# name: two lines\n" + body);
}

TEST(ScanWriter, ASelectionOfChannelsIsReadBack) {
  const Scan scan = read(
      "# refractive_index: 1.5, 1.6, 1.7\n# wavelength_um: 0.65, 0.55, 0.45\n# channels: "
      "Y\ntheta_i,theta_r,R,Y,B\n1,2,3,4,5\n");
  const Scan chosen = select_channels(scan, {"B", "Y"});
  const Scan back = read(written(chosen));
  EXPECT_TRUE(same_scan(back, chosen));
  EXPECT_EQ(back.channels[0].n, 1.7);
  EXPECT_EQ(back.channels[1].wavelength_um, 0.55);
}

TEST(ScanWriter, RoundsToTheDigitsAskedFor) {
  const Scan scan = read("theta_i,theta_r,R\n10.123456789012,20,0.123456789012\n");
  EXPECT_NE(written(scan, 9).find("\n10.1234568,20,0.123456789\n"), std::string::npos) << written(scan, 9);
  EXPECT_NE(written(scan, 3).find("\n10.1,20,0.123\n"), std::string::npos);
}

// Germans write 1.234,5: no language must reach the files.
class GermanNumbers : public std::numpunct<char> {
 protected:
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(ScanWriter, TheLocaleChangesNothing) {
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new GermanNumbers));
  const std::string text =
      "# goniofit-scan: 1\n# name: s\n# refractive_index: 1.5+0.25i\ntheta_i,theta_r,4000nm\n10.5,-20.25,1234.5\n";
  std::ostringstream check;
  check << 1234.5;
  const std::string result = written(read(text));
  std::locale::global(before);
  EXPECT_EQ(check.str(), "1.234,5") << "the locale is in force";
  EXPECT_EQ(result, text);
}

TEST(ScanWriter, RefusesWhatTheFormatCannotHold) {
  Scan scan = read("theta_i,theta_r,R\n10,20,1\n");
  Scan bent = scan;
  bent.phi_r_deg[0] = 90.0;
  EXPECT_EQ(
      error_message([&] { (void)written(bent); }),
      "2 s.csv: column theta_r: reading 1 is out of the plane of incidence; expected none in an incidence-plane scan");
  for (const char* name : {"", "a,b", "a;b", "a\"b", "#a", " a", "a\n", "Theta_i", "u_R"}) {
    scan.channels[0].name = name;
    EXPECT_NE(error_message([&] { (void)written(scan); }).find("is no channel name that a scan file can have"),
              std::string::npos)
        << name;
  }
}

TEST(ScanWriter, KeepsMeasuredScansIdentical) {
  GONIOFIT_SKIP_WITHOUT_SHARED_DATA();
  for (const char* name :
       {"krylon_blue.csv", "starlink_chassis.csv", "ptfe.csv", "curet_10.csv", "gray_retro_tape.csv"}) {
    const Scan scan = read_scan(*test::shared_data() / "measured" / name);
    const Scan back = read(written(scan));
    EXPECT_TRUE(same_scan(back, scan)) << name;
    EXPECT_EQ(back.metadata, scan.metadata) << name;
  }
}

}  // namespace
}  // namespace goniofit
