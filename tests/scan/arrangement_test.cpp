#include "scan/arrangement.h"

#include <gtest/gtest.h>

#include <sstream>

#include "io/scan_reader.h"

namespace goniofit {
namespace {

Scan read(const std::string& text) {
  std::istringstream in(text);
  return read_scan(in, "s.csv");
}

std::vector<Rows> nested(const RowGroups& groups) {
  std::vector<Rows> out;
  for (std::size_t g = 0; g < groups.size(); ++g) out.emplace_back(groups[g].begin(), groups[g].end());
  return out;
}

TEST(Arrangement, ALineGoesThroughTheNormalFromRetroToForward) {
  const Scan scan = read(
      "theta_i,phi_i,theta_r,phi_r,R\n30,0,20,180,1\n30,0,10,0,1\n30,0,10,180,1\n30,0,40,-10,1\n30,0,40,170,1\n"
      "30,0,5,90,1\n30,0,5,-90,1\n45,0,5,-90,1\n30,7,6,97,1\n");
  const std::vector<Rows> lines = nested(detector_lines(scan));
  ASSERT_EQ(lines.size(), 5U);
  const std::vector<Rows> expected{{6, 5}, {3, 4}, {1, 2, 0}, {8}, {7}};
  EXPECT_EQ(lines, expected);
}

TEST(Arrangement, AtNormalIncidenceTheLineIsTheDetectorsAzimuth) {
  const Scan scan = read("theta_i,phi_i,theta_r,phi_r,R\n0,0,20,90,1\n0,40,10,-90,1\n0,0,10,0,1\n");
  const std::vector<Rows> expected{{1, 0}, {2}};
  EXPECT_EQ(nested(detector_lines(scan)), expected);
}

TEST(Arrangement, SwappedPairsAreMatchedLeftAndRight) {
  const Scan scan = read(
      "theta_i,phi_i,theta_r,phi_r,R\n30,0,60,170,2\n60,0,30,-170,1\n60,0,30,170,3\n30,0,30,170,9\n10,0,60,170,-1\n"
      "60,0,10,170,1\n");
  const SwappedRows pairs = swapped_rows(scan);
  ASSERT_EQ(pairs.size(), 2U);
  const std::vector<double> ratios = swapped_ratios(scan.channels[0].values, pairs);
  ASSERT_EQ(ratios.size(), 1U) << "the pair with a negative value has no ratio";
  EXPECT_DOUBLE_EQ(ratios[0], 1.0);
}

TEST(Arrangement, AnglesFromMirrorAndRetro) {
  const Pair pair = make_pair({30, 0, 45, 180});
  EXPECT_NEAR(from_mirror_deg(pair), 15.0, 1e-12);
  EXPECT_NEAR(from_retro_deg(pair), 75.0, 1e-12);
}

}  // namespace
}  // namespace goniofit
