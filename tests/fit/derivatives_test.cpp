// Every derivative that a fit uses against central differences, over tiers, forms, effects and what is left free.

#include <gtest/gtest.h>

#include <cmath>

#include "fit/model.h"
#include "fit/problem.h"
#include "support/materials.h"
#include "synthetic/simulate.h"

namespace goniofit {
namespace {

struct Case {
  const char* name;
  Material truth;
  Sampling sampling;
  FitSettings settings;
};

Case make(const char* name, const Material& truth, Sampling sampling,
          const std::function<void(FitSettings&)>& change = {}) {
  Case c{name, truth, sampling, {}};
  c.settings.components = truth.components;
  c.settings.terms = truth.terms;
  if (change) change(c.settings);
  return c;
}

std::vector<Case> cases() {
  std::vector<Case> all;
  const Material paint = test::garnet_red_paint_13();
  const Material smooth = test::smooth_aluminium_45();
  all.push_back(make("Paint", paint, Sampling::hemisphere));
  all.push_back(
      make("PaintReciprocal", paint, Sampling::hemisphere, [](FitSettings& s) { s.fs_form = FsForm::reciprocal; }));
  all.push_back(
      make("PaintUnweighted", paint, Sampling::incidence_plane, [](FitSettings& s) { s.weight = Weight::none; }));
  all.push_back(
      make("PaintFreeF0", paint, Sampling::hemisphere, [](FitSettings& s) { s.free_optics = FreeOptics::f0; }));
  all.push_back(
      make("PaintFreeIndex", paint, Sampling::hemisphere, [](FitSettings& s) { s.free_optics = FreeOptics::n; }));
  all.push_back(make("PaintExactFreeIndex", paint, Sampling::hemisphere, [](FitSettings& s) {
    s.terms.fresnel = FresnelTier::exact;
    s.free_optics = FreeOptics::n;
  }));
  all.push_back(make("GlassExactFreeIndex", test::ground_glass_41(), Sampling::hemisphere, [](FitSettings& s) {
    s.terms.fresnel = FresnelTier::exact;
    s.free_optics = FreeOptics::n;
  }));
  all.push_back(make("GlassNoShadowing", test::ground_glass_41(), Sampling::hemisphere,
                     [](FitSettings& s) { s.terms.shadowing = ShadowingTier::none; }));
  all.push_back(make("GlassNoEffectiveRoughness", test::ground_glass_41(), Sampling::hemisphere,
                     [](FitSettings& s) { s.terms.effective_roughness = EffectiveRoughnessTier::none; }));
  all.push_back(make("Coherent", smooth, Sampling::incidence_plane));
  all.push_back(make("CoherentKnownTau", smooth, Sampling::incidence_plane,
                     [](FitSettings& s) { s.parameters["tau_um"].value = 9.9; }));
  all.push_back(make("CoherentAlone", smooth, Sampling::incidence_plane,
                     [](FitSettings& s) { s.components = EffectSet{Effect::coh}; }));
  return all;
}

class Derivatives : public testing::TestWithParam<std::size_t> {};

// Differences of all residuals for a step of one parameter, relative to the analytic column.
double mismatch(const Eigen::VectorXd& analytic, const Eigen::VectorXd& forward, const Eigen::VectorXd& backward,
                double step) {
  const Eigen::VectorXd numeric = (forward - backward) / (2.0 * step);
  return (numeric - analytic).norm() / std::max(analytic.norm(), 1e-300);
}

TEST_P(Derivatives, AgreeWithCentralDifferences) {
  const Case c = cases()[GetParam()];
  const Scan scan = simulate(c.truth, c.sampling, {0.05, 0.0}, 3);
  const Problem problem(scan, c.settings);
  // Away from the truth, so that residuals are not small.
  FitPoint point;
  for (int z = 0; z < problem.shape.free; ++z) {
    const auto i = static_cast<std::size_t>(z);
    const double truth = std::log(z == 0 ? *c.truth.surface.slope : *c.truth.surface.sigma_um);
    point.z.push_back(std::clamp(truth + 0.3, problem.shape.lower[i], problem.shape.upper[i]));
  }
  for (std::size_t channel = 0; channel < problem.channels.size(); ++channel) {
    const auto columns = static_cast<Eigen::Index>(problem.basis->columns().size());
    point.coefficients.emplace_back(SmallVector::Constant(columns, 0.4));
    if (problem.free_optics != FreeOptics::none)
      point.optics.push_back(problem.free_optics == FreeOptics::f0 ? 0.1 : 1.8);
  }
  const Linearisation l = linearise(problem, point);
  const double h = 1e-5;
  for (std::size_t z = 0; z < point.z.size(); ++z) {
    FitPoint up = point;
    FitPoint down = point;
    up.z[z] += h;
    down.z[z] -= h;
    const Linearisation a = linearise(problem, up);
    const Linearisation b = linearise(problem, down);
    for (std::size_t k = 0; k < problem.channels.size(); ++k) {
      EXPECT_LT(mismatch(l.by_shape[k].col(static_cast<Eigen::Index>(z)), a.residuals[k], b.residuals[k], h), 1e-6)
          << "z " << z;
    }
  }
  for (std::size_t k = 0; k < problem.channels.size(); ++k) {
    for (Eigen::Index j = 0; j < point.coefficients[k].size(); ++j) {
      FitPoint up = point;
      FitPoint down = point;
      up.coefficients[k][j] += h;
      down.coefficients[k][j] -= h;
      EXPECT_LT(mismatch(l.by_coefficient[k].col(j), linearise(problem, up).residuals[k],
                         linearise(problem, down).residuals[k], h),
                1e-8);
    }
    if (point.optics.empty()) continue;
    FitPoint up = point;
    FitPoint down = point;
    up.optics[k] += h;
    down.optics[k] -= h;
    EXPECT_LT(mismatch(l.by_optics[k], linearise(problem, up).residuals[k], linearise(problem, down).residuals[k], h),
              1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(EveryConfiguration, Derivatives, testing::Range<std::size_t>(0, cases().size()),
                         [](const auto& each) { return std::string(cases()[each.param].name); });

}  // namespace
}  // namespace goniofit
