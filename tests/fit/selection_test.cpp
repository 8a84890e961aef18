// Does "auto" find the effects that a scan was made of?

#include "fit/selection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <string>

#include "fit/fit.h"
#include "support/error_message.h"
#include "support/materials.h"
#include "synthetic/simulate.h"

namespace goniofit {
namespace {

constexpr Noise two_percent{0.02, 0.0};

// A material without wavelengths, which leaves coh and its many sets out.
Material without_wavelengths(Material m) {
  for (MaterialChannel& c : m.channels) c.wavelength_um.reset();
  return m;
}

Material red_channel(Material m) {
  m.channels.resize(1);
  return m;
}

bool has(const std::vector<EffectSet>& sets, EffectSet set) {
  return std::find(sets.begin(), sets.end(), set) != sets.end();
}

TEST(Selection, FindsTheEffectsOfThePapersSamples) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    for (const Material& truth : {test::garnet_by_slope(), test::laser_paper_73(), test::ground_glass_41()}) {
      const Scan scan = simulate(without_wavelengths(truth), Sampling::incidence_plane, two_percent, seed);
      const Selection s = select_components(scan, {});
      EXPECT_EQ(s.chosen(), truth.components) << truth.name << ": " << s.reason;
      ASSERT_TRUE(s.noise);
      EXPECT_NEAR(s.noise->relative, 0.02, 0.003) << truth.name;
      EXPECT_EQ(s.groups, 5U);
    }
  }
}

TEST(Selection, FindsTheMirrorAndTheGrooves) {
  const Material mirror = test::smooth_aluminium_45();
  EXPECT_EQ(select_components(simulate(mirror, Sampling::incidence_plane, two_percent, 1), {}).chosen(),
            mirror.components);
  const Material plaster = without_wavelengths(test::rough_plaster());
  EXPECT_EQ(select_components(simulate(plaster, Sampling::incidence_plane, two_percent, 1), {}).chosen(),
            plaster.components);
}

TEST(Selection, TheReportSaysHowItChose) {
  const Scan scan =
      simulate(red_channel(without_wavelengths(test::laser_paper_73())), Sampling::hemisphere, two_percent, 2);
  const FitResult r = fit(scan, {});
  ASSERT_TRUE(r.selection);
  EXPECT_TRUE(r.components_were_auto);
  EXPECT_EQ(r.notes.front(), r.selection->reason);
  EXPECT_EQ(r.material.components, r.selection->chosen());
  const std::vector<SelectionRow>& rows = r.selection->rows;
  EXPECT_EQ(std::count_if(rows.begin(), rows.end(), [](const SelectionRow& row) { return row.chosen; }), 1);
  double aicc = 0.0;
  double bic = 0.0;
  for (const SelectionRow& row : rows) {
    aicc += row.aicc_weight;
    bic += row.bic_weight;
    EXPECT_GT(row.bic, row.chi2);
  }
  EXPECT_NEAR(aicc, 1.0, 1e-12);
  EXPECT_NEAR(bic, 1.0, 1e-12);
  EXPECT_NEAR(rows.front().chi2 / static_cast<double>(scan.size()), 1.0, 0.1);
  EXPECT_NEAR(*rows.front().cross_validated, 1.0, 0.1);
  EXPECT_NEAR(rows.front().loss / r.loss, 1.0, 1e-4);

  const FitResult again = fit(scan, {});
  EXPECT_EQ(again.loss, r.loss);
  EXPECT_EQ(*again.selection->rows.front().cross_validated, *rows.front().cross_validated);
}

TEST(Selection, TriesWhatOpticsAndReadingsAllow) {
  const Scan paper = simulate(without_wavelengths(test::laser_paper_73()), Sampling::incidence_plane, {}, 1);
  const std::vector<EffectSet> dielectric = sensible_components(paper, {});
  EXPECT_EQ(dielectric.size(), 14U);
  EXPECT_TRUE(has(dielectric, {Effect::dd, Effect::udf, Effect::uds, Effect::fs}));
  EXPECT_FALSE(has(dielectric, {Effect::fs}));
  EXPECT_FALSE(has(dielectric, {Effect::udf, Effect::rough}));

  const Scan glass = simulate(without_wavelengths(test::ground_glass_41()), Sampling::incidence_plane, {}, 1);
  for (const EffectSet set : sensible_components(glass, {})) {
    EXPECT_FALSE(set.has(Effect::uds) || set.has(Effect::fs) || set.has(Effect::coh));
  }
  const Scan mirror = simulate(test::smooth_aluminium_45(), Sampling::incidence_plane, {}, 1);
  EXPECT_TRUE(has(sensible_components(mirror, {}), {Effect::coh, Effect::dd}));

  FitSettings steep;
  steep.max_theta_deg = 35.0;  // where T(cos_i) T(cos_r) of glass is flat to 0.1 %
  for (const EffectSet set : sensible_components(paper, steep)) EXPECT_FALSE(set.has(Effect::udf));
}

TEST(Selection, HeedsWhatTheSettingsFix) {
  const Scan paper = simulate(without_wavelengths(test::laser_paper_73()), Sampling::incidence_plane, two_percent, 1);
  FitSettings s;
  s.parameters["k_fs"].value = 0.0;
  s.parameters["k_udf"].value = 0.1;
  for (const EffectSet set : sensible_components(paper, s)) {
    EXPECT_TRUE(set.has(Effect::udf));
    EXPECT_FALSE(set.has(Effect::fs));
  }
  s.parameters["rho"].value = 0.5;  // beside udf, which it excludes
  EXPECT_EQ(test::error_message([&] { (void)fit(paper, s); }),
            "2 components auto: the parameters that are fixed leave no effect to fit");
}

TEST(Selection, WithFewIncidenceAnglesTheBicDecides) {
  const Scan full = simulate(without_wavelengths(test::laser_paper_73()), Sampling::incidence_plane, two_percent, 1);
  FitSettings s;
  s.max_theta_deg = 50.0;
  const Selection selection = select_components(full, s);
  EXPECT_EQ(selection.groups, 0U);
  EXPECT_NE(selection.reason.find("least BIC"), std::string::npos);
  for (const SelectionRow& row : selection.rows) {
    EXPECT_GE(row.bic, selection.rows.front().bic);
    EXPECT_FALSE(row.cross_validated);
  }
}

// Grooves can stand in for udf, neither set being within the other.
TEST(Selection, DoesNotLetGroovesStandInForWhatIsSignificant) {
  Material m = test::ground_glass_41();
  m.surface = test::slope_alone(0.08577);
  const std::array<double, 3> k_dd{0.2002, 0.1239, 0.04841};
  const std::array<double, 3> k_udf{0.0433, 0.07142, 0.03072};
  for (std::size_t c = 0; c < 3; ++c) {
    m.channels[c].coefficient(Coefficient::k_dd) = k_dd[c];
    m.channels[c].coefficient(Coefficient::k_udf) = k_udf[c];
  }
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Scan scan = simulate(without_wavelengths(m), Sampling::hemisphere, two_percent, seed);
    const Selection s = select_components(scan, {});
    EXPECT_TRUE(s.chosen().has(Effect::udf)) << s.reason;
  }
}

TEST(Selection, TakesTheScansOwnUncertainties) {
  const Noise noise{0.01, 0.002};
  const Material truth = red_channel(without_wavelengths(test::laser_paper_73()));
  Scan scan = simulate(truth, Sampling::incidence_plane, noise, 4, true);
  const Selection stated = select_components(scan, {});
  EXPECT_FALSE(stated.noise);
  EXPECT_LT(stated.u_scale, 1.1);
  EXPECT_EQ(stated.chosen(), truth.components);
  EXPECT_NEAR(stated.rows.front().chi2 / static_cast<double>(scan.size()), 1.0, 0.15);

  for (double& u : scan.channels.front().u) u /= 3.0;  // too small: what is left over is no evidence
  const Selection too_small = select_components(scan, {});
  EXPECT_NEAR(too_small.u_scale, 3.0, 0.4);
  EXPECT_EQ(too_small.chosen(), truth.components);
}

// Ten bands, of which one alone shows light from below the surface.
TEST(Selection, OfManyChannelsSomeSpeakForAll) {
  Material m = red_channel(without_wavelengths(test::laser_paper_73()));
  m.components = {Effect::dd, Effect::udf, Effect::uds};
  const MaterialChannel common = m.channels.front();
  m.channels.clear();
  for (int band = 0; band < 10; ++band) {
    MaterialChannel c = common;
    c.name = "band" + std::to_string(band);
    c.coefficient(Coefficient::k_udf) = 0.2 + 0.01 * band;
    c.coefficient(Coefficient::k_uds) = band == 7 ? 0.6 : 0.0;
    m.channels.push_back(c);
  }
  const Scan scan = simulate(m, Sampling::incidence_plane, two_percent, 1);
  const Selection s = select_components(scan, {});
  EXPECT_EQ(s.chosen(), m.components) << s.reason;
  EXPECT_GE(s.channels.size(), 6U);
  EXPECT_LT(s.channels.size(), 10U);
  EXPECT_NE(std::find(s.channels.begin(), s.channels.end(), "band7"), s.channels.end());
}

}  // namespace
}  // namespace goniofit
