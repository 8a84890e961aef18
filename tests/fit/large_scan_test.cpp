// What a fit leaves out for speed changes nothing: the search through some readings of a large scan, the dark ones that
// a narrow lobe does not reach, the values that a diagnosis takes from the fit.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "brdf/evaluator.h"
#include "fit/fit.h"
#include "fit/fit_spread.h"
#include "fit/model.h"
#include "fit/profile.h"
#include "fit/solve.h"
#include "fit/thinning.h"
#include "support/large_scan.h"
#include "support/materials.h"
#include "synthetic/simulate.h"

namespace goniofit {
namespace {

class LargeScan : public testing::TestWithParam<double> {};

// The dips of the whole profile are those of the thinned one, the least of them the same, and the fit the whole
// search's: from mirrors to surfaces as rough as any.
TEST_P(LargeScan, SearchedInPartHasTheMinimumOfTheWhole) {
  const Scan scan = test::half_angle_scan(test::paper_with_slope(GetParam()), 110000, 0.05);
  ASSERT_GT(scan.size(), most_searched);
  const Problem problem(scan, test::paper_settings());
  const SearchOutcome some = search(problem);
  const SearchOutcome all = search(problem, 3, true);
  ASSERT_TRUE(some.thinned);
  ASSERT_FALSE(all.thinned);
  EXPECT_LT(searched_rows(problem).rows.size(), 50000U);
  EXPECT_NEAR(some.minima.front().z[0], all.minima.front().z[0], 0.05);
  EXPECT_NEAR(some.minima.front().loss, all.minima.front().loss, 0.2 * all.minima.front().loss);
  const FitPoint of_all = polish(problem, all.minima.front()).point;
  const FitPoint solved = solve(problem).best.point;
  EXPECT_NEAR(solved.z[0], of_all.z[0], 1e-8);
  EXPECT_NEAR(solved.loss, of_all.loss, 1e-11 * of_all.loss);
}
INSTANTIATE_TEST_SUITE_P(Slopes, LargeScan, testing::Values(0.003, 0.02, 0.072, 0.3));

TEST(Thinning, WeightsStandForAllReadings) {
  const Problem problem(test::half_angle_scan(test::laser_paper_73(), 110000, 0.0), test::paper_settings());
  const RowSelection some = searched_rows(problem);
  double count = 0.0;
  double signal = 0.0;
  for (std::size_t i = 0; i < some.rows.size(); ++i) {
    ASSERT_TRUE(i == 0 || some.rows[i - 1] < some.rows[i]);
    const double square = some.factor[i] * some.factor[i];
    count += square;
    for (const ProblemChannel& c : problem.channels)
      signal += square * std::pow(c.target[static_cast<Eigen::Index>(some.rows[i])], 2);
  }
  EXPECT_NEAR(count, static_cast<double>(problem.readings()), 1.0);
  EXPECT_NEAR(signal, problem.total, 0.02 * problem.total);
}

TEST(Thinning, SmallScansAndOtherLossesAreSearchedWhole) {
  const Scan small = simulate(test::laser_paper_73(), Sampling::hemisphere, {0.02, 0.0}, 1);
  EXPECT_TRUE(searched_rows(Problem(small, test::paper_settings())).all());
  FitSettings bent = test::paper_settings();
  bent.loss = Loss::log1p;
  EXPECT_TRUE(searched_rows(Problem(test::half_angle_scan(test::laser_paper_73(), 110000, 0.0), bent)).all());
}

// Column by column as far as the profile's equations see it: the same coefficients and loss as from all rows, by the
// model that skips none.
TEST(Profile, DarkReadingsAreKnownWithoutLooking) {
  const Scan scan = simulate(test::laser_paper_73(), Sampling::hemisphere, {0.02, 0.0}, 5);
  const Problem problem(scan, test::paper_settings());
  Profile profile(problem);
  Model model(problem);
  for (double z = problem.shape.lower[0]; z < problem.shape.upper[0]; z += 0.7) {
    const FitPoint p = profile.point(&z);
    model.set_shape(&z, false);
    double loss = 0.0;
    Eigen::VectorXd r;
    for (std::size_t c = 0; c < problem.channels.size(); ++c) loss += model.residuals(c, p.coefficients[c], r);
    EXPECT_NEAR(p.loss, loss, 1e-12 * problem.total) << z;
  }
}

TEST(Basis, NothingIsLitBelowItsOnset) {
  const Scan scan = simulate(test::laser_paper_73(), Sampling::hemisphere, {0.0, 0.0}, 1);
  for (const FsForm form : {FsForm::printed, FsForm::reciprocal}) {
    FitSettings settings = test::paper_settings();
    settings.forms.fs = form;
    const Problem problem(scan, settings);
    for (std::size_t i = 0; i < problem.readings(); ++i) {
      const double onset = problem.basis->onset(problem.pairs[i]);
      if (!(onset > std::log(slope_min))) continue;
      std::vector<double> values(problem.basis->columns().size());
      for (const double below : {0.0, 0.5, 3.0}) {
        const double z = std::max(onset - below, std::log(slope_min));
        problem.basis->shape_factors(problem.pairs[i], std::span(&z, 1), 1.0, values);
        for (std::size_t j = 0; j < values.size(); ++j) {
          EXPECT_TRUE(values[j] < 1e-30 || !problem.basis->columns()[j].reads_shape) << i;
        }
      }
    }
  }
}

// Values and their uncertainties from the fit's columns are those of its material.
TEST(FittedValues, AreTheMaterials) {
  for (const FreeOptics optics : {FreeOptics::none, FreeOptics::f0}) {
    const Scan scan = simulate(test::laser_paper_73(), Sampling::incidence_plane, {0.05, 1e-4}, 3);
    FitSettings settings = test::paper_settings();
    settings.free_optics = optics;
    if (optics == FreeOptics::f0) settings.parameters["k_dd"].value = 0.3;
    const FitResult r = fit(scan, settings);
    const Problem problem(scan, settings);
    Model model(problem);
    FitPoint point = polish(problem, search(problem).minima.front()).point;
    const std::optional<FittedValues> own = fitted_values(problem, model, point, r.material);
    ASSERT_TRUE(own);
    const std::vector<double> values = Evaluator(r.material).values(problem.pairs);
    const std::vector<double> u = value_uncertainties(r.material, problem.pairs, values);
    const std::size_t channels = problem.channels.size();
    ASSERT_EQ(own->fitted.size(), channels);
    for (std::size_t i = 0; i < values.size(); ++i) {
      EXPECT_NEAR(own->fitted[i % channels][i / channels], values[i], 1e-9 * values[i]) << i;
      EXPECT_NEAR(own->open[i % channels][i / channels], u[i], 1e-6 * u[i] + 1e-9 * values[i]) << i;
    }
  }
}

}  // namespace
}  // namespace goniofit
