#include "report/term_curves.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/error_message.h"

namespace goniofit::test {
namespace {

double mean_of(const TermCurves& curves, std::size_t column) {
  double sum = 0.0;
  for (const auto& row : curves.rows) sum += row[column];
  return sum / static_cast<double>(curves.rows.size());
}

TEST(TermCurves, FresnelOfGlass) {
  const TermCurves c = term_curves("fresnel", {.n = 1.5, .steps = 9});
  ASSERT_EQ(c.columns, (std::vector<std::string>{"angle_deg", "exact", "schlick"}));
  ASSERT_EQ(c.rows.size(), 10U);
  EXPECT_NEAR(c.rows[0][1], 0.04, 1e-15);
  EXPECT_NEAR(c.rows[0][2], 0.04, 1e-15);
  // At 60°, sin theta_t = sin 60°/1.5 and so cos theta_t = √(2/3).
  const double inside = std::sqrt(2.0 / 3.0);
  const double r_s = (0.5 - 1.5 * inside) / (0.5 + 1.5 * inside);
  const double r_p = (0.75 - inside) / (0.75 + inside);
  EXPECT_NEAR(c.rows[6][1], 0.5 * (r_s * r_s + r_p * r_p), 1e-15);
  EXPECT_NEAR(c.rows[6][2], 0.04 + 0.96 / 32.0, 1e-15);
  EXPECT_NEAR(c.rows[9][1], 1.0, 1e-15);
}

// The errors of Schlick's G are small against the misprint that it was made for, larger against Smith's own.
TEST(TermCurves, SchlicksShadowingFollowsTheMisprint) {
  const TermCurves c = term_curves("shadowing", {.slope = 0.25});
  double against_smith = 0.0;
  double against_print = 0.0;
  for (const auto& row : c.rows) {
    against_smith = std::max(against_smith, std::fabs(row[3] - row[1]));
    against_print = std::max(against_print, std::fabs(row[3] - row[4]));
    for (std::size_t k = 1; k < row.size(); ++k) {
      EXPECT_GE(row[k], 0.0);
      EXPECT_LE(row[k], 1.0);
    }
  }
  EXPECT_LT(against_print, against_smith);
  EXPECT_GT(against_smith, 0.05);
  EXPECT_EQ(c.rows.back()[1], 0.0) << "nothing is seen at grazing";
}

TEST(TermCurves, EffectiveRoughnessFallsFromSigmaToNothing) {
  const TermCurves c = term_curves("effective_roughness", {.slope = 0.5 / 3.0});
  EXPECT_EQ(c.rows.front()[1], 1.0);
  EXPECT_EQ(c.rows.front()[2], 1.0);
  for (std::size_t i = 1; i < c.rows.size(); ++i) {
    for (const std::size_t k : {1U, 2U}) EXPECT_LE(c.rows[i][k], c.rows[i - 1][k]);
    if (c.rows[i][0] <= 82.0) {
      EXPECT_NEAR(c.rows[i][2], c.rows[i][1], 0.018);
    }
  }
}

// The integral of D t over the hemisphere, 2 ∫ D(t) t dt, is 1 for both.
TEST(TermCurves, SlopesAreNormalised) {
  const TermCurves c = term_curves("slopes", {.slope = 0.2, .steps = 9000});
  for (const std::size_t k : {1U, 2U}) {
    double integral = 0.0;
    for (const auto& row : c.rows) {
      const double theta = row[0] * std::acos(-1.0) / 180.0;
      integral += 2.0 * row[k] * std::cos(theta) * std::sin(theta) * std::acos(-1.0) / 2.0 / 9000.0;
    }
    EXPECT_NEAR(integral, 1.0, 2e-4) << c.columns[k];
  }
}

TEST(TermCurves, OnlyWithoutTheRootHasTheAzimuthAMeanOfOne) {
  const TermCurves c = term_curves("azimuth", {.p = 0.05, .steps = 9000});
  EXPECT_NEAR(mean_of(c, 1), 1.0, 2e-3);
  EXPECT_NEAR(mean_of(c, 2), 0.62, 0.01);
}

TEST(TermCurves, BadRequests) {
  const auto said = [](const char* term, const TermCurveSettings& s) {
    return error_message([&] { (void)term_curves(term, s); });
  };
  EXPECT_NE(said("colour", {}).find("expected fresnel, shadowing"), std::string::npos);
  EXPECT_NE(said("shadowing", {.slope = 0.0}).find("slope 0: expected 0.0001 to 10"), std::string::npos);
  EXPECT_NE(said("slopes", {.slope = 0.7}).find("at most 0.5"), std::string::npos);
  EXPECT_NE(said("azimuth", {.p = 2.0}).find("p 2: expected"), std::string::npos);
  EXPECT_NE(said("fresnel", {.steps = 0}).find("steps 0"), std::string::npos);
}

}  // namespace
}  // namespace goniofit::test
