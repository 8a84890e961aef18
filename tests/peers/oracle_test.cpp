// Values of another library and of an independent double-precision program at 610 fixed pairs of directions, singular
// ones among them.

#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <sstream>
#include <string>

#include "peer_support.h"
#include "support/paths.h"

namespace goniofit {
namespace {

using test::between;

struct OracleRow {
  std::string kind;
  AnglePair angles;
  std::array<double, 3> value;
};

std::vector<OracleRow> oracle(const std::string& file) {
  std::ifstream in(*test::shared_data() / "peers" / file);
  std::vector<OracleRow> rows;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line.front() == '#' || line.starts_with("idx")) continue;
    std::vector<std::string> cells;
    std::istringstream cut(line);
    for (std::string cell; std::getline(cut, cell, ',');) cells.push_back(cell);
    const auto number = [&cells](std::size_t i) { return std::strtod(cells.at(i).c_str(), nullptr); };
    rows.push_back({cells.at(1),
                    {degrees(number(2)), degrees(number(3)), degrees(number(4)), degrees(number(5))},
                    {number(6), number(7), number(8)}});
  }
  return rows;
}

struct OracleCase {
  std::string file;
  std::size_t set;  // column of the table
  std::string model;
  std::vector<double> z;
  double k_s;
  double index;  // exact Fresnel of this n; 0 for models without F
};

// The largest relative deviation; values that underflow to denormal numbers count by their absolute one.
double worst_deviation(const OracleCase& c, std::string& where) {
  const auto basis = make_peer(c.model);
  std::vector<double> coefficients(basis->coefficients().size(), 0.0);
  coefficients.at(1) = c.k_s;
  const ChannelOptics optics = ChannelOptics::of_index(c.index, 0.0);
  double worst = 0.0;
  const std::vector<OracleRow> rows = oracle(c.file);
  EXPECT_EQ(rows.size(), 610U) << c.file;
  for (const OracleRow& row : rows) {
    const Pair p = make_pair(row.angles);
    const double ours = test::value(*basis, p, c.z, coefficients, optics, FresnelTier::exact);
    const double theirs = row.value.at(c.set);
    const double deviation = std::fabs(ours - theirs) / std::max(theirs, 1e-290);
    if (deviation > worst) {
      worst = deviation;
      where = row.kind + " " + std::to_string(row.angles.theta_i_deg) + " " + std::to_string(row.angles.theta_r_deg) +
              ": " + std::to_string(ours) + " against " + std::to_string(theirs);
    }
  }
  return worst;
}

void expect_agreement(const OracleCase& c) {
  std::string where;
  const double worst = worst_deviation(c, where);
  EXPECT_LT(worst, 1e-10) << c.model << ", set " << c.set + 1 << ": " << where;
  std::printf("%-18s set %zu: largest relative deviation %.1e\n", c.model.c_str(), c.set + 1, worst);
}

TEST(PeerOracle, CookTorrance) {
  GONIOFIT_SKIP_WITHOUT_SHARED_DATA();
  // As printed in 1982: four times ours.
  expect_agreement({"eval_cooktorrance.csv", 0, "cook-torrance", {std::log(0.1)}, 4.0, 1.5});
  expect_agreement({"eval_cooktorrance.csv", 1, "cook-torrance", {std::log(0.3)}, 2.0, 1.8});
  expect_agreement({"eval_cooktorrance.csv", 2, "cook-torrance", {std::log(0.6)}, 1.0, 2.5});
}

TEST(PeerOracle, Ward) {
  GONIOFIT_SKIP_WITHOUT_SHARED_DATA();
  expect_agreement({"eval_ward.csv", 0, "ward", {std::log(0.1)}, 1.0, 1.0});
  expect_agreement({"eval_ward.csv", 0, "ward-anisotropic", {std::log(0.1), std::log(0.1)}, 1.0, 1.0});
  expect_agreement({"eval_ward.csv", 1, "ward-anisotropic", {std::log(0.2), std::log(0.05)}, 0.5, 1.0});
  expect_agreement({"eval_ward.csv", 2, "ward-anisotropic", {std::log(0.4), std::log(0.3)}, 0.25, 1.0});
}

// Lafortune's C_x, C_z, n and albedo in our terms. Set 2 of the table has C_x different from C_y: an anisotropic lobe,
// which no model here has.
OracleCase lafortune_case(std::size_t set, double albedo, double c_xy, double c_z, double n) {
  const double h = std::pow(c_z / -c_xy, n);
  const double k = albedo * std::pow(-c_xy, n) * pi * (1.0 + h) / (n + 2.0);
  return {"eval_lafortune.csv", set, "lafortune-1", {std::log(n), std::log(h)}, k, 1.0};
}

TEST(PeerOracle, Lafortune) {
  GONIOFIT_SKIP_WITHOUT_SHARED_DATA();
  expect_agreement(lafortune_case(0, 1.0, -1.0, 1.0, 20.0));
  expect_agreement(lafortune_case(2, 0.25, -1.02, 0.98, 100.0));
}

TEST(PeerOracle, BlinnPhong) {
  GONIOFIT_SKIP_WITHOUT_SHARED_DATA();
  expect_agreement({"indep_blinnphong.csv", 0, "blinn-phong", {std::log(10.0)}, 1.0, 1.0});
  expect_agreement({"indep_blinnphong.csv", 1, "blinn-phong", {std::log(50.0)}, 0.5, 1.0});
  expect_agreement({"indep_blinnphong.csv", 2, "blinn-phong", {std::log(300.0)}, 0.25, 1.0});
}

TEST(PeerOracle, Ggx) {
  GONIOFIT_SKIP_WITHOUT_SHARED_DATA();
  expect_agreement({"indep_ggxheitz.csv", 0, "ggx", {std::log(0.1)}, 1.0, 1.5});
  expect_agreement({"indep_ggxheitz.csv", 0, "ggx-anisotropic", {std::log(0.1), std::log(0.1)}, 1.0, 1.5});
  expect_agreement({"indep_ggxheitz.csv", 1, "ggx-anisotropic", {std::log(0.3), std::log(0.15)}, 0.5, 1.8});
  expect_agreement({"indep_ggxheitz.csv", 2, "ggx-anisotropic", {std::log(0.5), std::log(0.7)}, 0.25, 2.5});
}

}  // namespace
}  // namespace goniofit
