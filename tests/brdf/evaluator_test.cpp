#include "brdf/evaluator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "brdf/shape_kernels.h"
#include "geometry/angles.h"
#include "geometry/samplings.h"
#include "support/error.h"
#include "support/materials.h"

namespace goniofit {
namespace {

TEST(Evaluator, ValueIsTheSumOfItsEffects) {
  const Evaluator e(test::garnet_red_paint_13());
  const Pair p = make_pair(in_plane(50.0, 48.0));
  double sum = 0.0;
  for (const Effect effect : all_effects) sum += e.value(p, 1, effect);
  EXPECT_DOUBLE_EQ(e.value(p, 1), sum);
  EXPECT_EQ(e.value(p, 1, Effect::udf), 0.0);
}

TEST(Evaluator, OutsideTheHemisphereIsZero) {
  const Evaluator e(test::laser_paper_73());
  EXPECT_EQ(e.value(make_pair({90.0, 0.0, 30.0, 180.0}), 0), 0.0);
  EXPECT_EQ(e.value(make_pair({30.0, 0.0, 90.0, 180.0}), 0), 0.0);
  EXPECT_EQ(e.value(make_pair({120.0, 0.0, 30.0, 180.0}), 0), 0.0);
}

TEST(Evaluator, SaturatesWhereTheLobeLeavesTheDoubles) {
  // At the mirror towards grazing D ~ 1/m_e² grows without bound: 10^634 at 89.999° for slope 0.001.
  Material m = test::ground_glass_41();
  m.surface = {1e-3, std::nullopt, std::nullopt};
  EXPECT_EQ(Evaluator(m).value(make_pair(in_plane(89.999, 89.999)), 0), saturation);
}

TEST(Evaluator, UnknownCoefficientCountsAsNone) {
  Material m = test::laser_paper_73();
  m.channels[0].coefficient(Coefficient::k_fs).reset();
  EXPECT_EQ(Evaluator(m).value(make_pair(in_plane(70.0, 80.0)), 0, Effect::fs), 0.0);
}

TEST(Evaluator, BatchKernelAgreesWithScalar) {
  std::vector<AnglePair> angles = hemisphere_sampling(true);
  for (const double theta : {0.0, 1e-5, 45.0, 88.0, 89.9}) {
    for (const double r : {0.0, 45.0, -45.0, 89.0}) angles.push_back(in_plane(theta, r));
  }
  const PairBatch pairs(angles);
  std::vector<double> dd(pairs.size());
  std::vector<double> fs(pairs.size());
  for (const double slope : {1e-4, 1e-3, 0.011, 0.172, 0.6, 10.0}) {
    for (const FsForm form : {FsForm::printed, FsForm::reciprocal}) {
      ShapeSettings settings;
      settings.forms.fs = form;
      const SurfaceParameters<double> surface{.log_slope = std::log(slope)};
      shape_columns(pairs, settings, surface.log_slope, dd.data(), fs.data());
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        const Pair p = pairs[i];
        const SurfaceTerms<double> t = surface_terms(settings, surface, p);
        const double dd_scalar = dd_shape(settings, surface, t, 1.0, p);
        const double fs_scalar = fs_shape(settings, surface, t, p);
        // Below 1e-290 the batch's floored exponentials differ; both are zero for any purpose.
        const auto close = [](double a, double b) {
          return std::fabs(a - b) <= 1e-12 * (1.0 + std::fabs(std::log(b))) * b || (a < 1e-290 && b < 1e-290);
        };
        EXPECT_TRUE(close(dd[i], dd_scalar)) << slope << " " << angles[i].theta_i_deg << " " << angles[i].theta_r_deg
                                             << ": " << dd[i] << " " << dd_scalar;
        EXPECT_TRUE(close(fs[i], fs_scalar)) << slope << " " << angles[i].theta_i_deg << " " << angles[i].theta_r_deg
                                             << ": " << fs[i] << " " << fs_scalar;
      }
    }
  }
}

// Closed forms: udf reflects k_udf; uds k (1-f0)² (20/21)(1 - (1-c)^5) under Schlick's F.
TEST(Reflectance, MatchesClosedForms) {
  Material m = test::laser_paper_73();
  m.components = {Effect::udf, Effect::uds};
  m.channels[0].coefficient(Coefficient::k_udf) = 0.3;
  m.channels[0].coefficient(Coefficient::k_uds) = 0.0;
  m.channels[1].coefficient(Coefficient::k_udf) = 0.0;
  const Evaluator e(m);
  for (const double theta : {0.0, 30.0, 60.0, 80.0, 85.0}) {
    const std::vector<double> r = hemispherical_reflectance(e, theta);
    EXPECT_NEAR(r[0], 0.3, 1e-10);
    const double t = 1.0 - 0.04;
    EXPECT_NEAR(r[1], 0.94 * t * t * (20.0 / 21.0) * (1.0 - std::pow(1.0 - cos_deg(theta), 5)), 1e-8) << theta;
  }
}

TEST(Reflectance, DirectionalDiffuseNeverReflectsMoreThanItReceives) {
  Material m = test::ground_glass_41();
  m.components = {Effect::dd};
  m.terms.fresnel = FresnelTier::none;  // F = 1
  for (MaterialChannel& c : m.channels) c.coefficient(Coefficient::k_dd) = 1.0;
  for (const double slope : {0.002, 0.02, 0.2, 0.6, 2.0}) {
    m.surface = {slope, std::nullopt, std::nullopt};
    const Evaluator e(m);
    for (const double theta : {0.0, 30.0, 60.0, 80.0, 85.0}) {
      EXPECT_LE(hemispherical_reflectance(e, theta)[0], 1.0 + 1e-9) << slope << " " << theta;
    }
  }
  // A smooth surface reflects it all.
  m.surface = {0.002, std::nullopt, std::nullopt};
  EXPECT_NEAR(hemispherical_reflectance(Evaluator(m), 20.0)[0], 1.0, 1e-3);
}

TEST(Reflectance, AgreesWithBruteForce) {
  const Evaluator e(test::ground_glass_41());
  for (const double theta : {10.0, 60.0, 80.0}) {
    constexpr std::size_t cells = 1000;
    std::vector<double> sum(3, 0.0);
    for (const HemispherePoint& v : square_cell_centres(cells)) {
      const Pair p = make_pair({theta, 0.0, v.theta_deg, v.phi_deg});
      for (std::size_t c = 0; c < 3; ++c) sum[c] += e.value(p, c) * p.cos_r * 2.0 * pi / (cells * cells);
    }
    const std::vector<double> r = hemispherical_reflectance(e, theta);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(r[c] / sum[c], 1.0, 2e-4) << theta;
  }
}

TEST(Reflectance, ForwardScatterIsFaint) {
  for (Material m : {test::garnet_red_paint_13(), test::laser_paper_73()}) {
    m.components = {Effect::fs};
    for (MaterialChannel& c : m.channels) c.coefficient(Coefficient::k_fs) = 1.0;
    for (const double theta : {30.0, 60.0, 80.0, 85.0}) {
      EXPECT_LE(hemispherical_reflectance(Evaluator(m), theta)[0], 0.002) << m.name << " " << theta;
    }
  }
}

}  // namespace
}  // namespace goniofit
