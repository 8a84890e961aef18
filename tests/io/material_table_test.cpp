// Materials as rows of a CSV table.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "io/material_io.h"
#include "support/materials.h"

namespace goniofit {

namespace {

using test::garnet_by_slope;

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> out{""};
  bool inside = false;
  for (const char c : line) {
    if (c == '"')
      inside = !inside;
    else if (c == ',' && !inside)
      out.emplace_back();
    else
      out.back() += c;
  }
  return out;
}

TEST(MaterialTable, OneRowAChannel) {
  Material m = garnet_by_slope();
  m.name = "red, \"garnet\"";
  m.fit.emplace();
  m.fit->loss = 0.125;
  m.fit->samples = 42;
  m.fit->shared_uncertainty["slope"] = 0.001;
  m.fit->channel_uncertainty["G"]["k_fs"] = 0.17;
  Material converged = garnet_by_slope();
  converged.channels.resize(1);
  converged.fit.emplace();
  converged.fit->converged = true;
  std::istringstream table(to_csv({m, converged}));
  std::vector<std::map<std::string, std::string>> rows;
  std::string line;
  ASSERT_TRUE(std::getline(table, line));
  const std::vector<std::string> header = cells(line);
  while (std::getline(table, line)) {
    const std::vector<std::string> row = cells(line);
    ASSERT_EQ(row.size(), header.size()) << line;
    auto& by_name = rows.emplace_back();
    for (std::size_t i = 0; i < row.size(); ++i) by_name[header[i]] = row[i];
  }
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows[1]["name"], "red, garnet");  // the reader above drops the doubled quotes
  EXPECT_EQ(rows[1]["channel"], "G");
  EXPECT_EQ(rows[1]["components"], "dd uds fs");
  EXPECT_EQ(rows[1]["terms"],
            "fresnel=schlick shadowing=li-torrance effective_roughness=li-torrance distribution=rough-limit");
  EXPECT_EQ(rows[1]["k_dd"], "0.72");
  EXPECT_EQ(rows[1]["u_k_dd"], "");
  EXPECT_EQ(rows[1]["u_k_fs"], "0.17");
  EXPECT_EQ(rows[0]["u_k_fs"], "");
  EXPECT_EQ(rows[0]["u_slope"], "0.001");
  EXPECT_EQ(rows[0]["sigma_um"], "");
  EXPECT_EQ(rows[0]["f0"], "");
  EXPECT_EQ(rows[0]["samples"], "42");
  EXPECT_EQ(rows[0]["loss"], "0.125");
  EXPECT_EQ(rows[0]["converged"], "false");
  EXPECT_EQ(rows[3]["n"], "1.7");
  EXPECT_EQ(rows[3]["converged"], "true");
}

std::map<std::string, std::string> only_row(const std::vector<Material>& materials, std::size_t row) {
  std::istringstream table(to_csv(materials));
  std::string header;
  std::string line;
  std::getline(table, header);
  for (std::size_t i = 0; i <= row; ++i) std::getline(table, line);
  const std::vector<std::string> names = cells(header);
  const std::vector<std::string> values = cells(line);
  EXPECT_EQ(names.size(), values.size()) << line;
  std::map<std::string, std::string> by_name;
  for (std::size_t i = 0; i < std::min(names.size(), values.size()); ++i) by_name[names[i]] = values[i];
  EXPECT_EQ(by_name.size(), names.size()) << "a name twice in " << header;
  return by_name;
}

TEST(MaterialTable, HasWhatTheSurfaceHasBesides) {
  Material m = garnet_by_slope();
  m.components.insert(Effect::rough);
  m.terms.distribution = DistributionTier::student_t;
  m.forms = {FsForm::reciprocal, RoughForm::integral, AnisotropyForm::printed};
  m.surface.slope_y = 0.2;
  m.surface.tail = 2.5;
  m.surface.facet_slope_deg = 25.0;
  m.channels[0].coefficient(Coefficient::rho) = 0.375;
  m.fit.emplace();
  m.fit->shared_uncertainty = {{"tail", 0.125}};
  m.fit->channel_uncertainty["R"]["rho"] = 0.0625;
  auto row = only_row({m}, 0);
  EXPECT_EQ(row["model"], "surface");
  EXPECT_EQ(row["fs_form"], "reciprocal");
  EXPECT_EQ(row["rough_form"], "integral");
  EXPECT_EQ(row["anisotropy"], "printed");
  EXPECT_EQ(row["slope_y"], "0.2");
  EXPECT_EQ(row["tau_y_um"], "");
  EXPECT_EQ(row["tail"], "2.5");
  EXPECT_EQ(row["u_tail"], "0.125");
  EXPECT_EQ(row["facet_slope_deg"], "25");
  EXPECT_EQ(row["rho"], "0.375");
  EXPECT_EQ(row["u_rho"], "0.0625");
}

TEST(MaterialTable, APeerBringsItsColumns) {
  const Material ggx = test::anisotropic_ggx();
  auto row = only_row({garnet_by_slope(), ggx}, 3);
  EXPECT_EQ(row["model"], "ggx-anisotropic");
  EXPECT_EQ(row["components"], "");
  EXPECT_EQ(row["terms"], "fresnel=schlick");
  EXPECT_EQ(row["fs_form"], "");
  EXPECT_EQ(row["slope"], "");
  EXPECT_EQ(row["alpha_x"], "0.1");
  EXPECT_EQ(row["alpha_y"], "0.3");
  EXPECT_EQ(row["k_s"], "0.75");
  EXPECT_EQ(row["u_k_s"], "");
  auto paint = only_row({garnet_by_slope(), ggx}, 0);
  EXPECT_EQ(paint["alpha_x"], "");
  EXPECT_EQ(paint["k_dd"], "0.59");
  EXPECT_FALSE(only_row({garnet_by_slope()}, 0).contains("alpha_x"));
}

TEST(MaterialTable, QuotesAsRfc4180) {
  Material m = garnet_by_slope();
  m.name = "a\"b,c";
  const std::string table = to_csv({m});
  EXPECT_NE(table.find("\n\"a\"\"b,c\",R,0.65,1.7,,0,"), std::string::npos) << table;
}

TEST(MaterialTable, HandWrittenMaterialHasEmptyCells) {
  std::istringstream table(to_csv({garnet_by_slope()}));
  std::string header;
  std::string row;
  std::getline(table, header);
  std::getline(table, row);
  EXPECT_EQ(cells(header).size(), cells(row).size());
  EXPECT_NE(row.find(",5e-04,,,,,surface,functional,consistent,"), std::string::npos) << row;
  EXPECT_TRUE(row.ends_with("consistent,,,,,,,,,,")) << row;
}

}  // namespace
}  // namespace goniofit
