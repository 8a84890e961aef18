#include "io/scan_reader.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "support/error.h"
#include "support/error_message.h"
#include "support/paths.h"

namespace goniofit {
namespace {

using test::error_message;
using test::ScratchDir;
using Values = std::vector<double>;

Scan read(const std::string& text, const ScanReadOptions& options = {}) {
  std::istringstream in(text);
  return read_scan(in, "s.csv", options);
}

std::vector<std::string> names_of_channels(const Scan& scan) {
  std::vector<std::string> names;
  for (const ScanChannel& channel : scan.channels) names.push_back(channel.name);
  return names;
}

const std::string hemispherical = "theta_i,phi_i,theta_r,phi_r,R,G,B\n";
const std::string in_plane_header = "theta_i,theta_r,R\n";

TEST(ScanReader, ReadsAHemisphericalScan) {
  const Scan scan = read("# name: Red paint\n# solid_angle_sr: 0.001\n" + hemispherical +
                         "10,0,20,180,0.5,0.25,-0.125\n30,5,90,-170,1e-3,.5,0\n");
  EXPECT_EQ(scan.source, "s.csv");
  EXPECT_EQ(scan.name, "Red paint");
  EXPECT_EQ(scan.geometry, ScanGeometry::hemispherical);
  EXPECT_EQ(scan.solid_angle_sr, 0.001);
  EXPECT_EQ(scan.theta_i_deg, (Values{10, 30}));
  EXPECT_EQ(scan.phi_i_deg, (Values{0, 5}));
  EXPECT_EQ(scan.theta_r_deg, (Values{20, 90}));
  EXPECT_EQ(scan.phi_r_deg, (Values{180, -170}));
  EXPECT_EQ(names_of_channels(scan), (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(scan.channels[0].values, (Values{0.5, 0.001}));
  EXPECT_EQ(scan.channels[2].values, (Values{-0.125, 0.0})) << "noise below 0 is kept";
  EXPECT_FALSE(scan.channels[0].wavelength_um);
  EXPECT_TRUE(scan.channels[0].u.empty());
}

TEST(ScanReader, ReadsAnIncidencePlaneScanWithSignedTheta) {
  const Scan scan = read(in_plane_header + "30,-45,1\n30,0,2\n30,-0,3\n30,45,4\n30,-90,5\n");
  EXPECT_EQ(scan.geometry, ScanGeometry::incidence_plane);
  EXPECT_EQ(scan.theta_r_deg, (Values{45, 0, 0, 45, 90}));
  EXPECT_EQ(scan.phi_i_deg, (Values{0, 0, 0, 0, 0}));
  EXPECT_EQ(scan.phi_r_deg, (Values{0, 180, 180, 180, 0}));
}

TEST(ScanReader, TheNameIsTheFilesStemWhereTheMetadataHasNone) {
  EXPECT_EQ(read(in_plane_header + "1,2,3\n").name, "s");
}

struct Variant {
  const char* what;
  std::string text;
};

// Every spelling of the same two readings.
TEST(ScanReader, AcceptsEverySpellingOfTheSameScan) {
  const std::vector<Variant> variants{
      {"plain", hemispherical + "10,0,20,180,1,2,3\n40,0,50,90,4,5,6\n"},
      {"no last newline", hemispherical + "10,0,20,180,1,2,3\n40,0,50,90,4,5,6"},
      {"CRLF", "theta_i,phi_i,theta_r,phi_r,R,G,B\r\n10,0,20,180,1,2,3\r\n40,0,50,90,4,5,6\r\n"},
      {"byte-order mark", "\xEF\xBB\xBF" + hemispherical + "10,0,20,180,1,2,3\n40,0,50,90,4,5,6\n"},
      {"blank lines", "\n \n" + hemispherical + "\n10,0,20,180,1,2,3\n\t\n\n40,0,50,90,4,5,6\n\n"},
      {"trailing commas", "theta_i,phi_i,theta_r,phi_r,R,G,B,,\n10,0,20,180,1,2,3,,,,\n40,0,50,90,4,5,6,\n,,,,\n"},
      {"later comments", hemispherical + "10,0,20,180,1,2,3\n# a remark: here\n  # and here\n40,0,50,90,4,5,6\n"},
      {"blanks around", "theta_i , phi_i, theta_r, phi_r , R, G,B\n 10, 0,20 ,180,1 ,2,3\n40,0,50,90,4,5,6 \n"},
      {"semicolons", "theta_i;phi_i;theta_r;phi_r;R;G;B\n10;0;20;180;1;2;3\n40;0;50;90;4;5;6\n"},
      {"tabs", "theta_i\tphi_i\ttheta_r\tphi_r\tR\tG\tB\n10\t0\t20\t180\t1\t2\t3\n40\t0\t50\t90\t4\t5\t6\n"},
      {"blanks between", "  theta_i phi_i  theta_r phi_r R G B\n10   0 20 180 1 2  3  \n 40 0 50 90\t4 5 6\n"},
      {"any case", "THETA_I,Phi_I,theta_R,pHi_r,r,g,b\n10,0,20,180,1,2,3\n40,0,50,90,4,5,6\n"},
      {"any order", "B,phi_r,G,theta_r,R,phi_i,theta_i\n3,180,2,20,1,0,10\n6,90,5,50,4,0,40\n"},
      {"quotes",
       "\"theta_i\",\"phi_i\",\"theta_r\",\"phi_r\",\"R\",\"G\",\"B\"\n\"10\",0,20,180,1,2,3\n40,0,50,90,4,5,6\n"},
      {"plus signs", hemispherical + "+10,0,+2e+1,180,1.0,2.,3\n4E1,-0,50,90,4,5,06\n"},
  };
  for (const Variant& variant : variants) {
    const Scan scan = read(variant.text);
    EXPECT_EQ(scan.geometry, ScanGeometry::hemispherical) << variant.what;
    EXPECT_EQ(scan.theta_i_deg, (Values{10, 40})) << variant.what;
    EXPECT_EQ(scan.phi_i_deg, (Values{0, 0})) << variant.what;
    EXPECT_EQ(scan.theta_r_deg, (Values{20, 50})) << variant.what;
    EXPECT_EQ(scan.phi_r_deg, (Values{180, 90})) << variant.what;
    const Scan rgb = select_channels(scan, {"R", "G", "B"});
    EXPECT_EQ(rgb.channels[0].values, (Values{1, 4})) << variant.what;
    EXPECT_EQ(rgb.channels[1].values, (Values{2, 5})) << variant.what;
    EXPECT_EQ(rgb.channels[2].values, (Values{3, 6})) << variant.what;
  }
}

TEST(ScanReader, SpectralColumnsStateTheirWavelengthExactly) {
  const Scan scan = read("theta_i,theta_r,400nm,632.8NM,0555 nm,4000nm\n1,2,3,4,5,6\n");
  EXPECT_EQ(names_of_channels(scan), (std::vector<std::string>{"400nm", "632.8nm", "0555nm", "4000nm"}));
  EXPECT_EQ(scan.channels[0].wavelength_um, 0.4);
  EXPECT_EQ(scan.channels[1].wavelength_um, 0.6328);
  EXPECT_EQ(scan.channels[2].wavelength_um, 0.555);
  EXPECT_EQ(scan.channels[3].wavelength_um, 4.0);
}

TEST(ScanReader, MetadataGoToTheChannelsInTheOrderOfTheColumns) {
  const Scan scan = read(
      "# remark without a key\n# see https://example.org/a:b\n#Refractive_Index: 0.618 + 5.47i, "
      "0.958+6.69i,1.47+7.79i,,,\n"
      "# wavelength_um: 0.45, none, .65\n# operator: someone: me\n# remark, with a: "
      "colon\ntheta_i,theta_r,B,G,R\n1,2,3,4,5\n"
      "# name: too late\n");
  ASSERT_EQ(scan.channels.size(), 3U);
  EXPECT_EQ(scan.channels[0].n, 0.618);
  EXPECT_EQ(scan.channels[0].kappa, 5.47);
  EXPECT_EQ(scan.channels[2].n, 1.47);
  EXPECT_EQ(scan.channels[2].kappa, 7.79);
  EXPECT_EQ(scan.channels[0].wavelength_um, 0.45);
  EXPECT_FALSE(scan.channels[1].wavelength_um);
  EXPECT_EQ(scan.channels[2].wavelength_um, 0.65);
  EXPECT_EQ(scan.name, "s");
  using Entry = std::pair<std::string, std::string>;
  EXPECT_EQ(scan.metadata, (std::vector<Entry>{{"Refractive_Index", "0.618 + 5.47i, 0.958+6.69i,1.47+7.79i"},
                                               {"wavelength_um", "0.45, none, .65"},
                                               {"operator", "someone: me"}}));
}

TEST(ScanReader, OneMetadataValueIsForEveryChannel) {
  const Scan scan = read("# refractive_index: 1.7\n# wavelength_um: 0.55\ntheta_i,theta_r,R,550nm\n1,2,3,4\n");
  for (const ScanChannel& channel : scan.channels) {
    EXPECT_EQ(channel.n, 1.7);
    EXPECT_EQ(channel.kappa, 0.0);
    EXPECT_EQ(channel.wavelength_um, 0.55);
  }
}

TEST(ScanReader, UncertaintiesBelongToTheirChannels) {
  const Scan scan = read("theta_i,theta_r,U_550NM,R,550nm,u_r\n1,2,.1,3,4,.2\n1,3,.3,5,6,.4\n");
  EXPECT_EQ(scan.channels[0].u, (Values{0.2, 0.4}));
  EXPECT_EQ(scan.channels[1].u, (Values{0.1, 0.3}));
  EXPECT_EQ(scan.channels[1].values, (Values{4, 6}));
}

TEST(ScanReader, ListedColumnsAreChannelsToo) {
  const Scan scan = read("# channels: band 1, lumen\ntheta_i,theta_r,Lumen,R,Band 1,u_band 1\n1,2,3,4,5,6\n");
  EXPECT_EQ(names_of_channels(scan), (std::vector<std::string>{"Lumen", "R", "Band 1"}));
  EXPECT_EQ(scan.channels[2].values, (Values{5}));
  EXPECT_EQ(scan.channels[2].u, (Values{6}));
}

TEST(ScanReader, UnknownColumnsMayBeLeftOut) {
  const Scan scan =
      read("idx,theta_i,theta_r,R,u_G,note\n0,1,2,3,nan,\"a, b\"\n1,1,3,4,,x\n", {.ignore_unknown_columns = true});
  EXPECT_EQ(names_of_channels(scan), (std::vector<std::string>{"R"}));
  EXPECT_EQ(scan.channels[0].values, (Values{3, 4}));
  EXPECT_EQ(scan.theta_r_deg, (Values{2, 3}));
}

TEST(ScanReader, AnglesAreAcceptedUpToExactlyNinetyDegrees) {
  EXPECT_EQ(read(in_plane_header + "90,-90,1\n0,90,1\n").size(), 2U);
  EXPECT_EQ(error_message([] { (void)read(in_plane_header + "90.00000000000003,0,1\n"); }),
            "2 s.csv:2: column theta_i: \"90.00000000000003\" is out of range; expected an angle from 0 to 90 degrees");
}

struct BadScan {
  const char* what;
  std::string text;
  std::string message;
};

const std::string angles_expected =
    "is missing; expected theta_i, phi_i, theta_r, phi_r (hemispherical) or theta_i, theta_r (incidence plane, theta_r "
    "signed)";
const std::string value_expected = "; expected a BRDF value in 1/sr";
const std::string theta_expected = "; expected an angle from 0 to 90 degrees";

std::vector<BadScan> bad_files() {
  const std::string names = "; expected names such as theta_i,phi_i,theta_r,phi_r,R,G,B or theta_i,theta_r,R,G,B";
  return {
      {"empty file", "", "s.csv: there is no header line" + names},
      {"only comments", "# name: x\n\n", "s.csv: there is no header line" + names},
      {"only padding", ",,,\n;;\n", "s.csv: there is no header line" + names},
      {"numbers first", "10,0,20,180,1,2,3\n", "s.csv:1: there is no header line before the numbers" + names},
      {"no reading", "\n" + in_plane_header + "# nothing\n,,\n",
       "s.csv:2: there is no row after the header line; expected one a reading"},
      {"UTF-16", std::string("\xFF\xFEt\0h\0\n\0", 8), "s.csv:1: the text is UTF-16; expected UTF-8"},
      {"endless line", in_plane_header + std::string((1 << 20) + 10, '1'),
       "s.csv:2: the line is longer than 1 MiB; expected text with one reading a line"},
      {"endless header", std::string((1 << 20) + 10, 't'),
       "s.csv:1: the line is longer than 1 MiB; expected text with one reading a line"},
  };
}

std::vector<BadScan> bad_headers() {
  const std::string channels =
      "s.csv:1: there is no channel column; expected R, G, B, a wavelength such as 550nm, or names listed by '# "
      "channels: a, b'";
  const std::string unknown =
      ": is unknown; expected angles, R, G, B, a wavelength such as 550nm, u_CHANNEL, or names listed by '# channels: "
      "a, b' "
      "(--ignore-columns leaves others out)";
  return {
      {"no theta_i", "phi_i,theta_r,phi_r,R\n", "s.csv:1: column theta_i: " + angles_expected},
      {"no theta_r", "theta_i,phi_i,phi_r,R\n", "s.csv:1: column theta_r: " + angles_expected},
      {"no phi_r", "theta_i,phi_i,theta_r,R\n", "s.csv:1: column phi_r: " + angles_expected},
      {"no phi_i", "# c\ntheta_i,theta_r,phi_r,R\n", "s.csv:2: column phi_i: " + angles_expected},
      {"angle twice", "theta_i,theta_r,R,THETA_I\n",
       "s.csv:1: column THETA_I: is in the header line twice, as columns 1 and 4; expected each column once"},
      {"channel twice", "theta_i,theta_r,R,G,r\n",
       "s.csv:1: column r: is in the header line twice, as columns 3 and 5; expected each column once"},
      {"wavelength twice", "theta_i,theta_r,550nm,550.0NM\n",
       "s.csv:1: column 550.0NM: is in the header line twice, as columns 3 and 4; expected each column once"},
      {"no channel", "theta_i,theta_r\n", channels},
      {"unknown column", "theta_i,theta_r,R,value\n", "s.csv:1: column value" + unknown},
      {"other unit", "theta_i,theta_r,0.55um,R\n", "s.csv:1: column 0.55um" + unknown},
      {"control characters", "theta_i,theta_r,R,\x1b[31mred\n", "s.csv:1: column ?[31mred" + unknown},
      {"u without channel", "theta_i,theta_r,R,u_G\n",
       "s.csv:1: column u_G: is an uncertainty without its channel; expected a column G"},
      {"u twice", "theta_i,theta_r,R,u_R,U_r\n",
       "s.csv:1: column U_r: is in the header line twice, as columns 4 and 5; expected each column once"},
      {"unnamed column", "theta_i,theta_r,,R\n", "s.csv:1: column 3: has no name; expected one in the header line"},
      {"absurd wavelength", "theta_i,theta_r,5nm\n",
       "s.csv:1: column 5nm: the wavelength is out of range; expected 0.01 to 100 micrometres (10 to 100000 nm)"},
  };
}

std::vector<BadScan> bad_rows() {
  const std::string row = "10,0,20,180,1,2,3\n";
  const std::string h = hemispherical + row;
  return {
      {"text", h + "10,0,20,180,1,abc,3\n", "s.csv:3: column G: \"abc\" is not a number" + value_expected},
      {"number and text", h + "10,0,20,180,1,2x,3\n", "s.csv:3: column G: \"2x\" is not a number" + value_expected},
      {"hexadecimal", h + "10,0,20,180,0x10,2,3\n", "s.csv:3: column R: \"0x10\" is not a number" + value_expected},
      {"two signs", h + "10,0,20,180,+-1,2,3\n", "s.csv:3: column R: \"+-1\" is not a number" + value_expected},
      {"not a number", h + "10,0,20,180,1,2,NaN\n", "s.csv:3: column B: \"NaN\" is not finite" + value_expected},
      {"infinity", h + "10,0,20,180,-inf,2,3\n", "s.csv:3: column R: \"-inf\" is not finite" + value_expected},
      {"overflow", h + "10,0,20,180,1e999,2,3\n", "s.csv:3: column R: \"1e999\" is too large" + value_expected},
      {"NaN angle", h + "10,nan,20,180,1,2,3\n",
       "s.csv:3: column phi_i: \"nan\" is not finite; expected an angle in degrees"},
      {"empty field", h + "10,0,,180,1,2,3\n", "s.csv:3: column theta_r: the field is empty" + theta_expected},
      {"empty last field", h + "10,0,20,180,1,2,\n", "s.csv:3: column B: the field is empty" + value_expected},
      {"short row", h + "\n10,0,20,180,1\n",
       "s.csv:4: column G: the row ends before it, after 5 of 7 fields; expected one field a column"},
      {"long row", h + "10,0,20,180,1,2,3,,4\n",
       "s.csv:3: column 9: \"4\" stands beyond the last column B; expected 7 fields as in the header line"},
      {"theta_i above 90", h + "90.5,0,20,180,1,2,3\n",
       "s.csv:3: column theta_i: \"90.5\" is out of range" + theta_expected},
      {"theta_r above 90", h + "10,0,120,180,1,2,3\n",
       "s.csv:3: column theta_r: \"120\" is out of range" + theta_expected},
      {"negative theta_i", h + "-10,0,20,180,1,2,3\n",
       "s.csv:3: column theta_i: \"-10\" is out of range" + theta_expected},
      {"signed theta_r between phi columns", h + "10,0,-20,180,1,2,3\n",
       "s.csv:3: column theta_r: \"-20\" is out of range" + theta_expected +
           " (a signed theta_r goes with a scan without phi columns)"},
      {"in-plane theta_r below -90", in_plane_header + "10,-91,1\n",
       "s.csv:2: column theta_r: \"-91\" is out of range; expected a signed angle from -90 to 90 degrees"},
      {"in-plane negative theta_i", in_plane_header + "-1,0,1\n",
       "s.csv:2: column theta_i: \"-1\" is out of range" + theta_expected},
      {"decimal comma", "theta_i;theta_r;R\n10;20;0,125\n",
       "s.csv:2: column R: \"0,125\" has a decimal comma; expected a decimal point, 0.125"},
      {"negative uncertainty", "theta_i,theta_r,R,u_R\n1,2,3,-0.1\n",
       "s.csv:2: column u_R: \"-0.1\" is out of range; expected a standard uncertainty above 0 in 1/sr"},
      {"zero uncertainty", "theta_i,theta_r,R,u_R\n1,2,3,0\n",
       "s.csv:2: column u_R: \"0\" is out of range; expected a standard uncertainty above 0 in 1/sr"},
      {"NaN uncertainty", "theta_i,theta_r,R,u_R\n1,2,3,nan\n",
       "s.csv:2: column u_R: \"nan\" is not finite; expected a standard uncertainty above 0 in 1/sr"},
      {"other separator in the rows", in_plane_header + "1;2;3\n",
       "s.csv:2: column theta_r: the row ends before it, after 1 of 3 fields; expected one field a column"},
      {"zero byte", in_plane_header + std::string("1,2,3\0\n", 7),
       "s.csv:2: column R: \"3?\" is not a number" + value_expected},
      {"open quote", in_plane_header + "1,2,\"3\n", "s.csv:2: column R: \"\"3\" is not a number" + value_expected},
  };
}

std::vector<BadScan> bad_metadata() {
  const std::string table = "\n" + in_plane_header + "1,2,3\n";
  const std::string rg = "\ntheta_i,theta_r,R,G\n1,2,3,4\n";
  const std::string index = "; expected n or n+kappa*i, such as 1.7 or 0.958+6.69i";
  return {
      {"index", "# refractive_index: glass" + table, "s.csv:1: refractive_index: \"glass\" is not a number" + index},
      {"index without sum", "#refractive_index: 6.69i" + table,
       "s.csv:1: refractive_index: \"6.69i\" is not a number" + index},
      {"index with a wrong kappa", "# refractive_index: 1.5+xi" + table,
       "s.csv:1: refractive_index: \"+x\" is not a number" + index},
      {"index without value", "# refractive_index:" + table, "s.csv:1: refractive_index: the field is empty" + index},
      {"n of 0", "# refractive_index: 0" + table,
       "s.csv:1: refractive_index: \"0\" is out of range; expected n above 0"},
      {"NaN n", "# refractive_index: nan+1i" + table,
       "s.csv:1: refractive_index: \"nan+1i\" is out of range; expected n above 0"},
      {"kappa of the other convention", "# refractive_index: 1.47-7.79i" + table,
       "s.csv:1: refractive_index: \"1.47-7.79i\" is out of range; expected kappa from 0 up (absorption is n+kappa*i)"},
      {"three for two", "# x: y\n# refractive_index: 1,2,3" + rg,
       "s.csv:2: refractive_index: 3 values for 2 channels; expected one, or one a channel"},
      {"two for one", "# wavelength_um: .5,.6" + table,
       "s.csv:1: wavelength_um: 2 values for 1 channel; expected one, or one a channel"},
      {"nanometres", "# wavelength_um: 650" + table,
       "s.csv:1: wavelength_um: the wavelength is out of range; expected 0.01 to 100 micrometres (10 to 100000 nm)"},
      {"contradiction", "# wavelength_um: 0.56\ntheta_i,theta_r,550nm\n1,2,3\n",
       "s.csv:1: wavelength_um: the value for channel 550nm contradicts its name; expected the same wavelength"},
      {"solid angle", "# solid_angle_sr: 0" + table,
       "s.csv:1: solid_angle_sr: \"0\" is out of range; expected a solid angle above 0 and up to 2 pi sr"},
      {"twice", "# Name: a\n# name: b" + table, "s.csv:2: name: is given twice; expected it once"},
      {"later version", "# goniofit-scan: 2" + table,
       "s.csv:1: goniofit-scan: \"2\" is a version this program does not know; expected 1"},
      {"listed channel without a column", "# channels: lumen" + table,
       "s.csv:2: column lumen: is listed by '# channels:' and is no channel column; expected it in the header line"},
      {"empty list", "# channels: a,,b" + table,
       "s.csv:1: channels: an entry is empty; expected column names separated by commas"},
  };
}

class BadScans : public ::testing::TestWithParam<BadScan> {};

TEST_P(BadScans, AreRefusedWithTheirLineAndColumn) {
  EXPECT_EQ(error_message([] { (void)read(GetParam().text); }), "2 " + GetParam().message);
}

std::string test_name(const ::testing::TestParamInfo<BadScan>& info) {
  std::string name;
  for (const char c : std::string(info.param.what)) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(Files, BadScans, ::testing::ValuesIn(bad_files()), test_name);
INSTANTIATE_TEST_SUITE_P(Headers, BadScans, ::testing::ValuesIn(bad_headers()), test_name);
INSTANTIATE_TEST_SUITE_P(Rows, BadScans, ::testing::ValuesIn(bad_rows()), test_name);
INSTANTIATE_TEST_SUITE_P(Metadata, BadScans, ::testing::ValuesIn(bad_metadata()), test_name);

TEST(ScanReader, ALineOfExactlyOneMebibyteIsRead) {
  const std::string row = "1,2,";
  const std::string text = in_plane_header + row + std::string((1U << 20) - row.size() - 1, '0') + "7\n1,2,3\n";
  EXPECT_EQ(read(text).channels[0].values, (Values{7, 3}));
}

TEST(ScanReader, AWideHeaderTakesNoQuadraticTime) {
  std::string header = "theta_i,theta_r";
  std::string row = "\n1,2";
  for (int i = 10000; i < 60000; ++i) {
    header.append(",").append(std::to_string(i)).append("nm");
    row += ",1";
  }
  EXPECT_EQ(read(header + row).channels.size(), 50000U);
}

TEST(ScanReader, MissingFilesAndFoldersAreBadInput) {
  const ScratchDir dir;
  EXPECT_EQ(error_message([&] { (void)read_scan(dir / "none.csv"); }),
            "2 " + (dir / "none.csv").string() + ": cannot be read: No such file or directory");
  EXPECT_EQ(error_message([&] { (void)read_scan(dir.path()); }),
            "2 " + dir.path().string() + ": cannot be read: Is a directory");
}

// Delivers a while, then fails as a broken disk does.
class BreakingBuffer : public std::streambuf {
 public:
  explicit BreakingBuffer(std::string content) : content_(std::move(content)) {}

 protected:
  int_type underflow() override {
    if (done_) throw std::runtime_error("broken");
    done_ = true;
    setg(content_.data(), content_.data(), content_.data() + content_.size());
    return traits_type::to_int_type(content_.front());
  }

 private:
  std::string content_;
  bool done_ = false;
};

TEST(ScanReader, ReadingThatBreaksOffIsASystemError) {
  BreakingBuffer buffer(in_plane_header + "1,2,3\n1,2,");
  std::istream in(&buffer);
  EXPECT_EQ(error_message([&] { (void)read_scan(in, "s.csv"); }), "3 cannot read s.csv: Input/output error");
}

TEST(ScanReader, ReadsThroughAPathAndAcrossManyBuffers) {
  const ScratchDir dir;
  constexpr int rows = 60000;  // 1.5 MB: the buffer is refilled in the middle of lines
  {
    std::ofstream out(dir / "many.csv");
    out << in_plane_header;
    for (int i = 0; i < rows; ++i) out << (i % 91) << ',' << (i % 90) << ".25," << i << ".000000000001\n";
  }
  const Scan scan = read_scan(dir / "many.csv");
  EXPECT_EQ(scan.name, "many");
  ASSERT_EQ(scan.size(), static_cast<std::size_t>(rows));
  for (std::size_t i = 0; i < scan.size(); ++i) {
    ASSERT_EQ(scan.theta_i_deg[i], static_cast<double>(i % 91));
    ASSERT_EQ(scan.theta_r_deg[i], static_cast<double>(i % 90) + 0.25);
    ASSERT_NEAR(scan.channels[0].values[i], static_cast<double>(i), 1e-11);
  }
}

TEST(Directions, KeepTheOtherColumnsAsText) {
  std::istringstream in(
      "# name: x\nidx;kind;theta_i;phi_i;theta_r;phi_r;kind;\n0;a, b;10;0;20;180;x;\n\n1;;30;0;40;90;;;;\n");
  const DirectionTable table = read_directions(in, "d.csv");
  EXPECT_EQ(table.header, "idx;kind;theta_i;phi_i;theta_r;phi_r;kind");
  EXPECT_EQ(table.separator, ';');
  EXPECT_EQ(table.lines, (std::vector<std::string>{"0;a, b;10;0;20;180;x", "1;;30;0;40;90;"}));
  ASSERT_EQ(table.angles.size(), 2U);
  EXPECT_EQ(table.angles[1].theta_i_deg, 30);
  EXPECT_EQ(table.angles[1].theta_r_deg, 40);
  EXPECT_EQ(table.angles[1].phi_r_deg, 90);
}

TEST(Directions, OfThePlaneOfIncidenceAreSigned) {
  std::istringstream in("theta_r theta_i\n-20 10\n20 10\n");
  const DirectionTable table = read_directions(in, "d.csv");
  EXPECT_EQ(table.separator, ' ');
  EXPECT_EQ(table.angles[0].phi_r_deg, 0);
  EXPECT_EQ(table.angles[0].theta_r_deg, 20);
  EXPECT_EQ(table.angles[1].phi_r_deg, 180);
}

TEST(Directions, AreCheckedLikeScans) {
  const auto message = [](const std::string& text) {
    return error_message([&] {
      std::istringstream in(text);
      (void)read_directions(in, "d.csv");
    });
  };
  EXPECT_EQ(message("theta_i,theta_r\n10,95\n"),
            "2 d.csv:2: column theta_r: \"95\" is out of range; expected a signed angle from -90 to 90 degrees");
  EXPECT_EQ(message("theta_i,phi_i,theta_r,x\n"), "2 d.csv:1: column phi_r: " + angles_expected);
  EXPECT_EQ(message("theta_i,theta_r,theta_r\n1,2,3\n"),
            "2 d.csv:1: column theta_r: is in the header line twice, as columns 2 and 3; expected each column once");
  EXPECT_EQ(message("theta_i,theta_r\n"), "2 d.csv:1: there is no row after the header line; expected one a direction");
  EXPECT_EQ(message("theta_i,theta_r,x\n1,2\n"),
            "2 d.csv:2: column x: the row ends before it, after 2 of 3 fields; expected one field a column");
  EXPECT_EQ(
      message(""),
      "2 d.csv: there is no header line; expected theta_i,phi_i,theta_r,phi_r or theta_i,theta_r among the names");
}

TEST(MeasuredScans, AreAllRead) {
  GONIOFIT_SKIP_WITHOUT_SHARED_DATA();
  std::size_t scans = 0;
  for (const auto& entry : std::filesystem::directory_iterator(*test::shared_data() / "measured")) {
    if (entry.path().extension() != ".csv") continue;
    const Scan scan = read_scan(entry.path());
    EXPECT_GE(scan.size(), 200U) << entry.path();
    for (const ScanChannel& channel : scan.channels) {
      EXPECT_EQ(channel.values.size(), scan.size()) << entry.path();
      EXPECT_TRUE(channel.wavelength_um) << entry.path();
    }
    ++scans;
  }
  EXPECT_GE(scans, 15U);
}

TEST(MeasuredScans, HaveTheContentTheyAreKnownToHave) {
  GONIOFIT_SKIP_WITHOUT_SHARED_DATA();
  const std::filesystem::path folder = *test::shared_data() / "measured";
  const Scan krylon = read_scan(folder / "krylon_blue.csv");
  EXPECT_EQ(krylon.size(), 1439U);
  EXPECT_EQ(krylon.channels.size(), 31U);
  EXPECT_EQ(krylon.channels[5].name, "450nm");
  EXPECT_EQ(krylon.channels[5].n, 1.5);
  EXPECT_EQ(krylon.channels[5].values[0], 0.086848);
  const Scan starlink = read_scan(folder / "starlink_chassis.csv");
  EXPECT_EQ(starlink.geometry, ScanGeometry::incidence_plane);
  EXPECT_EQ(starlink.signed_theta_r_deg(0), -89.0);
  EXPECT_EQ(read_scan(folder / "gray_retro_tape.csv").size(), 7233U);
}

}  // namespace
}  // namespace goniofit
