#include "fit/comparison.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "report/comparison_report.h"
#include "support/error_message.h"
#include "support/materials.h"
#include "synthetic/simulate.h"

namespace goniofit {
namespace {

using test::error_message;

bool has(const ModelList& list, const std::string& model) {
  return std::find(list.models.begin(), list.models.end(), model) != list.models.end();
}

Scan bare_scan() {
  Scan scan;
  scan.channels.resize(1);
  scan.channels[0].name = "X";
  return scan;
}

TEST(DefaultModels, HesTermsNeedWavelengthsAndAnIndex) {
  Scan scan = bare_scan();
  FitSettings settings;
  const ModelList without = default_models(scan, settings);
  EXPECT_FALSE(has(without, "he-torrance"));
  ASSERT_EQ(without.notes.size(), 1U);
  EXPECT_EQ(without.notes[0].rfind("he-torrance was left out: it needs each channel's wavelength", 0), 0U);
  scan.channels[0].wavelength_um = 0.55;
  const ModelList with = default_models(scan, settings);
  EXPECT_TRUE(has(with, "he-torrance"));
  EXPECT_TRUE(with.notes.empty());
  for (const char* model : {"lambert", "oren-nayar", "lafortune-3", "schlick-double", "rough+dd", "li-torrance"}) {
    EXPECT_TRUE(has(with, model)) << model;
  }
  settings.f0 = {0.04};
  EXPECT_FALSE(has(default_models(scan, settings), "he-torrance"));
  EXPECT_FALSE(has(with, "ward-anisotropic"));
  settings.anisotropic = true;
  EXPECT_TRUE(has(default_models(scan, settings), "ward-anisotropic"));
}

TEST(DefaultModels, EachIsAModel) {
  Scan scan = bare_scan();
  scan.channels[0].wavelength_um = 0.55;
  FitSettings settings;
  settings.anisotropic = true;
  for (const std::string& model : default_models(scan, settings).models) {
    EXPECT_EQ(error_message([&] { (void)settings_for_model(model, settings); }), "no error") << model;
  }
}

TEST(SettingsForModel, ByName) {
  FitSettings base;
  base.components = EffectSet{Effect::dd, Effect::udf};
  base.terms.shadowing = ShadowingTier::none;
  base.terms.fresnel = FresnelTier::exact;
  base.free_optics = FreeOptics::n;
  base.anisotropic = true;
  base.max_theta_deg = 70.0;
  base.parameters["alpha"].value = 0.1;
  base.parameters["R.k_dd"].max = 2.0;

  const FitSettings ward = settings_for_model("ward", base);
  EXPECT_EQ(ward.model, "ward");
  EXPECT_FALSE(ward.components);
  EXPECT_FALSE(ward.anisotropic);
  EXPECT_EQ(ward.terms, (Terms{.fresnel = FresnelTier::exact}));
  EXPECT_EQ(ward.free_optics, FreeOptics::none) << "it reads no n";
  EXPECT_EQ(ward.max_theta_deg, 70.0);
  ASSERT_EQ(ward.parameters.size(), 1U);
  EXPECT_EQ(ward.parameters.begin()->first, "alpha");
  EXPECT_EQ(settings_for_model("ggx", base).free_optics, FreeOptics::n);

  const FitSettings published = settings_for_model("li-torrance", base);
  EXPECT_EQ(published.terms, Terms{});
  EXPECT_EQ(published.components, base.components);
  EXPECT_TRUE(published.anisotropic);
  EXPECT_EQ(published.parameters.begin()->first, "R.k_dd");
  EXPECT_EQ(settings_for_model("he-torrance", base).terms, test::he_torrance_terms());
  EXPECT_EQ(settings_for_model("li-torrance-student-t", base).terms,
            (Terms{.distribution = DistributionTier::student_t}));

  const FitSettings grooves = settings_for_model("oren-nayar", base);
  EXPECT_EQ(grooves.components, EffectSet{Effect::rough});
  EXPECT_EQ(grooves.free_optics, FreeOptics::none);
  const FitSettings both = settings_for_model("rough+dd", base);
  EXPECT_EQ(both.components, (EffectSet{Effect::rough, Effect::dd}));
  EXPECT_EQ(both.terms, base.terms);
  EXPECT_EQ(both.free_optics, FreeOptics::n);
  for (const char* bad : {"", "dd+", "dd+dd", "dd,udf", "phong", "surface"}) {
    EXPECT_THROW((void)settings_for_model(bad, base), Error) << bad;
  }
}

TEST(Compare, TheModelThatMadeTheScanComesFirst) {
  FitSettings settings;
  settings.components = EffectSet{Effect::dd, Effect::uds, Effect::fs};
  const Scan paint = simulate(test::garnet_red_paint_13(), Sampling::incidence_plane, {0.02, 0.0}, 3);
  const Scan peer = simulate(test::anisotropic_ggx(), Sampling::incidence_plane, {0.02, 0.0}, 3);
  const std::vector<std::string> models{"lambert", "ggx-anisotropic", "ward", "li-torrance"};
  EXPECT_EQ(compare(paint, settings, models).rows.front().model, "li-torrance");
  EXPECT_EQ(compare(peer, settings, models).rows.front().model, "ggx-anisotropic");
}

TEST(Compare, TellsOfEachFitBefore) {
  const Scan scan = simulate(test::ground_glass_41(), Sampling::incidence_plane, {}, 1);
  std::vector<std::string> told;
  (void)compare(scan, {}, {"ward", "lambert"}, [&](const std::string& model, std::size_t done, std::size_t total) {
    told.push_back(model + " " + std::to_string(done) + "/" + std::to_string(total));
  });
  EXPECT_EQ(told, (std::vector<std::string>{"ward 0/2", "lambert 1/2"}));
}

FittedParameter parameter(const std::string& channel, const std::string& name, std::optional<double> value) {
  FittedParameter p;
  p.channel = channel;
  p.name = name;
  p.value = value;
  return p;
}

// One row with everything that can be wrong, one exact and sound.
Comparison handmade() {
  Comparison c;
  ComparedFit good{"ggx", {}, 7};
  good.fit.converged = true;
  good.fit.loss = 0.0;
  good.fit.parameters = {parameter("", "alpha", 0.25), parameter("R", "k_d", 0.0)};
  good.fit.parameters[1].at_lower = true;
  ComparedFit bad{"surface", {}, 3};
  bad.fit.loss = 2.0;
  bad.fit.material.components = {Effect::dd};
  bad.fit.parameters = {parameter("", "slope", 10.0), parameter("", "tail", std::nullopt),
                        parameter("", "sigma_um", std::nullopt), parameter("R", "k_dd", 1.0)};
  bad.fit.parameters[0].at_upper = true;
  bad.fit.parameters[2].unit = "um";
  bad.fit.parameters[3].at_upper = true;
  c.rows = {good, bad};
  c.notes = {"a note"};
  return c;
}

TEST(ComparisonReport, FlagsWhatIsWrongAndNothingElse) {
  const Comparison c = handmade();
  EXPECT_TRUE(remarks_of(c.rows[0]).empty()) << "a coefficient of 0 is a result";
  EXPECT_EQ(remarks_of(c.rows[1]), (std::vector<std::string>{"did not converge", "slope at upper bound",
                                                             "tail undetermined", "R.k_dd at upper bound"}));
  const std::string text = comparison_report(c, bare_scan(), {});
  EXPECT_NE(text.find("did not converge, slope at upper bound"), std::string::npos) << text;
  EXPECT_NE(text.find("alpha 0.25"), std::string::npos) << text;
  EXPECT_NE(text.find("a note"), std::string::npos);
  EXPECT_EQ(text.find('\x1b'), std::string::npos);
}

TEST(ComparisonReport, JsonHasNoInfinity) {
  const auto json = nlohmann::json::parse(comparison_json(handmade(), bare_scan()));
  EXPECT_EQ(json.at("rows").at(0).at("relative_loss"), 1.0);
  EXPECT_TRUE(json.at("rows").at(1).at("relative_loss").is_null()) << "beside an exact fit";
  EXPECT_EQ(json.at("rows").at(1).at("remarks").size(), 4U);
  EXPECT_EQ(json.at("rows").at(0).at("parameters").at(1).at("state"), "at lower bound");
}

TEST(ComparisonPlot, RefusesWhatItCannotDraw) {
  EXPECT_EQ(error_message([] { plot_comparison("c.pdf", handmade(), bare_scan()); }),
            "2 c.pdf: a plot is written as .svg or .png, not as '.pdf'");
  EXPECT_EQ(error_message([] { plot_comparison("c.svg", {}, bare_scan()); }), "2 c.svg: there is no model to draw");
}

}  // namespace
}  // namespace goniofit
