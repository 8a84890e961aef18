// Real scans: the global optimum against a dense search that shares no code with the fit but the evaluation of the
// model.

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <filesystem>
#include <limits>

#include "brdf/evaluator.h"
#include "fit/fit.h"
#include "io/scan_reader.h"
#include "support/paths.h"

namespace goniofit {
namespace {

struct Case {
  const char* file;
  std::vector<std::string> channels;
  EffectSet components;
  double n, kappa;
  double loss, slope;  ///< of an independent search
};

const std::vector<Case> known{
    {"krylon_blue.csv", {"450nm", "550nm", "650nm"}, {Effect::dd, Effect::uds, Effect::fs}, 1.5, 0.0, 24.3605, 0.04524},
    {"steel_sandblasted_mwir.csv", {}, {Effect::dd, Effect::udf}, 4.5, 13.0, 31340.7, 0.00791},
    {"ptfe.csv", {}, {Effect::dd, Effect::uds, Effect::fs}, 1.35, 0.0, 3.63429, 0.565}};

Scan read(const Case& c) {
  Scan scan = read_scan(*test::shared_data() / "measured" / c.file);
  return c.channels.empty() ? scan : select_channels(scan, c.channels);
}

FitResult fit_case(const Case& c, const Scan& scan) {
  FitSettings s;
  s.components = c.components;
  s.n = {c.n};
  s.kappa = {c.kappa};
  return fit(scan, s);
}

TEST(Measured, ReachesTheKnownGlobalOptima) {
  GONIOFIT_SKIP_WITHOUT_SHARED_DATA();
  for (const Case& c : known) {
    const FitResult r = fit_case(c, read(c));
    EXPECT_TRUE(r.converged) << c.file;
    EXPECT_LE(r.loss, 1.0005 * c.loss) << c.file;
    EXPECT_NEAR(*r.material.surface.slope / c.slope, 1.0, 0.002) << c.file;
  }
}

// Best loss of one channel at a slope: all assignments of the coefficients to free or to a bound, by QR.
double best_loss(const Eigen::MatrixXd& a, const Eigen::VectorXd& y) {
  const auto p = static_cast<int>(a.cols());
  int faces = 1;
  for (int i = 0; i < p; ++i) faces *= 3;
  double best = y.squaredNorm();
  for (int face = 0; face < faces; ++face) {
    std::vector<Eigen::Index> free;
    Eigen::VectorXd rest = y;
    bool possible = true;
    for (int i = 0, code = face; i < p; ++i, code /= 3) {
      if (code % 3 == 0) free.push_back(i);
      if (code % 3 == 2) rest -= a.col(i);
      if (code % 3 == 2 && i == 2) possible = false;  // k_fs has no upper bound
    }
    if (!possible) continue;
    if (free.empty()) {
      best = std::min(best, rest.squaredNorm());
      continue;
    }
    Eigen::MatrixXd sub(a.rows(), static_cast<Eigen::Index>(free.size()));
    for (std::size_t i = 0; i < free.size(); ++i) sub.col(static_cast<Eigen::Index>(i)) = a.col(free[i]);
    const Eigen::VectorXd x = sub.householderQr().solve(rest);
    bool inside = true;
    for (std::size_t i = 0; i < free.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      inside = inside && x[at] >= 0.0 && (x[at] <= 1.0 || free[i] == 2);
    }
    if (inside) best = std::min(best, (rest - sub * x).squaredNorm());
  }
  return best;
}

TEST(Measured, NoDenselySearchedSlopeIsBetter) {
  GONIOFIT_SKIP_WITHOUT_SHARED_DATA();
  const Case& c = known[0];
  const Scan scan = read(c);
  const FitResult r = fit_case(c, scan);
  double dense = std::numeric_limits<double>::infinity();
  for (int step = 0; step <= 600; ++step) {
    Material m;
    m.components = c.components;
    m.surface.slope = std::min(10.0, std::exp(std::log(1e-4) + step * std::log(1e5) / 600.0));
    MaterialChannel channel;
    channel.name = "unit";
    channel.n = c.n;
    for (const Coefficient k : {Coefficient::k_dd, Coefficient::k_uds, Coefficient::k_fs}) channel.coefficient(k) = 1.0;
    m.channels = {channel};
    const Evaluator unit(m);
    const auto n = static_cast<Eigen::Index>(scan.size());
    Eigen::MatrixXd a(n, 3);
    Eigen::MatrixXd y(n, 3);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Pair p = make_pair(scan.angles(static_cast<std::size_t>(i)));
      const double w = std::sqrt(p.cos_i);
      a(i, 0) = w * unit.value(p, 0, Effect::dd);
      a(i, 1) = w * unit.value(p, 0, Effect::uds);
      a(i, 2) = w * unit.value(p, 0, Effect::fs);
      for (Eigen::Index k = 0; k < 3; ++k)
        y(i, k) = w * scan.channels[static_cast<std::size_t>(k)].values[static_cast<std::size_t>(i)];
    }
    double loss = 0.0;
    for (Eigen::Index k = 0; k < 3; ++k) loss += best_loss(a, y.col(k));
    dense = std::min(dense, loss);
  }
  EXPECT_LE(r.loss, 1.0001 * dense);
  EXPECT_GE(r.loss, 0.99 * dense);  // the grid's own step leaves it less than 1 % above the minimum
}

TEST(Measured, EveryScanIsFittedOrSaysWhyNot) {
  GONIOFIT_SKIP_WITHOUT_SHARED_DATA();
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(*test::shared_data() / "measured")) {
    const Scan scan = read_scan(entry.path());
    const FitResult r = fit(scan, {});
    ++count;
    EXPECT_TRUE(std::isfinite(r.loss)) << entry.path();
    EXPECT_TRUE(r.converged || !r.warnings.empty()) << entry.path();
    EXPECT_NO_THROW(validate(r.material, "fitted")) << entry.path();
    for (const FittedParameter& p : r.parameters) {
      if (p.value) {
        EXPECT_GE(*p.value, p.lower) << p.channel << p.name;
        EXPECT_LE(*p.value, p.upper) << p.channel << p.name;
      }
    }
  }
  EXPECT_GE(count, 15U);
}

}  // namespace
}  // namespace goniofit
