#include "geometry/angles.h"

#include <gtest/gtest.h>

#include <cmath>

namespace goniofit {
namespace {

TEST(Angles, ExactWhereTheValueIs) {
  EXPECT_EQ(sin_deg(0.0), 0.0);
  EXPECT_EQ(cos_deg(90.0), 0.0);
  EXPECT_EQ(sin_deg(90.0), 1.0);
  EXPECT_EQ(sin_deg(30.0), 0.5);
  EXPECT_EQ(cos_deg(60.0), 0.5);
  EXPECT_EQ(sin_deg(180.0), 0.0);
  EXPECT_EQ(cos_deg(180.0), -1.0);
  EXPECT_EQ(cos_deg(-270.0), 0.0);
  EXPECT_EQ(sin_deg(-90.0), -1.0);
  EXPECT_EQ(sin_deg(150.0), 0.5);
  EXPECT_EQ(cos_deg(120.0), -0.5);
}

TEST(Angles, AgreesWithRadians) {
  for (double d = -720.0; d <= 720.0; d += 0.37) {
    EXPECT_NEAR(sin_deg(d), std::sin(radians(d)), 2e-15) << d;
    EXPECT_NEAR(cos_deg(d), std::cos(radians(d)), 2e-15) << d;
  }
}

TEST(Angles, GrazingKeepsRelativeAccuracy) {
  // cos(90° - x) is sin(x): no cancellation however small x is.
  for (double x = 1e-12; x < 1.0; x *= 10.0) {
    const double left = 90.0 - (90.0 - x);  // what the subtraction leaves of x
    EXPECT_NEAR(cos_deg(90.0 - x) / std::sin(radians(left)), 1.0, 1e-15) << x;
  }
}

TEST(Angles, WrapIsExactAndHalfOpen) {
  EXPECT_EQ(wrap_deg(180.0), 180.0);
  EXPECT_EQ(wrap_deg(-180.0), 180.0);
  EXPECT_EQ(wrap_deg(540.0), 180.0);
  EXPECT_EQ(wrap_deg(359.5), -0.5);
  EXPECT_EQ(wrap_deg(-725.25), -5.25);
}

}  // namespace
}  // namespace goniofit
