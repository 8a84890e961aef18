#include "geometry/solid_angles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "geometry/angles.h"
#include "geometry/samplings.h"

namespace goniofit {
namespace {

std::vector<Direction> cell_centres(std::size_t n) {
  std::vector<Direction> directions;
  for (const HemispherePoint& p : square_cell_centres(n)) directions.push_back(direction_of(p.theta_deg, p.phi_deg));
  return directions;
}

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

TEST(SolidAngles, OfEqualCellsAreEqual) {
  const std::vector<double> parts = solid_angles(cell_centres(21));
  EXPECT_NEAR(sum(parts), 2.0 * pi, 1e-12);
  for (const double part : parts) EXPECT_NEAR(part, 2.0 * pi / 441, 0.25 * 2.0 * pi / 441);
}

// By counting which of many directions, spread evenly, is nearest to which.
TEST(SolidAngles, AreThoseOfTheNearestDirections) {
  std::vector<Direction> directions;
  for (const double theta : {0.0, 20.0, 25.0, 60.0, 85.0}) {
    for (double phi = 0.0; phi < 360.0; phi += 30.0 + theta) directions.push_back(direction_of(theta, phi + theta));
    if (theta == 0.0) directions.resize(1);
  }
  const std::vector<double> parts = solid_angles(directions);
  std::vector<double> counted(directions.size(), 0.0);
  const std::vector<Direction> all = cell_centres(301);
  for (const Direction& v : all) {
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < directions.size(); ++i) {
      if (dot(v, directions[i]) > dot(v, directions[nearest])) nearest = i;
    }
    counted[nearest] += 2.0 * pi / static_cast<double>(all.size());
  }
  EXPECT_NEAR(sum(parts), 2.0 * pi, 1e-12);
  for (std::size_t i = 0; i < parts.size(); ++i)
    EXPECT_NEAR(parts[i] / counted[i], 1.0, 0.04) << i << ", counted from 90601";
}

TEST(SolidAngles, OfOneDirectionAreAll) {
  EXPECT_NEAR(solid_angles({direction_of(40.0, 10.0)})[0], 2.0 * pi, 1e-12);
  const std::vector<double> twice = solid_angles({direction_of(40.0, 10.0), direction_of(40.0, 10.0)});
  EXPECT_NEAR(twice[0], pi, 1e-12);
  EXPECT_NEAR(twice[1], pi, 1e-12);
}

TEST(ArcLengths, AreHalfTheWayToBothNeighbours) {
  EXPECT_EQ(arc_lengths({0.0, 10.0, -5.0, 30.0}), (std::vector<double>{7.5, 15.0, 5.0, 20.0}));
  EXPECT_EQ(arc_lengths({0.0, 10.0, 10.0}), (std::vector<double>{10.0, 5.0, 5.0}));
  EXPECT_EQ(arc_lengths({3.0, 3.0}), (std::vector<double>{0.5, 0.5}));
}

}  // namespace
}  // namespace goniofit
