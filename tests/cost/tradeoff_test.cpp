#include "cost/tradeoff.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "cost/pareto.h"
#include "support/error_message.h"
#include "support/materials.h"

namespace goniofit::test {
namespace {

TradeoffSettings only(TradeoffGroup group) {
  TradeoffSettings s = TradeoffSettings::quick();
  s.groups = {group};
  return s;
}

const TradeoffRow& row_of(const Tradeoff& t, const std::string& name) {
  const auto found = std::find_if(t.rows.begin(), t.rows.end(), [&](const TradeoffRow& r) { return r.name == name; });
  if (found == t.rows.end()) throw std::runtime_error("no row " + name);
  return *found;
}

// What every table has to keep.
void expect_sound(const Tradeoff& t) {
  std::vector<CostAndError> points;
  for (const TradeoffRow& r : t.rows) {
    EXPECT_GT(r.time.median_ns, 0.0) << r.name;
    EXPECT_LE(r.time.min_ns, r.time.median_ns) << r.name;
    EXPECT_GE(r.time.max_ns, r.time.median_ns) << r.name;
    EXPECT_GE(r.error.l1, 0.0) << r.name;
    EXPECT_GE(r.error.max_relative, r.error.rms_relative) << r.name;
    points.push_back({r.time.median_ns, r.error.l1});
  }
  const std::vector<bool> front = pareto_front(points);
  for (std::size_t i = 0; i < t.rows.size(); ++i) EXPECT_EQ(t.rows[i].pareto, front[i]) << t.rows[i].name;
}

TEST(Tradeoff, Models) {
  TradeoffSettings s = only(TradeoffGroup::model);
  s.peers = {{"lambert", "cook-torrance"}};
  const Tradeoff t = measure_tradeoff({ground_glass_41()}, s);
  expect_sound(t);
  EXPECT_EQ(t.reference, "he-torrance-series, exact terms");
  EXPECT_EQ(row_of(t, "he-torrance-series").error.l1, 0.0);
  EXPECT_LT(row_of(t, "he-torrance").error.max_relative, 1e-7);
  EXPECT_LT(row_of(t, "he-torrance, terms to 1e-4").error.max_relative, 1e-3);
  EXPECT_GT(row_of(t, "he-torrance, terms to 1e-4").error.l1, 0.0);
  EXPECT_LT(row_of(t, "he-torrance, float").error.l1, 1e-3);
  const TradeoffRow& lt = row_of(t, "li-torrance");
  EXPECT_GT(lt.error.l1, 1e-3);
  EXPECT_LT(lt.error.l1, 0.02);
  EXPECT_DOUBLE_EQ(lt.time.ratio, 1.0);
  EXPECT_EQ(lt.ratio_to, "li-torrance");
  EXPECT_TRUE(lt.ns_per_direction);
  EXPECT_LT(lt.error.l1, row_of(t, "cook-torrance").error.l1);
  EXPECT_LT(row_of(t, "cook-torrance").error.l1, row_of(t, "lambert").error.l1);
  EXPECT_LT(row_of(t, "lambert").error.l1, 1.0) << "less than nothing at all: the fit makes the l1 error least";
  EXPECT_EQ(row_of(t, "lambert").model, "lambert");
  EXPECT_FALSE(row_of(t, "lambert").terms);
  EXPECT_GT(row_of(t, "he-torrance-series").time.ratio, 4.0);
  EXPECT_EQ(row_of(t, "li-torrance, one by one").arithmetic, "double, one by one");
  EXPECT_NEAR(row_of(t, "li-torrance, one by one").error.l1, lt.error.l1, 1e-10) << "the same, evaluated otherwise";
}

TEST(Tradeoff, ASlopeAloneIsMeasuredAgainstTheRoughLimit) {
  TradeoffSettings s = only(TradeoffGroup::model);
  s.peers = std::vector<std::string>{};
  const Tradeoff t = measure_tradeoff({garnet_by_slope()}, s);
  EXPECT_NE(t.reference.find("rough-limit, exact terms"), std::string::npos) << t.reference;
  EXPECT_LT(row_of(t, "exact terms").error.l1, 1e-12);
  EXPECT_TRUE(std::none_of(t.rows.begin(), t.rows.end(), [](const TradeoffRow& r) { return r.name == "he-torrance"; }));
}

// The errors that the terms' own comments state, measured elsewhere.
TEST(Tradeoff, Terms) {
  Material glass = laser_paper_73();  // n = 1.5
  const Tradeoff fresnel = measure_tradeoff({glass}, only(TradeoffGroup::fresnel));
  const TradeoffRow& schlick = row_of(fresnel, "schlick");
  ASSERT_TRUE(schlick.term);
  EXPECT_NEAR(schlick.term->error.mean_relative, 0.099, 0.001);
  EXPECT_NEAR(schlick.error.max_relative, 0.23, 0.005);
  EXPECT_GT(schlick.term->gain, 3.0) << "Schlick's gamma";
  EXPECT_EQ(row_of(fresnel, "exact").error.l1, 0.0);
  EXPECT_DOUBLE_EQ(row_of(fresnel, "exact").term->gain, 1.0);
  expect_sound(fresnel);

  const Tradeoff shadowing = measure_tradeoff({glass}, only(TradeoffGroup::shadowing));
  const TradeoffRow& lt = row_of(shadowing, "li-torrance");
  EXPECT_NEAR(lt.error.max_relative, 0.128, 0.002);
  EXPECT_GT(row_of(shadowing, "schlick").term->error.mean_absolute, lt.term->error.mean_absolute);
  // S = 1 where (1 - c)^q < 0.005: at most half a percent off the term without it.
  const TradeoffRow& shortcut = row_of(shadowing, "li-torrance, S = 1 shortcut");
  EXPECT_NE(shortcut.term->error.mean_absolute, lt.term->error.mean_absolute);
  EXPECT_NEAR(shortcut.term->error.mean_absolute, lt.term->error.mean_absolute, 0.005);
  EXPECT_TRUE(shortcut.shadowing_shortcut);

  const Tradeoff roughness = measure_tradeoff({glass}, only(TradeoffGroup::effective_roughness));
  EXPECT_LT(row_of(roughness, "li-torrance").error.l1, row_of(roughness, "none").error.l1);
  const Tradeoff distribution = measure_tradeoff({glass}, only(TradeoffGroup::distribution));
  EXPECT_LT(row_of(distribution, "he-torrance").error.l1, 1e-8);
  EXPECT_GT(row_of(distribution, "rough-limit").error.l1, 0.01);
  EXPECT_GT(row_of(distribution, "student-t").error.l1, 0.01);
}

TEST(Tradeoff, SubsetsOfTheEffects) {
  const Tradeoff t = measure_tradeoff({smooth_aluminium_45()}, only(TradeoffGroup::effects));
  EXPECT_EQ(t.rows.size(), 31U) << "of the five published effects";
  expect_sound(t);
  std::set<std::string> names;
  for (const TradeoffRow& r : t.rows) names.insert(r.name);
  EXPECT_EQ(names.size(), 31U);
  EXPECT_EQ(row_of(t, "coh+dd+udf+uds+fs").error.l1, 0.0);
  EXPECT_GT(row_of(t, "udf").error.l1, row_of(t, "dd+udf").error.l1);

  Material own = garnet_red_paint_13();
  own.name = "not a sample of the paper";
  EXPECT_EQ(measure_tradeoff({own}, only(TradeoffGroup::effects)).rows.size(), 7U) << "of its own three";
}

TEST(Tradeoff, FormsOfGrooves) {
  TradeoffSettings s = only(TradeoffGroup::oren_nayar);
  Material one = garnet_red_paint_13();
  one.channels.resize(1);
  const Tradeoff t = measure_tradeoff({one, ground_glass_41()}, s);
  EXPECT_EQ(t.rows.size(), 3U) << "materials without grooves share one demonstration";
  EXPECT_EQ(row_of(t, "integral").error.l1, 0.0);
  EXPECT_LT(row_of(t, "functional").error.l1, row_of(t, "qualitative").error.l1);
  EXPECT_GT(row_of(t, "integral").time.median_ns, 100.0 * row_of(t, "functional").time.median_ns);
}

TEST(Tradeoff, FitsTellTheSlope) {
  Material m = ground_glass_41();
  m.channels.resize(1);
  const Tradeoff t = measure_tradeoff({m}, only(TradeoffGroup::fit));
  const double truth = *m.surface.slope;
  const TradeoffRow& he = row_of(t, "he-torrance");
  ASSERT_TRUE(he.fit);
  EXPECT_NEAR(he.fit->slope, truth, 1e-6 * truth) << "its own scan";
  EXPECT_LT(he.fit->loss, 1e-12);
  const TradeoffRow& lt = row_of(t, "li-torrance");
  EXPECT_GT(lt.fit->slope_error, 1e-4);
  EXPECT_LT(lt.fit->slope_error, 0.05) << "the cheap model still gives the slope";
  EXPECT_GT(row_of(t, "without shadowing and sigma_e").fit->slope_error, 2.0 * lt.fit->slope_error);
  EXPECT_GT(lt.fit->ms, 0.0);
}

TEST(Tradeoff, ErrorsAreAFunctionOfTheSeed) {
  TradeoffSettings s = only(TradeoffGroup::effects);
  const auto errors = [&] {
    std::vector<double> all;
    for (const TradeoffRow& r : measure_tradeoff({garnet_red_paint_13()}, s).rows) all.push_back(r.error.l1);
    return all;
  };
  const std::vector<double> once = errors();
  EXPECT_EQ(errors(), once);
  s.errors.seed = 2;
  EXPECT_NE(errors(), once);
}

TEST(Tradeoff, Refuses) {
  EXPECT_THROW((void)measure_tradeoff({anisotropic_ggx()}, only(TradeoffGroup::effects)), Error);
  TradeoffSettings s = only(TradeoffGroup::model);
  s.peers = {{"phongg"}};
  EXPECT_NE(error_message([&] { (void)measure_tradeoff({ground_glass_41()}, s); }).find("phongg"), std::string::npos);
}

}  // namespace
}  // namespace goniofit::test
