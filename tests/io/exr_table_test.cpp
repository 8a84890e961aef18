#include "io/exr_table.h"

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatVectorAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIntAttribute.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfStringVectorAttribute.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "brdf/evaluator.h"
#include "geometry/samplings.h"
#include "io/material_io.h"
#include "support/error_message.h"
#include "support/materials.h"
#include "support/paths.h"

namespace goniofit {
namespace {

using test::error_message;
using test::garnet_by_slope;

Material rough_paint() {
  Material m = garnet_by_slope();
  m.surface.slope = 0.3;
  return m;
}

const ExrTableOptions small{.size = 16, .incidence_step_deg = 42.5};

std::string read_bytes(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

std::string small_file(const test::ScratchDir& folder) {
  write_exr(folder / "small.exr", rough_paint(), tabulate(rough_paint(), small));
  return read_bytes(folder / "small.exr");
}

std::vector<AnglePair> random_pairs(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<AnglePair> pairs;
  while (pairs.size() < count) {
    const HemispherePoint p = square_to_hemisphere({unit(random), unit(random)});
    if (p.theta_deg <= 80.0) pairs.push_back({80.0 * unit(random), 360.0 * unit(random), p.theta_deg, p.phi_deg});
  }
  return pairs;
}

TEST(Tabulate, HasTheIncidenceAnglesAndChannels) {
  const BrdfTable table = tabulate(rough_paint(), {.size = 4, .incidence_step_deg = 5.0});
  ASSERT_EQ(table.theta_i_deg.size(), 18U);
  EXPECT_EQ(table.theta_i_deg.front(), 0.0);
  EXPECT_EQ(table.theta_i_deg.back(), 85.0);
  EXPECT_EQ(table.channels, (std::vector<std::string>{"R", "G", "B"}));
  ASSERT_EQ(table.values.size(), 18U);
  EXPECT_EQ(table.values[7].size(), 3U);
  EXPECT_EQ(table.values[7][2].size(), 16U);
  EXPECT_EQ(tabulate(rough_paint(), {.size = 2, .incidence_step_deg = 0.1}).theta_i_deg.size(), 851U);
}

// At a cell's centre nothing is interpolated.
TEST(Tabulate, CellCentresAreTheMaterialItself) {
  const Evaluator evaluator(rough_paint());
  const BrdfTable table = tabulate(rough_paint(), small);
  const std::vector<HemispherePoint> cells = square_cell_centres(16);
  for (std::size_t i = 0; i < table.theta_i_deg.size(); ++i) {
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
      const AnglePair angles{table.theta_i_deg[i], 0.0, cells[cell].theta_deg, cells[cell].phi_deg};
      const double exact = evaluator.value(make_pair(angles), 1);
      EXPECT_EQ(table.values[i][1][cell], static_cast<float>(exact));
      EXPECT_NEAR(table.value(angles, 1), exact, 1e-6 * exact + 1e-12) << i << ' ' << cell;
    }
  }
}

std::size_t incidence_below(const BrdfTable& table, double theta_i) {
  const auto above = std::upper_bound(table.theta_i_deg.begin(), table.theta_i_deg.end(), theta_i);
  return static_cast<std::size_t>(above - table.theta_i_deg.begin()) - 1;
}

// What the statement of the largest error refers to: scales[channel][incidence below].
std::vector<std::vector<double>> error_scales(const BrdfTable& table) {
  const std::vector<HemispherePoint> cells = square_cell_centres(table.size);
  std::vector<std::vector<double>> scales(table.channels.size(), std::vector<double>(table.values.size() - 1));
  for (std::size_t c = 0; c < scales.size(); ++c) {
    for (std::size_t i = 0; i < scales[c].size(); ++i) {
      for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        if (cells[cell].theta_deg > 80.0) continue;
        const float larger = std::max(table.values[i][c][cell], table.values[i + 1][c][cell]);
        scales[c][i] = std::max(scales[c][i], static_cast<double>(larger));
      }
    }
  }
  return scales;
}

// Other directions than those of the statement: the same but for what chance leaves of 5000 samples.
TEST(BrdfTable, AgreesWithTheMaterialToTheStatedErrors) {
  for (const double slope : {0.1, 0.2, 0.4}) {
    Material m = garnet_by_slope();
    m.surface.slope = slope;
    const Evaluator evaluator(m);
    const BrdfTable table = tabulate(m, {.size = 64, .incidence_step_deg = 5.0});
    const std::vector<std::vector<double>> scales = error_scales(table);
    double squares = 0.0;
    double largest = 0.0;
    for (const AnglePair& angles : random_pairs(5000, 99)) {
      const Pair pair = make_pair(angles);
      for (std::size_t c = 0; c < 3; ++c) {
        const double exact = evaluator.value(pair, c);
        const double difference = std::fabs(table.value(angles, c) - exact);
        squares += std::pow(difference / std::max(exact, 1e-3), 2);
        largest = std::max(largest, difference / scales[c][incidence_below(table, angles.theta_i_deg)]);
      }
    }
    const double rms = std::sqrt(squares / 15000.0);
    EXPECT_NEAR(rms, table.interpolation_rms, 0.1 * table.interpolation_rms) << slope;
    EXPECT_LT(largest, 1.5 * table.interpolation_max) << slope;
    EXPECT_GT(largest, 0.3 * table.interpolation_max) << slope;
  }
}

TEST(BrdfTable, FinerTablesErrLess) {
  const BrdfTable coarse = tabulate(rough_paint(), {.size = 32, .incidence_step_deg = 10.0});
  const BrdfTable fine = tabulate(rough_paint(), {.size = 128, .incidence_step_deg = 2.5});
  // Both interpolations are of second order: a quarter of the step, a sixteenth of the error.
  EXPECT_LT(fine.interpolation_rms, coarse.interpolation_rms / 8.0);
  EXPECT_LT(fine.interpolation_rms, 0.006);
}

TEST(BrdfTable, OnlyTheDifferenceOfAzimuthsCounts) {
  const BrdfTable table = tabulate(rough_paint(), small);
  for (const double turn : {-350.0, -90.0, 33.0, 180.0, 720.0}) {
    EXPECT_NEAR(table.value({30.0, turn, 40.0, 170.0 + turn}, 0), table.value({30.0, 0.0, 40.0, 170.0}, 0), 1e-12);
  }
}

// The documented layout: retro side to the right, mirror side to the left.
TEST(BrdfTable, TheMirrorLobeIsOnTheLeft) {
  Material m = garnet_by_slope();
  m.components = {Effect::dd};
  const BrdfTable table = tabulate(m, {.size = 64, .incidence_step_deg = 42.5});
  const std::vector<float>& image = table.values[1][0];
  const auto brightest = static_cast<std::size_t>(std::max_element(image.begin(), image.end()) - image.begin());
  EXPECT_LT(brightest % 64, 24U);
  EXPECT_NEAR(static_cast<double>(brightest / 64), 31.5, 1.0);
}

TEST(BrdfTable, EdgesOfTheHemisphere) {
  const BrdfTable table = tabulate(rough_paint(), small);
  for (double phi = 0.0; phi < 360.0; phi += 7.5) {
    EXPECT_GT(table.value({30.0, 0.0, 89.999, phi}, 0), 0.0) << phi;
  }
  EXPECT_EQ(table.value({30.0, 0.0, 90.0, 0.0}, 0), 0.0);
  EXPECT_EQ(table.value({90.0, 0.0, 30.0, 0.0}, 0), 0.0);
  EXPECT_EQ(table.value({std::nan(""), 0.0, 30.0, 0.0}, 0), 0.0);
  EXPECT_EQ(table.value({89.0, 0.0, 30.0, 0.0}, 0), table.value({85.0, 0.0, 30.0, 0.0}, 0));
  EXPECT_GT(table.value({0.0, 0.0, 0.0, 0.0}, 0), 0.0);
}

TEST(Tabulate, ValuesBeyondFloatsStandAsTheLargest) {
  Material m = garnet_by_slope();
  m.components = {Effect::udf};
  for (MaterialChannel& c : m.channels) c.coefficient(Coefficient::k_udf) = 1e60;
  EXPECT_EQ(tabulate(m, small).values[0][0][0], std::numeric_limits<float>::max());
}

TEST(Tabulate, LeavesCohOut) {
  Material m = rough_paint();
  const BrdfTable without = tabulate(m, small);
  m.components.insert(Effect::coh);
  m.surface.sigma_um = 0.05;
  const BrdfTable with = tabulate(m, small);
  EXPECT_EQ(with.values, without.values);
  m.components = {Effect::coh};
  EXPECT_EQ(error_message([&] { (void)tabulate(m, small); }),
            "2 a material of coh alone has nothing to tabulate: its cone is narrower than a cell");
}

TEST(Tabulate, APeerIsAMaterialLikeOthers) {
  Material m = test::anisotropic_ggx();
  m.parameters["alpha_y"] = 0.1;  // two widths, but one value
  const Evaluator evaluator(m);
  const BrdfTable table = tabulate(m, small);
  const HemispherePoint cell = square_cell_centres(16)[77];
  const AnglePair angles{42.5, 0.0, cell.theta_deg, cell.phi_deg};
  EXPECT_EQ(table.values[1][0][77], static_cast<float>(evaluator.value(make_pair(angles), 0)));
}

TEST(Tabulate, RefusesWhatOneAzimuthDoesNotShow) {
  const std::string complaint = "2 an anisotropic material cannot be tabulated: the table has one azimuth of incidence";
  Material surface = rough_paint();
  surface.surface.slope_y = 0.5;
  Material narrow = test::anisotropic_ggx();
  narrow.parameters = {{"alpha_x", 0.001}, {"alpha_y", 0.0011}};
  for (const Material& m : {surface, test::anisotropic_ggx(), narrow}) {
    EXPECT_EQ(error_message([&] { (void)tabulate(m, small); }), complaint) << m.name;
  }
}

TEST(Tabulate, RefusesOptionsOutOfRange) {
  const auto complaint = [](std::size_t size, double step) {
    return error_message([&] { (void)tabulate(rough_paint(), {.size = size, .incidence_step_deg = step}); });
  };
  EXPECT_EQ(complaint(1, 5.0), "2 table of 1 cells a side, expected 2 to 4096");
  EXPECT_EQ(complaint(5000, 5.0), "2 table of 5000 cells a side, expected 2 to 4096");
  EXPECT_EQ(complaint(64, 0.0), "2 incidence step of 0 degrees, expected 0.1 to 85");
  EXPECT_EQ(complaint(64, std::nan("")), "2 incidence step of nan degrees, expected 0.1 to 85");
  EXPECT_EQ(complaint(4096, 1.0), "2 the table would take more than 1 GiB, expected fewer cells or incidence angles");
}

TEST(Exr, ReadsBackBitIdentical) {
  const test::ScratchDir folder;
  Material m = rough_paint();
  m.channels[0].name = "650nm";  // OpenEXR sorts: the table's order must survive
  m.channels[1].name = "B.x";
  m.name = "naïve \"red\"";
  const BrdfTable table = tabulate(m, {.size = 33, .incidence_step_deg = 17.0});
  write_exr(folder / "t.exr", m, table);
  const BrdfTable back = read_exr(folder / "t.exr");
  EXPECT_EQ(back.name, table.name);
  EXPECT_EQ(back.channels, table.channels);
  EXPECT_EQ(back.size, table.size);
  EXPECT_EQ(back.theta_i_deg, table.theta_i_deg);
  EXPECT_EQ(back.values, table.values);
  EXPECT_EQ(back.interpolation_rms, table.interpolation_rms);
  EXPECT_EQ(back.interpolation_max, table.interpolation_max);
}

// What other programs see.
TEST(Exr, AttributesCarryTheMaterial) {
  const test::ScratchDir folder;
  Material m = rough_paint();
  m.components.insert(Effect::coh);
  m.surface.sigma_um = 0.05;
  write_exr(folder / "t.exr", m, tabulate(m, small));
  Imf::MultiPartInputFile file((folder / "t.exr").c_str());
  ASSERT_EQ(file.parts(), 3);
  for (int part = 0; part < 3; ++part) {
    const Imf::Header& header = file.header(part);
    EXPECT_EQ(header.typedAttribute<Imf::DoubleAttribute>("theta_i_deg").value(), 42.5 * part);
    EXPECT_EQ(parse_material(header.typedAttribute<Imf::StringAttribute>("goniofit.material").value(), "attribute"), m);
    EXPECT_EQ(header.typedAttribute<Imf::StringAttribute>("goniofit.components").value(), "coh dd uds fs");
    EXPECT_EQ(header.typedAttribute<Imf::DoubleAttribute>("goniofit.slope").value(), 0.3);
    EXPECT_EQ(header.typedAttribute<Imf::StringAttribute>("goniofit.model").value(), "surface");
    EXPECT_EQ(header.typedAttribute<Imf::DoubleAttribute>("goniofit.sigma_um").value(), 0.05);
    EXPECT_EQ(header.typedAttribute<Imf::FloatVectorAttribute>("goniofit.k_dd").value(),
              (std::vector<float>{0.59F, 0.72F, 0.69F}));
    EXPECT_EQ(header.findTypedAttribute<Imf::DoubleAttribute>("goniofit.tail"), nullptr);
    EXPECT_EQ(header.typedAttribute<Imf::StringAttribute>("goniofit.left_out").value().substr(0, 4), "coh:");
  }
  EXPECT_EQ(file.header(1).name(), "theta_i_042.50000");
}

TEST(Exr, AttributesOfAPeerAreItsOwn) {
  const test::ScratchDir folder;
  Material m = test::anisotropic_ggx();
  m.parameters["alpha_y"] = 0.1;
  m.channels[1].peer_k["k_s"].reset();
  write_exr(folder / "t.exr", m, tabulate(m, small));
  Imf::MultiPartInputFile file((folder / "t.exr").c_str());
  const Imf::Header& header = file.header(0);
  EXPECT_EQ(header.typedAttribute<Imf::StringAttribute>("goniofit.model").value(), "ggx-anisotropic");
  EXPECT_EQ(header.typedAttribute<Imf::DoubleAttribute>("goniofit.alpha_y").value(), 0.1);
  const std::vector<float>& k_s = header.typedAttribute<Imf::FloatVectorAttribute>("goniofit.k_s").value();
  ASSERT_EQ(k_s.size(), 2U);
  EXPECT_EQ(k_s[0], 0.75F);
  EXPECT_TRUE(std::isnan(k_s[1])) << "not known";
  EXPECT_EQ(header.findTypedAttribute<Imf::DoubleAttribute>("goniofit.slope"), nullptr);
}

TEST(Exr, NothingIsLeftWhereTheFileCannotBeWritten) {
  const BrdfTable table = tabulate(rough_paint(), small);
  EXPECT_EQ(error_message([&] { write_exr("/nowhere/t.exr", rough_paint(), table); }).substr(0, 2), "3 ");
  Material m = rough_paint();
  m.channels[0].name = std::string(256, 'R');
  const test::ScratchDir folder;
  const std::string message = error_message([&] { write_exr(folder / "t.exr", m, tabulate(m, small)); });
  EXPECT_NE(message.find("OpenEXR takes channel names of up to 255 bytes"), std::string::npos) << message;
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

// ---- files that are no tables

std::string patched(std::string bytes, const std::string& from, const std::string& to) {
  EXPECT_EQ(from.size(), to.size());
  std::size_t count = 0;
  for (std::size_t at = 0; (at = bytes.find(from, at)) != std::string::npos; at += to.size(), ++count) {
    bytes.replace(at, from.size(), to);
  }
  EXPECT_GT(count, 0U) << from;
  return bytes;
}

// The attribute as it stands in a header: name, type, size, then the value.
std::string box(int last) {
  const int values[4] = {0, 0, last, last};
  std::string text("dataWindow\0box2i\0\x10\0\0\0", 21);
  return text.append(reinterpret_cast<const char*>(values), sizeof values);
}

class BadExr : public testing::Test {
 protected:
  std::string complaint(const std::string& bytes) {
    write_bytes(folder_ / "t.exr", bytes);
    const std::string message = error_message([&] { (void)read_exr(folder_ / "t.exr"); });
    const std::string start = "2 " + (folder_ / "t.exr").string() + ": ";
    return message.starts_with(start) ? message.substr(start.size()) : message;
  }
  test::ScratchDir folder_;
};

TEST_F(BadExr, MissingFileAndFolder) {
  EXPECT_EQ(error_message([] { (void)read_exr("/nowhere/t.exr"); }),
            "2 /nowhere/t.exr: cannot be read: No such file or directory");
  EXPECT_EQ(error_message([&] { (void)read_exr(folder_.path()); }),
            "2 " + folder_.path().string() + ": cannot be read: Is a directory");
}

TEST_F(BadExr, OtherFormats) {
  const std::string no_exr = "is not a complete OpenEXR file";
  EXPECT_EQ(complaint("").substr(0, no_exr.size()), no_exr);
  EXPECT_EQ(complaint("theta_i,phi_i,theta_r,phi_r,R\n").substr(0, no_exr.size()), no_exr);
  EXPECT_EQ(complaint(std::string("v/1\x01", 4) + std::string(100, '\xff')).substr(0, no_exr.size()), no_exr);
}

TEST_F(BadExr, OrdinaryPicture) {
  const float pixel = 0.5F;
  Imf::Header header(1, 1);
  header.channels().insert("R", Imf::Channel(Imf::FLOAT));
  {
    Imf::OutputFile file((folder_ / "t.exr").c_str(), header);
    Imf::FrameBuffer frame;
    frame.insert("R", Imf::Slice::Make(Imf::FLOAT, &pixel, header.dataWindow()));
    file.setFrameBuffer(frame);
    file.writePixels(1);
  }
  EXPECT_EQ(complaint(read_bytes(folder_ / "t.exr")),
            "attribute goniofit.format is missing or of another type, expected a table written by goniofit");
}

TEST_F(BadExr, AttributesThatAreMissingOrWrong) {
  const std::string good = small_file(folder_);
  ASSERT_EQ(complaint(good), "no error");
  EXPECT_EQ(complaint(patched(good, "goniofit-brdf-table", "goniofit-bsdf-table")),
            "attribute goniofit.format is \"goniofit-bsdf-table\", expected \"goniofit-brdf-table\"");
  EXPECT_EQ(complaint(patched(good, std::string("goniofit.version\0int\0\4\0\0\0\1", 26),
                              std::string("goniofit.version\0int\0\4\0\0\0\2", 26))),
            "attribute goniofit.version is 2, expected 1");
  EXPECT_EQ(complaint(patched(good, "goniofit.channels", "goniofit.chanels_")),
            "attribute goniofit.channels is missing or of another type, expected a table written by goniofit");
  EXPECT_EQ(complaint(patched(good, "theta_i_deg", "theta_r_deg")),
            "attribute theta_i_deg is missing or of another type, expected a table written by goniofit");
  const std::string one_channel = std::string("R\0\2\0\0\0", 6);
  EXPECT_EQ(complaint(patched(good, one_channel, std::string("Q\0\2\0\0\0", 6))),
            "part 0: has a channel \"Q\" that goniofit.channels does not list");
  EXPECT_EQ(complaint(patched(good, one_channel, std::string("R\0\1\0\0\0", 6))),
            "part 0: channel \"R\" is not of 32-bit floats, one a pixel");
}

TEST_F(BadExr, IncidenceAnglesOutOfOrder) {
  const test::ScratchDir folder;
  BrdfTable table = tabulate(rough_paint(), small);
  table.theta_i_deg = {0.0, 85.0, 42.5};
  write_exr(folder / "t.exr", rough_paint(), table);
  EXPECT_EQ(complaint(read_bytes(folder / "t.exr")),
            "part 2: theta_i_deg is 42.5, expected ascending angles from 0 to below 90");
}

TEST_F(BadExr, ValuesThatAreNoReflectance) {
  for (const float bad : {-1.0F, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    BrdfTable table = tabulate(rough_paint(), small);
    table.values[1][2][77] = bad;
    write_exr(folder_ / "bad.exr", rough_paint(), table);
    EXPECT_EQ(complaint(read_bytes(folder_ / "bad.exr")), "part 1: has a value that is negative or not finite");
  }
}

// A file of some kilobytes that claims images of gigabytes must not make the reader ask for the memory.
TEST_F(BadExr, HugeClaims) {
  const std::string good = small_file(folder_);
  const std::string not_complete = "is not a complete OpenEXR file";
  for (const int last : {4095, 99999, 0x7ffffffe, -1}) {
    EXPECT_EQ(complaint(patched(good, box(15), box(last))).substr(0, not_complete.size()), not_complete) << last;
  }
  EXPECT_EQ(complaint(patched(good, box(15), box(0))), "images are 1 pixels wide, expected 2 to 4096");
}

// One part of one channel, with attributes that say otherwise.
TEST_F(BadExr, ChannelsThatAreNotThere) {
  const std::vector<float> pixels(64 * 64, 0.5F);
  const auto file_with = [&](const std::vector<std::string>& channels) {
    Imf::Header header(64, 64);
    header.channels().insert("R", Imf::Channel(Imf::FLOAT));
    header.insert("goniofit.format", Imf::StringAttribute("goniofit-brdf-table"));
    header.insert("goniofit.version", Imf::IntAttribute(1));
    header.insert("goniofit.name", Imf::StringAttribute("x"));
    header.insert("goniofit.interpolation_rms", Imf::DoubleAttribute(0.0));
    header.insert("goniofit.interpolation_max", Imf::DoubleAttribute(0.0));
    header.insert("goniofit.channels", Imf::StringVectorAttribute(channels));
    header.insert("theta_i_deg", Imf::DoubleAttribute(0.0));
    Imf::OutputFile file((folder_ / "t.exr").c_str(), header);
    Imf::FrameBuffer frame;
    frame.insert("R", Imf::Slice::Make(Imf::FLOAT, pixels.data(), header.dataWindow()));
    file.setFrameBuffer(frame);
    file.writePixels(64);
  };
  const auto complaint_with = [&](const std::vector<std::string>& channels) {
    file_with(channels);
    return complaint(read_bytes(folder_ / "t.exr"));
  };
  EXPECT_EQ(complaint_with({"R"}), "no error");
  EXPECT_EQ(complaint_with({}), "has no channels, expected at least one");
  EXPECT_EQ(complaint_with({"R", "G"}), "part 0: lacks a channel that goniofit.channels lists");
  EXPECT_EQ(complaint_with(std::vector<std::string>(20000, "R")), "claims more values than it can hold");
  EXPECT_EQ(complaint_with(std::vector<std::string>(100000, "R")), "claims more than 1 GiB of values, expected less");
}

TEST_F(BadExr, TruncatedFiles) {
  const std::string good = small_file(folder_);
  for (std::size_t length = 0; length < good.size(); length += good.size() / 150) {
    EXPECT_NE(complaint(good.substr(0, length)), "no error") << length;
  }
}

// Anything but an Error (an exception of OpenEXR, a crash) fails the test.
TEST_F(BadExr, FlippedBitsAreReadOrRefused) {
  const std::string good = small_file(folder_);
  std::mt19937 random(5);
  std::size_t refused = 0;
  for (int i = 0; i < 400; ++i) {
    std::string bytes = good;
    for (int flip = 0; flip < 3; ++flip) bytes[random() % bytes.size()] ^= static_cast<char>(1U << (random() % 8U));
    if (complaint(bytes) != "no error") ++refused;
  }
  EXPECT_GT(refused, 100U);
}

}  // namespace
}  // namespace goniofit
