#include "geometry/samplings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "geometry/angles.h"

namespace goniofit {
namespace {

TEST(Samplings, ConcentricSquareAndBack) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int trial = 0; trial < 5000; ++trial) {
    const SquarePoint p{uniform(random), uniform(random)};
    const SquarePoint q = hemisphere_to_square(square_to_hemisphere(p));
    EXPECT_NEAR(p.u, q.u, 1e-13);
    EXPECT_NEAR(p.v, q.v, 1e-13);
  }
}

TEST(Samplings, EqualAreasAreEqualSolidAngles) {
  // The part of the square within distance r of its middle (maximum norm) is the cap 1 - z <= r².
  const std::vector<HemispherePoint> points = square_cell_centres(400);
  for (const double r : {0.1, 0.5, 0.9}) {
    const auto inside = std::count_if(points.begin(), points.end(),
                                      [r](const HemispherePoint& p) { return 1.0 - cos_deg(p.theta_deg) <= r * r; });
    EXPECT_NEAR(static_cast<double>(inside) / static_cast<double>(points.size()), r * r, 1e-12);
  }
  // And azimuths are uniform: as many in each quarter.
  std::map<int, int> quarter;
  for (const HemispherePoint& p : points) ++quarter[static_cast<int>(std::floor((p.phi_deg + 180.0 - 1e-9) / 90.0))];
  for (const auto& [q, count] : quarter) EXPECT_NEAR(count, 40000, 400) << q;
}

TEST(Samplings, HemisphereIsThePapers) {
  const std::vector<AnglePair> pairs = hemisphere_sampling(false);
  EXPECT_EQ(pairs.size(), 8U * 441U);
  const auto outermost = std::max_element(
      pairs.begin(), pairs.end(), [](const AnglePair& a, const AnglePair& b) { return a.theta_r_deg < b.theta_r_deg; });
  EXPECT_NEAR(outermost->theta_r_deg, 84.67, 0.005);
  EXPECT_EQ(hemisphere_sampling(true).size(), 8U * 442U);
}

TEST(Samplings, IncidencePlaneIsDenseAtTheMirrorAndHasIt) {
  std::map<double, std::vector<double>> by_incidence;
  for (const AnglePair& a : incidence_plane_sampling()) {
    by_incidence[a.theta_i_deg].push_back(a.phi_r_deg == 0.0 ? -a.theta_r_deg : a.theta_r_deg);
  }
  ASSERT_EQ(by_incidence.size(), 5U);
  for (const auto& [theta_i, theta_r] : by_incidence) {
    EXPECT_GE(theta_r.size(), 40U);
    EXPECT_LE(theta_r.size(), 70U);
    EXPECT_EQ(std::count(theta_r.begin(), theta_r.end(), theta_i), 1);
    EXPECT_GE(*std::min_element(theta_r.begin(), theta_r.end()), -85.0);
    EXPECT_LE(*std::max_element(theta_r.begin(), theta_r.end()), 85.0);
    const double mirror = theta_i;
    const auto near =
        std::count_if(theta_r.begin(), theta_r.end(), [mirror](double d) { return std::fabs(d - mirror) <= 4.0; });
    EXPECT_GE(near, 17);
  }
}

}  // namespace
}  // namespace goniofit
