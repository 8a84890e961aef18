#include "io/optical_constants.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>

#include "support/error_message.h"
#include "support/paths.h"

namespace goniofit {
namespace {

using test::error_message;

OpticalConstants read(const std::string& text) {
  std::istringstream in(text);
  return read_optical_constants(in, "m.csv");
}

std::string complaint(const std::string& text) {
  return error_message([&] { (void)read(text); });
}

TEST(OpticalConstants, ReadsATable) {
  const OpticalConstants table =
      read("# source: somewhere\nWavelength_um, n, kappa\n0.45,0.618,5.47\n0.55,0.958,6.69\n");
  EXPECT_EQ(table.source, "m.csv");
  EXPECT_EQ(table.at(0.45).n, 0.618);
  EXPECT_EQ(table.at(0.55).kappa, 6.69);
  EXPECT_NEAR(table.at(0.5).n, 0.788, 1e-15);
  EXPECT_NEAR(table.at(0.475).kappa, 5.775, 1e-15);
}

TEST(OpticalConstants, ATableWithoutKappaIsTransparent) {
  const OpticalConstants table = read("n;wavelength_um\n1.5;0.4\n");
  EXPECT_EQ(table.at(0.4).n, 1.5);
  EXPECT_EQ(table.at(0.4).kappa, 0.0);
}

TEST(OpticalConstants, KnowNothingOutsideTheirRange) {
  const OpticalConstants table = read("wavelength_um,n,k\n0.4,1.5,0\n0.7,1.4,0\n");
  const std::string expected = " micrometres; expected 0.4 to 0.7";
  EXPECT_EQ(error_message([&] { (void)table.at(0.39); }), "2 m.csv: has no value at 0.39" + expected);
  EXPECT_EQ(error_message([&] { (void)table.at(0.71); }), "2 m.csv: has no value at 0.71" + expected);
  EXPECT_EQ(error_message([&] { (void)table.at(std::nan("")); }), "2 m.csv: has no value at nan" + expected);
}

TEST(OpticalConstants, BadTablesAreRefused) {
  const std::string head = "wavelength_um,n,kappa\n";
  EXPECT_EQ(complaint(""),
            "2 m.csv: there is no header line; expected names such as wavelength_um,n,kappa, or a "
            "refractiveindex.info file with a DATA block");
  EXPECT_EQ(complaint("n,kappa\n1,2\n"),
            "2 m.csv:1: column wavelength_um: is missing; expected wavelength_um, n, kappa");
  EXPECT_EQ(complaint("wavelength_um,kappa\n1,2\n"),
            "2 m.csv:1: column n: is missing; expected wavelength_um, n, kappa");
  EXPECT_EQ(complaint("wavelength_um,n,k,kappa\n"),
            "2 m.csv:1: column kappa: is there twice; expected wavelength_um, n, kappa");
  EXPECT_EQ(complaint("wavelength_um,n,x\n"), "2 m.csv:1: column x: is unknown; expected wavelength_um, n, kappa");
  EXPECT_EQ(complaint(head), "2 m.csv:1: there is no row after the header line; expected one a wavelength");
  EXPECT_EQ(complaint(head + "0.4,0,1\n"), "2 m.csv:2: column n: \"0\" is out of range; expected n above 0");
  EXPECT_EQ(complaint(head + "0.4,1,-1\n"),
            "2 m.csv:2: column kappa: \"-1\" is out of range; expected kappa from 0 up");
  EXPECT_EQ(complaint(head + "0.4,1,x\n"), "2 m.csv:2: column kappa: \"x\" is not a number; expected kappa from 0 up");
  EXPECT_EQ(
      complaint(head + "0.4,1,0\n0.4,2,0\n"),
      "2 m.csv:3: column wavelength_um: \"0.4\" is not above the wavelength before it; expected ascending wavelengths");
  EXPECT_EQ(complaint(head + "-0.4,1,0\n"),
            "2 m.csv:2: column wavelength_um: \"-0.4\" is out of range; expected a wavelength above 0 in micrometres");
}

const std::string yaml_head = "# from a database\nREFERENCES: |\n    a <i>reference</i>: with colons\nDATA:\n";

TEST(RefractiveIndexYaml, ReadsTabulatedNk) {
  const OpticalConstants table =
      read(yaml_head + "  - type: tabulated nk\n    data: |\n        0.4 1.5 0.1\n        0.8 1.7 3.E-1\n");
  EXPECT_EQ(table.source, "m.csv");
  EXPECT_NEAR(table.at(0.5).n, 1.55, 1e-15);
  EXPECT_NEAR(table.at(0.5).kappa, 0.15, 1e-15);
}

TEST(RefractiveIndexYaml, ReadsTabulatedNAsTransparent) {
  const OpticalConstants table =
      read(yaml_head + "  - type: tabulated n\n    data: |\n        0.4 1.5\n        0.8 1.7\n");
  EXPECT_EQ(table.at(0.8).n, 1.7);
  EXPECT_EQ(table.at(0.8).kappa, 0.0);
}

TEST(RefractiveIndexYaml, JoinsAFormulaWithTabulatedK) {
  const OpticalConstants table = read(yaml_head +
                                      "  - type: formula 1\n    wavelength_range: 0.3 2\n    coefficients: 0 1 0.1\n"
                                      "  - type: tabulated k\n    data: |\n        0.5 1e-3\n        0.7 3e-3\n");
  EXPECT_EQ(table.wavelength_um.front(), 0.5);
  EXPECT_EQ(table.wavelength_um.back(), 0.7);
  EXPECT_NEAR(table.at(0.6).n, std::sqrt(1.0 + 0.36 / (0.36 - 0.01)), 1e-6);
  EXPECT_NEAR(table.at(0.6).kappa, 2e-3, 1e-15);
}

// n² - 1 is one term of each: formula 2 has the square of formula 1's pole.
TEST(RefractiveIndexYaml, BothSellmeierFormsAgree) {
  const std::string range = "    wavelength_range: 0.3 2\n";
  const OpticalConstants one = read(yaml_head + "  - type: formula 1\n" + range + "    coefficients: 0.2 1 0.1\n");
  const OpticalConstants two = read(yaml_head + "  - type: formula 2\n" + range + "    coefficients: 0.2 1 0.01\n");
  for (const double w : {0.3, 0.31, 0.5, 1.234, 2.0}) {
    EXPECT_NEAR(one.at(w).n, std::sqrt(1.2 + w * w / (w * w - 0.01)), 1e-6);
    EXPECT_NEAR(two.at(w).n, one.at(w).n, 1e-14);
  }
}

TEST(RefractiveIndexYaml, BadFilesAreRefusedWithTheirLine) {
  const auto block = [](const std::string& text) { return complaint(yaml_head + text); };
  const std::string table = "  - type: tabulated nk\n    data: |\n        0.4 1.5 0.1\n";
  EXPECT_EQ(block("  - type: formula 7\n"),
            "2 m.csv:5: type \"formula 7\" is not supported; expected tabulated nk, tabulated n, "
            "tabulated k, formula 1 or formula 2");
  EXPECT_EQ(block(table + "        0.5 1.5\n"), "2 m.csv:8: data: 2 numbers; expected 3");
  EXPECT_EQ(block(table + "        0.5 abc 1\n"), "2 m.csv:8: data: \"abc\" is not a number; expected a number");
  EXPECT_EQ(block(table + "\n        0.4 1 1\n"),
            "2 m.csv:9: data: the wavelength is out of order; expected ascending wavelengths above 0");
  EXPECT_EQ(block(table + "        0.5 0 1\n"), "2 m.csv:8: data: n is out of range; expected n above 0");
  EXPECT_EQ(block(table + "        0.5 1 -1\n"), "2 m.csv:8: data: k is out of range; expected k from 0 up");
  EXPECT_EQ(block(table + table), "2 m.csv:8: n or k is given twice; expected each once");
  EXPECT_EQ(block("  - type: tabulated k\n    data: |\n        0.4 1\n"),
            "2 m.csv:5: DATA: there is no n; expected a block 'tabulated nk', 'tabulated n' or a formula");
  EXPECT_EQ(block("  - data: 1\n"), "2 m.csv:5: the block has no 'type'; expected it beside 'type'");
  EXPECT_EQ(block("  - type: tabulated n\n    data: ''\n"), "2 m.csv:6: data: there is no number; expected a table");
  EXPECT_EQ(block("  - 17\n"), "2 m.csv:5: DATA: expected blocks that begin with '- type:'");
  EXPECT_EQ(block("  17\n"), "2 m.csv: there is no list DATA; expected blocks that begin with '- type:'");
  const std::string formula = "  - type: formula 1\n    wavelength_range: 0.3 2\n    coefficients: ";
  EXPECT_EQ(block(formula + "0 1\n"), "2 m.csv:7: coefficients: 2 numbers; expected one, and two a term");
  EXPECT_EQ(block(formula + "-3\n"),
            "2 m.csv:7: coefficients: n is not real all over wavelength_range; expected n above 0");
  EXPECT_EQ(block("  - type: formula 1\n    coefficients: 0\n    wavelength_range: 2 1\n"),
            "2 m.csv:7: wavelength_range: expected two ascending wavelengths above 0");
  EXPECT_EQ(complaint("DATA: [\n").substr(0, 25), "2 m.csv:2: is not YAML: e");
}

TEST(OpticalConstants, MissingFilesAreBadInput) {
  const test::ScratchDir dir;
  EXPECT_EQ(error_message([&] { (void)read_optical_constants(dir / "no.yml"); }),
            "2 " + (dir / "no.yml").string() + ": cannot be read: No such file or directory");
}

TEST(MeasuredOpticalConstants, AreAllReadAndPlausible) {
  GONIOFIT_SKIP_WITHOUT_SHARED_DATA();
  const std::filesystem::path folder = *test::shared_data() / "optical_constants";
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".yml") continue;
    EXPECT_GT(read_optical_constants(entry.path()).at(0.55).n, 0.0) << entry.path();
    ++files;
  }
  EXPECT_EQ(files, 10U);
  // Rakic's aluminium lies near the constants of Li & Torrance (1.47 + 7.79i and 0.618 + 5.47i), from another source.
  const OpticalConstants aluminium = read_optical_constants(folder / "Al_Rakic.yml");
  EXPECT_NEAR(aluminium.at(0.65).n, 1.47, 0.1);
  EXPECT_NEAR(aluminium.at(0.65).kappa, 7.79, 0.1);
  EXPECT_NEAR(aluminium.at(0.45).n, 0.618, 0.05);
  EXPECT_NEAR(aluminium.at(0.45).kappa, 5.47, 0.05);
  // Malitson's fused silica at the sodium and helium-neon lines; a methacrylate's n_d.
  const OpticalConstants silica = read_optical_constants(folder / "SiO2_Malitson.yml");
  EXPECT_NEAR(silica.at(0.5893).n, 1.45841, 1e-5);
  EXPECT_NEAR(silica.at(0.6328).n, 1.45702, 1e-5);
  EXPECT_NEAR(silica.at(0.2138).n, 1.53434, 2e-4);
  EXPECT_NEAR(read_optical_constants(folder / "PMMA_Szczurowski.yml").at(0.5876).n, 1.4906, 1e-3);
}

}  // namespace
}  // namespace goniofit
