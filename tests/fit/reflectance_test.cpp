// Directional-hemispherical reflectances fitted beside a scan.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "brdf/evaluator.h"
#include "fit/fit.h"
#include "fit/hemisphere_nodes.h"
#include "support/error.h"
#include "support/materials.h"
#include "synthetic/simulate.h"

namespace goniofit {
namespace {

double by_nodes(const Evaluator& e, double theta_i_deg, std::size_t channel) {
  const Material& m = e.material();
  const double cone = m.components.has(Effect::coh) ? m.solid_angle_sr : 0.0;
  const HemisphereNodes nodes = hemisphere_nodes(theta_i_deg, cone, m.surface.anisotropic());
  double sum = 0.0;
  for (std::size_t i = 0; i < nodes.pairs.size(); ++i) sum += nodes.weight[i] * e.value(nodes.pairs[i], channel);
  return sum;
}

TEST(HemisphereNodes, AgreeWithAdaptiveQuadrature) {
  for (Material m : {test::garnet_red_paint_13(), test::ground_glass_41(), test::smooth_aluminium_45(),
                     test::long_tailed_paint(), test::rough_plaster(), test::brushed_aluminium()}) {
    for (const double slope : {0.001, 0.01, 0.1, 0.4, 1.0}) {
      if (!m.surface.anisotropic()) m.surface.slope = slope;
      if (m.surface.sigma_um) m.surface.tau_um = *m.surface.sigma_um / *m.surface.slope;
      const Evaluator e(m);
      for (const double theta : {0.0, 8.0, 45.0, 70.0, 80.0}) {
        const std::vector<double> exact = hemispherical_reflectance(e, theta);
        const double error = std::fabs(by_nodes(e, theta, 0) / exact[0] - 1.0);
        EXPECT_LT(error, m.surface.anisotropic() ? 6e-3 : 1.5e-3) << m.name << " slope " << slope << " theta " << theta;
      }
    }
  }
}

ReflectanceReadings readings_of(const Material& m, const std::vector<double>& theta_i_deg, double u) {
  ReflectanceReadings out{"dhr.csv", theta_i_deg, {}};
  for (const MaterialChannel& c : m.channels) out.channels.push_back({c.name, {}, {}});
  const Evaluator e(m);
  for (const double theta : theta_i_deg) {
    const std::vector<double> rho = hemispherical_reflectance(e, theta);
    for (std::size_t c = 0; c < rho.size(); ++c) {
      out.channels[c].values.push_back(rho[c]);
      out.channels[c].u.push_back(u);
    }
  }
  return out;
}

FitSettings settings_of(const Material& m) {
  FitSettings s;
  s.components = m.components;
  return s;
}

TEST(Reflectances, AgreeWithTheScanTheyBelongTo) {
  for (const Material& truth : {test::garnet_red_paint_13(), test::smooth_aluminium_45()}) {
    const Scan scan = simulate(truth, Sampling::incidence_plane, {0.0, 0.0}, 1);
    FitSettings s = settings_of(truth);
    s.reflectances = readings_of(truth, {8.0, 30.0, 60.0}, 0.005);
    const FitResult r = fit(scan, s);
    EXPECT_TRUE(r.converged);
    EXPECT_EQ(r.reflectances, 3U);
    ASSERT_EQ(r.fitted_reflectances.size(), 3 * truth.channels.size());
    for (const FittedReflectance& one : r.fitted_reflectances) EXPECT_NEAR(one.fitted / one.measured, 1.0, 2e-3);
    EXPECT_NEAR(*r.material.surface.slope / *truth.surface.slope, 1.0, 1e-4);  // the nodes' own error
    for (std::size_t c = 0; c < truth.channels.size(); ++c) {
      EXPECT_NEAR(*r.material.channels[c].coefficient(Coefficient::k_dd),
                  *truth.channels[c].coefficient(Coefficient::k_dd), 1e-3);
    }
  }
}

// Two incidence angles cannot tell uds from udf; two reflectances at grazing, where T falls, can.
TEST(Reflectances, TellWhatTheScanLeavesOpen) {
  Material truth = test::laser_paper_73();
  truth.components = {Effect::dd, Effect::udf, Effect::uds};
  for (MaterialChannel& c : truth.channels) {
    c.coefficient(Coefficient::k_udf) = 0.2;
    c.coefficient(Coefficient::k_uds) = 0.5;
    c.coefficient(Coefficient::k_fs) = 0.0;
  }
  const Scan whole = simulate(truth, Sampling::incidence_plane, {0.01, 0.0}, 2, true);
  Scan scan = whole;
  const auto keep = [&](std::vector<double>& column) {
    std::vector<double> kept;
    for (std::size_t i = 0; i < whole.size(); ++i) {
      if (whole.theta_i_deg[i] <= 30.0 && whole.theta_r_deg[i] <= 50.0) kept.push_back(column[i]);
    }
    column = std::move(kept);
  };
  for (auto* column : {&scan.theta_i_deg, &scan.phi_i_deg, &scan.theta_r_deg, &scan.phi_r_deg}) keep(*column);
  for (ScanChannel& c : scan.channels) {
    keep(c.values);
    keep(c.u);
  }
  FitSettings s = settings_of(truth);
  s.loss = Loss::inverse_variance;
  const auto u_of = [](const FitResult& r) {
    for (const FittedParameter& p : r.parameters) {
      if (p.name == "k_uds" && p.channel == "G") return p.u.value_or(1.0);
    }
    return 1.0;
  };
  const FitResult alone = fit(scan, s);
  s.reflectances = readings_of(truth, {8.0, 80.0, 85.0}, 0.002);
  const FitResult together = fit(scan, s);
  EXPECT_LT(u_of(together), 0.5 * u_of(alone));
  EXPECT_NEAR(*together.material.channels[1].coefficient(Coefficient::k_uds), 0.5, 5.0 * u_of(together));
}

TEST(Reflectances, GoWithEffectsThatAreChosen) {
  const Material truth = test::ground_glass_41();
  const Scan scan = simulate(truth, Sampling::incidence_plane, {0.02, 0.001}, 1);
  FitSettings s;
  s.reflectances = readings_of(truth, {8.0, 60.0}, 0.005);
  const FitResult r = fit(scan, s);
  EXPECT_TRUE(r.converged);
  EXPECT_TRUE(r.components_were_auto);
  EXPECT_EQ(r.reflectances, 2U);
  EXPECT_TRUE(r.material.components.has(Effect::dd));
}

TEST(Reflectances, OfOtherChannelsAreAnError) {
  const Material truth = test::ground_glass_41();
  const Scan scan = simulate(truth, Sampling::incidence_plane, {0.02, 0.0}, 1);
  FitSettings s = settings_of(truth);
  s.reflectances = ReflectanceReadings{"dhr.csv", {8.0}, {{"550nm", {0.5}, {}}}};
  EXPECT_THROW((void)fit(scan, s), Error);
  s.reflectances = ReflectanceReadings{"dhr.csv", {8.0}, {{"g", {0.5}, {}}}};  // of one channel
  EXPECT_TRUE(fit(scan, s).converged);
}

}  // namespace
}  // namespace goniofit
