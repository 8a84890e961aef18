// Which model does a scan call for?

#include <gtest/gtest.h>

#include <algorithm>

#include "fit/comparison.h"
#include "support/materials.h"
#include "synthetic/simulate.h"

namespace goniofit {
namespace {

const ComparedFit& chosen(const Comparison& c) {
  return *std::find_if(c.rows.begin(), c.rows.end(), [](const ComparedFit& row) { return row.criteria.chosen; });
}

Scan paper(bool with_uncertainty) {
  Material m = test::laser_paper_73();
  m.channels.resize(1);
  m.channels.front().wavelength_um.reset();
  return simulate(m, Sampling::incidence_plane, {0.02, 1e-5}, 5, with_uncertainty);
}

TEST(ComparisonCriteria, ChooseTheModelThatMadeTheScan) {
  const Comparison c = compare(paper(false), {}, {"lambert", "ward", "ggx", "cook-torrance", "li-torrance"});
  EXPECT_EQ(chosen(c).model, "li-torrance") << c.verdict;
  EXPECT_NE(c.verdict.find("li-torrance"), std::string::npos);
  ASSERT_TRUE(c.noise);
  EXPECT_NEAR(c.noise->relative, 0.02, 0.004);
  EXPECT_EQ(c.groups, 5U);
  double weights = 0.0;
  for (const ComparedFit& row : c.rows) {
    weights += row.criteria.bic_weight;
    ASSERT_TRUE(row.criteria.difference);
    EXPECT_GE(*row.criteria.difference, 0.0);
  }
  EXPECT_NEAR(weights, 1.0, 1e-12);
  EXPECT_NEAR(chosen(c).criteria.chi2 / static_cast<double>(paper(false).size()), 1.0, 0.2);
}

TEST(ComparisonCriteria, ChooseTheSimplestOfThoseThatAgree) {
  Material flat;
  flat.name = "flat";
  flat.components = {Effect::udf};
  flat.channels = {test::channel("R", 0.65, 1.5, 0.0, 0.0, 0.5, 0.0, 0.0)};
  const Scan scan = simulate(flat, Sampling::incidence_plane, {0.02, 0.0}, 2);
  const Comparison c = compare(scan, {}, {"rough+dd", "ward", "oren-nayar", "lambert"});
  EXPECT_EQ(chosen(c).model, "lambert") << c.verdict;
  EXPECT_EQ(chosen(c).criteria.free_parameters, 1U);
}

TEST(ComparisonCriteria, TakeTheScansOwnUncertainties) {
  const Comparison c = compare(paper(true), {}, {"lambert", "li-torrance"});
  EXPECT_FALSE(c.noise);
  EXPECT_LT(c.u_scale, 1.1);
  EXPECT_EQ(chosen(c).model, "li-torrance");
}

TEST(ComparisonCriteria, WithFewIncidenceAnglesTheBicDecides) {
  FitSettings s;
  s.max_theta_deg = 50.0;
  const Comparison c = compare(paper(false), s, {"lambert", "li-torrance"});
  EXPECT_EQ(c.groups, 0U);
  EXPECT_FALSE(chosen(c).criteria.cross_validated);
  EXPECT_NE(c.verdict.find("least BIC"), std::string::npos);
}

}  // namespace
}  // namespace goniofit
