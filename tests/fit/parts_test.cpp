// A fit of very many readings, part by part, says what one of all of them in one piece says, in a fraction of its
// memory; and it is not taken in by the readings that it searches.

#include <gtest/gtest.h>

#include <malloc.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <numeric>
#include <string>

#include "fit/fit.h"
#include "fit/linear_parts.h"
#include "fit/model.h"
#include "fit/solve.h"
#include "fit/thinning.h"
#include "fit/uncertainty.h"
#include "support/large_scan.h"
#include "support/materials.h"

namespace goniofit {
namespace {

constexpr std::size_t readings = 110000;

Scan noisy_scan() { return test::half_angle_scan(test::laser_paper_73(), readings, 0.05); }

struct Case {
  const char* name;
  std::function<void(Scan&, FitSettings&)> set;
  double u_to;  // relative: what is told from the readings drawn is an estimate
};

class Parts : public testing::TestWithParam<Case> {};

TEST_P(Parts, SumUpToTheWhole) {
  Scan scan = noisy_scan();
  FitSettings settings = test::paper_settings();
  GetParam().set(scan, settings);
  const Problem whole(scan, settings);
  const Problem parts(scan, settings, Problem::Hold::parts);
  ASSERT_TRUE(parts.by_parts());
  ASSERT_FALSE(whole.by_parts());
  EXPECT_EQ(parts.total, whole.total);
  EXPECT_TRUE(parts.pairs.cos_i.empty());
  const Solved by_parts = solve(parts);
  const Solved at_once = solve(whole);
  const FitPoint& point = by_parts.best.point;
  EXPECT_TRUE(by_parts.best.converged);
  EXPECT_EQ(by_parts.evaluations, at_once.evaluations);
  EXPECT_NEAR(point.loss, at_once.best.point.loss, 1e-12 * point.loss);
  for (std::size_t z = 0; z < point.z.size(); ++z) EXPECT_NEAR(point.z[z], at_once.best.point.z[z], 1e-9);

  const Linearisation l = linearise(whole, point);
  const LinearParts linear_whole(whole, point, l);
  const Linearisation none;
  const LinearParts linear_parts(parts, point, none);
  const NoiseModel noise = noise_model(linear_parts);
  const LinearSums a = linear_sums(linear_parts, &noise);
  const LinearSums b = linear_sums(linear_whole, &noise);
  EXPECT_NEAR(a.loss, b.loss, 1e-12 * b.loss);
  for (std::size_t c = 0; c < whole.channels.size(); ++c) {
    EXPECT_EQ(noise.model[c].relative, noise_model(linear_whole).model[c].relative);
    EXPECT_NEAR(a.differences[c].squares, b.differences[c].squares, 1e-12 * b.differences[c].squares);
    EXPECT_EQ(a.differences[c].values, b.differences[c].values);
    for (const auto triangles : {&LinearSums::triangles, &LinearSums::whitened}) {
      const Eigen::MatrixXd own = (a.*triangles)[c].transpose() * (a.*triangles)[c];
      const Eigen::MatrixXd other = (b.*triangles)[c].transpose() * (b.*triangles)[c];
      const Eigen::VectorXd size = other.diagonal().cwiseSqrt();
      EXPECT_LT(((own - other).array() / (size * size.transpose()).array()).abs().maxCoeff(), 1e-11);
    }
  }

  const Uncertainties u = uncertainties(linear_parts, a);
  const Uncertainties v = uncertainties(linear_whole, b);
  ASSERT_EQ(u.source, v.source);
  const Eigen::VectorXd u_stated = u.covariance.diagonal().cwiseSqrt();
  const Eigen::VectorXd v_stated = v.covariance.diagonal().cwiseSqrt();
  EXPECT_LT((u_stated.array() / v_stated.array() - 1.0).abs().maxCoeff(), GetParam().u_to);
  EXPECT_LT((u.covariance_classical - v.covariance_classical).norm(), 1e-9 * v.covariance_classical.norm());
  EXPECT_LT((u.by_scale - v.by_scale).norm(), 1e-9 * (1.0 + v.by_scale.norm()));
  for (std::size_t z = 0; z < u.shape.size(); ++z) EXPECT_NEAR(u.shape[z].k.at_95, v.shape[z].k.at_95, 0.02);
  if (v.covariance_readings.size() > 0) {
    EXPECT_NEAR(u.reduced_chi_square, v.reduced_chi_square, 1e-10 * v.reduced_chi_square);
  }
}
INSTANTIATE_TEST_SUITE_P(
    Settings, Parts,
    testing::Values(Case{"residuals", [](Scan&, FitSettings&) {}, 0.05},
                    Case{"hc3", [](Scan&, FitSettings& s) { s.uncertainty = UncertaintySource::hc3; }, 1e-8},
                    Case{"stated",
                         [](Scan& scan, FitSettings& s) {
                           for (ScanChannel& c : scan.channels) {
                             for (const double f : c.values) c.u.push_back(0.05 * std::fabs(f) + 1e-3);
                           }
                           s.scale_u = 0.02;
                           s.loss = Loss::inverse_variance;
                         },
                         1e-8},
                    Case{"peer",
                         [](Scan&, FitSettings& s) {
                           s.model = "ggx";
                           s.components.reset();
                           s.uncertainty = UncertaintySource::hc3;
                         },
                         1e-7},
                    Case{"f0_and_values_left_out",
                         [](Scan&, FitSettings& s) {
                           s.free_optics = FreeOptics::f0;
                           s.parameters["k_dd"].value = 0.3;
                           s.exclusions.saturated_from = 5.0;
                           s.uncertainty = UncertaintySource::hc3;
                         },
                         1e-8}),
    [](const testing::TestParamInfo<Case>& tested) { return std::string(tested.param.name); });

// Readings that are not drawn are another surface's: what the search found then is none of theirs.
TEST(PartsSearch, LooksAtAllReadingsWhereTheyContradictThoseDrawn) {
  Scan scan = test::half_angle_scan(test::paper_with_slope(0.5), readings, 0.0);
  const Scan drawn_from = test::half_angle_scan(test::paper_with_slope(0.25), readings, 0.0);
  const FitSettings settings = test::paper_settings();
  const RowSelection drawn = searched_rows(Problem(drawn_from, settings));
  for (const std::size_t row : drawn.rows) {
    for (std::size_t c = 0; c < scan.channels.size(); ++c)
      scan.channels[c].values[row] = drawn_from.channels[c].values[row];
  }
  const Problem parts(scan, settings, Problem::Hold::parts);
  ASSERT_EQ(parts.drawn.rows, drawn.rows);
  const SearchOutcome some = search(parts);
  ASSERT_NEAR(some.minima.front().z[0], std::log(0.25), 0.05);
  const SearchOutcome all = search(parts, 3, true);
  ASSERT_FALSE(all.thinned);
  const Solved solved = solve(parts);
  EXPECT_EQ(solved.evaluations, some.evaluations + all.evaluations);
  const FitPoint best = polish(Problem(scan, settings), all.minima.front()).point;
  EXPECT_NEAR(solved.best.point.loss, best.loss, 1e-11 * best.loss);
  EXPECT_NEAR(solved.best.point.z[0], best.z[0], 1e-8);
  EXPECT_GT(best.loss, 2.0 * some.minima.front().loss);
}

// The verdict is all readings'. What is wrong in a corner that the search hardly looks at is found, and so are single
// readings.
TEST(PartsDiagnosis, MissesNothingInASmallRegion) {
  Scan scan = test::half_angle_scan(test::laser_paper_73(), readings, 0.02);
  const FitResult good = fit(scan, test::paper_settings());
  ASSERT_TRUE(good.diagnostics);
  EXPECT_EQ(good.diagnostics->verdict, FitVerdict::describes);
  EXPECT_EQ(good.diagnostics->outlier_count, 0U);
  const RowSelection drawn = searched_rows(Problem(scan, test::paper_settings()));
  std::vector<std::size_t> planted;
  for (std::size_t row = 1000; planted.size() < 5; row += 20011) {
    while (std::binary_search(drawn.rows.begin(), drawn.rows.end(), row)) ++row;
    planted.push_back(row);
    scan.channels[1].values[row] *= 1.6;
  }
  const FitResult outliers = fit(scan, test::paper_settings());
  EXPECT_EQ(outliers.diagnostics->outlier_count, planted.size());
  for (const Outlier& o : outliers.diagnostics->outliers)
    EXPECT_TRUE(std::find(planted.begin(), planted.end(), o.row) != planted.end()) << o.row;
  std::size_t wrong = 0;
  for (std::size_t row = 0; row < scan.size(); ++row) {
    const Pair pair = make_pair(scan.angles(row));
    if (pair.one_minus_cos_h > 0.001 || pair.cos_i > 0.9) continue;  // within 5° of the retro direction
    ++wrong;
    for (ScanChannel& c : scan.channels) c.values[row] += 40.0;
  }
  ASSERT_LT(wrong, scan.size() / 40);
  const FitResult bad = fit(scan, test::paper_settings());
  EXPECT_EQ(bad.diagnostics->verdict, FitVerdict::fails);
  EXPECT_GT(bad.diagnostics->regions[static_cast<std::size_t>(Region::retro)].of_misfit, 0.3);
}

TEST(PartsReport, SaysWhatIsFromReadingsDrawn) {
  const FitResult r = fit(noisy_scan(), test::paper_settings());
  const auto says = [](const std::string& note) { return note.find("drawn to stand for all") != std::string::npos; };
  EXPECT_EQ(std::count_if(r.notes.begin(), r.notes.end(), says), 1);
  const FitResult small = fit(test::half_angle_scan(test::laser_paper_73(), 20000, 0.05), test::paper_settings());
  EXPECT_TRUE(std::none_of(small.notes.begin(), small.notes.end(), says));
}

// What a fit leaves out since the scan does not show it takes looks at all readings too.
TEST(PartsReport, LeavesOutTheCoherenceThatIsNotThere) {
  FitSettings settings = test::paper_settings();
  settings.components = EffectSet{Effect::coh, Effect::dd, Effect::uds, Effect::fs};
  const FitResult r = fit(noisy_scan(), settings);
  EXPECT_FALSE(r.material.components.has(Effect::coh));
  ASSERT_TRUE(r.parameters.front().value && r.parameters.front().u);
  EXPECT_NEAR(*r.parameters.front().value, *test::laser_paper_73().surface.slope, 5.0 * *r.parameters.front().u);
  const double without = fit(noisy_scan(), test::paper_settings()).loss;
  EXPECT_NEAR(r.loss, without, 1e-9 * without);
}

// What a fit adds to the peak of a process of its own, in scans.
double memory_of_a_fit(const Scan& scan) {
  malloc_trim(0);
  if (!(std::ofstream("/proc/self/clear_refs") << 5)) return 0.0;  // the peak from here on
  const double before = test::process_memory("VmRSS:");
  const FitResult r = fit(scan, test::paper_settings());
  const double scan_bytes = 8.0 * static_cast<double>(scan.size() * (4 + scan.channels.size()));
  return r.converged ? (test::process_memory("VmHWM:") - before) / scan_bytes : 0.0;
}

TEST(PartsMemory, IsAFewScans) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "what is freed stays a while";
#endif
  const Scan scan = test::half_angle_scan(test::laser_paper_73(), 700000, 0.02);
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  const pid_t child = fork();
  if (child == 0) {
    const double scans = memory_of_a_fit(scan);
    _exit(write(ends[1], &scans, sizeof scans) == sizeof scans ? 0 : 1);
  }
  double scans = 0.0;
  ASSERT_EQ(read(ends[0], &scans, sizeof scans), static_cast<ssize_t>(sizeof scans));
  waitpid(child, nullptr, 0);
  if (scans == 0.0) GTEST_SKIP() << "the kernel does not tell a process' peak";
  EXPECT_LT(scans, 3.5);  // and less of larger ones: the readings drawn are as many
  EXPECT_GT(scans, 0.3);
}

}  // namespace
}  // namespace goniofit
