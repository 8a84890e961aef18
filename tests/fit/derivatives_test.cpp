// Every derivative that a fit uses against central differences, over tiers, forms, effects and what is left free.

#include <gtest/gtest.h>

#include <cmath>

#include "fit/loss.h"
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

ReflectanceReadings reflectances_of_paint() {
  return {"",
          {8.0, 60.0},
          {{"R", {0.1, 0.2}, {0.01, 0.01}}, {"g", {0.05, 0.1}, {0.01, 0.02}}, {"B", {0.04, 0.1}, {0.01, 0.01}}}};
}

std::vector<Case> cases() {
  std::vector<Case> all;
  const Material paint = test::garnet_red_paint_13();
  const Material smooth = test::smooth_aluminium_45();
  all.push_back(make("Paint", paint, Sampling::hemisphere));
  all.push_back(
      make("PaintReciprocal", paint, Sampling::hemisphere, [](FitSettings& s) { s.forms.fs = FsForm::reciprocal; }));
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
  const Material he = test::he_ground_glass();
  all.push_back(make("HeTorrance", he, Sampling::incidence_plane));
  all.push_back(make("HeTorranceSeries", he, Sampling::incidence_plane,
                     [](FitSettings& s) { s.terms.distribution = DistributionTier::he_torrance_series; }));
  all.push_back(make("HeTorranceKnownTau", he, Sampling::incidence_plane,
                     [](FitSettings& s) { s.parameters["tau_um"].value = 5.2; }));
  Material smooth_he = smooth;
  smooth_he.terms = test::he_torrance_terms();
  all.push_back(make("HeTorranceSmoothCoherent", smooth_he, Sampling::incidence_plane));
  all.push_back(make("SchlickShadowing", paint, Sampling::hemisphere,
                     [](FitSettings& s) { s.terms.shadowing = ShadowingTier::schlick; }));
  all.push_back(make("SmithShadowing", paint, Sampling::hemisphere,
                     [](FitSettings& s) { s.terms.shadowing = ShadowingTier::smith; }));
  all.push_back(make("HeRoughness", paint, Sampling::hemisphere,
                     [](FitSettings& s) { s.terms.effective_roughness = EffectiveRoughnessTier::he; }));
  const Material tailed = test::long_tailed_paint();
  all.push_back(make("StudentT", tailed, Sampling::hemisphere));
  all.push_back(make("StudentTWithItsShadowing", tailed, Sampling::hemisphere,
                     [](FitSettings& s) { s.terms.shadowing = ShadowingTier::smith; }));
  const Material brushed = test::brushed_aluminium();
  const auto anisotropic = [](FitSettings& s) { s.anisotropic = true; };
  all.push_back(make("Anisotropic", brushed, Sampling::hemisphere, anisotropic));
  all.push_back(make("AnisotropicPrinted", brushed, Sampling::hemisphere, [](FitSettings& s) {
    s.anisotropic = true;
    s.forms.anisotropy = AnisotropyForm::printed;
  }));
  Material brushed_he = brushed;
  brushed_he.terms = test::he_torrance_terms();
  brushed_he.surface.sigma_um = 0.3;
  all.push_back(make("AnisotropicHeTorrance", brushed_he, Sampling::hemisphere, anisotropic));
  Material brushed_paper = test::laser_paper_73();
  brushed_paper.surface.slope_y = 0.3;
  all.push_back(make("AnisotropicForwardScatter", brushed_paper, Sampling::hemisphere, [](FitSettings& s) {
    s.anisotropic = true;
    s.forms.fs = FsForm::reciprocal;
  }));
  const Material plaster = test::rough_plaster();
  all.push_back(make("Rough", plaster, Sampling::hemisphere));
  all.push_back(make("RoughQualitative", plaster, Sampling::hemisphere,
                     [](FitSettings& s) { s.forms.rough = RoughForm::qualitative; }));
  all.push_back(make("RoughIntegral", plaster, Sampling::incidence_plane, [](FitSettings& s) {
    s.components = EffectSet{Effect::rough};
    s.forms.rough = RoughForm::integral;
  }));
  for (const Loss loss : {Loss::inverse_variance, Loss::relative, Loss::log1p, Loss::cube_root}) {
    const char* const names[] = {"", "PaintInverseVariance", "PaintRelative", "PaintLog1p", "PaintCubeRoot"};
    all.push_back(make(names[static_cast<std::size_t>(loss)], paint, Sampling::incidence_plane, [&](FitSettings& s) {
      s.loss = loss;
      s.weight = Weight::cosine_solid_angle;
      s.reflectances = reflectances_of_paint();
    }));
  }
  all.push_back(make("CoherentCubeRootWithReflectances", smooth, Sampling::incidence_plane, [](FitSettings& s) {
    s.loss = Loss::cube_root;
    s.reflectances = ReflectanceReadings{"", {10.0, 50.0}, {{"550nm", {0.9, 0.88}, {0.01, 0.01}}}};
  }));
  return all;
}

// The point at which a case is differentiated: away from the truth, so that residuals are not small.
FitPoint point_of(const Case& c, const Problem& problem) {
  FitPoint point;
  for (int z = 0; z < problem.shape.free; ++z) {
    const auto i = static_cast<std::size_t>(z);
    const ShapeParameter& p = problem.basis->shape_parameters()[static_cast<std::size_t>(problem.shape.row[i])];
    const double truth = c.truth.model == surface_model ? Surface(c.truth.surface).find(p.name)->value_or(1.0)
                                                        : *c.truth.parameters.at(p.name);
    point.z.push_back(std::clamp(std::log(truth - p.origin) + 0.3, problem.shape.lower[i], problem.shape.upper[i]));
  }
  for (std::size_t channel = 0; channel < problem.channels.size(); ++channel) {
    const auto coefficients = static_cast<Eigen::Index>(problem.basis->coefficients().size());
    point.coefficients.emplace_back(SmallVector::Constant(coefficients, 0.4));
    if (problem.free_optics != FreeOptics::none)
      point.optics.push_back(problem.free_optics == FreeOptics::f0 ? 0.1 : 1.8);
  }
  return point;
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
  const bool plain = c.settings.loss == Loss::cosine_l2;
  const Scan scan = simulate(c.truth, c.sampling, {0.05, plain ? 0.0 : 1e-3}, 3, !plain);
  const Problem problem(scan, c.settings);
  const FitPoint point = point_of(c, problem);
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

// A kernel's residuals come reweighted, so it is the gradient of the loss that differences have to find.
TEST(Derivatives, OfEveryLossUnderEveryKernelAreTheLosssOwn) {
  for (const Loss loss : {Loss::cosine_l2, Loss::inverse_variance, Loss::relative, Loss::log1p, Loss::cube_root}) {
    for (const RobustKernel kernel :
         {RobustKernel::huber, RobustKernel::soft_l1, RobustKernel::cauchy, RobustKernel::tukey}) {
      const Case c = make("", test::garnet_red_paint_13(), Sampling::incidence_plane, [&](FitSettings& s) {
        s.loss = loss;
        s.reflectances = reflectances_of_paint();
      });
      Problem problem(simulate(c.truth, c.sampling, {0.05, 1e-3}, 3, true), c.settings);
      FitPoint point = point_of(c, problem);
      const double typical = std::sqrt(linearise(problem, point).loss / static_cast<double>(problem.values_used()));
      problem.make_robust(RobustLoss(kernel, typical));
      const Linearisation l = linearise(problem, point);
      double gradient = 0.0;
      for (std::size_t k = 0; k < problem.channels.size(); ++k)
        gradient += 2.0 * l.by_shape[k].col(0).dot(l.residuals[k]);
      const double h = 1e-5;
      point.z[0] += h;
      const double up = linearise(problem, point).loss;
      point.z[0] -= 2.0 * h;
      const double down = linearise(problem, point).loss;
      point.z[0] += h;
      EXPECT_NEAR((up - down) / (2.0 * h) / gradient, 1.0, 1e-5) << name_of(loss) << " " << name_of(kernel);
      const double by_k = 2.0 * l.by_coefficient[0].col(0).dot(l.residuals[0]);
      point.coefficients[0][0] += h;
      const double more = linearise(problem, point).loss;
      point.coefficients[0][0] -= 2.0 * h;
      const double less = linearise(problem, point).loss;
      EXPECT_NEAR((more - less) / (2.0 * h) / by_k, 1.0, 1e-5) << name_of(loss) << " " << name_of(kernel);
      double squares = 0.0;
      for (const Eigen::VectorXd& r : l.residuals) squares += r.squaredNorm();
      EXPECT_LE(squares, l.loss) << "the polish takes what is missing for a constant";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(EveryConfiguration, Derivatives, testing::Range<std::size_t>(0, cases().size()),
                         [](const auto& each) { return std::string(cases()[each.param].name); });

}  // namespace
}  // namespace goniofit
