#include "brdf/material.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "support/error_message.h"
#include "support/materials.h"

namespace goniofit {
namespace {

using test::error_message;
using test::garnet_by_slope;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

template <class E>
class Names : public testing::Test {};
using Enumerations = testing::Types<Effect, Coefficient, FresnelTier, ShadowingTier, EffectiveRoughnessTier,
                                    DistributionTier, FsForm, RoughForm, AnisotropyForm>;
TYPED_TEST_SUITE(Names, Enumerations);

TYPED_TEST(Names, EveryOfferedNameParsesToItself) {
  const std::string offered = names_of<TypeParam>();
  std::size_t count = 0;
  for (int i = 0; i < 16; ++i) {
    const std::string name(name_of(static_cast<TypeParam>(i)));
    if (name.empty()) break;
    ++count;
    ASSERT_TRUE(parse_name<TypeParam>(name)) << name;
    EXPECT_EQ(static_cast<int>(*parse_name<TypeParam>(name)), i);
    EXPECT_NE(offered.find(name), std::string::npos) << name << " in " << offered;
  }
  EXPECT_GT(count, 0U);
  EXPECT_FALSE(parse_name<TypeParam>(""));
  EXPECT_FALSE(parse_name<TypeParam>("Smith"));
}

TEST(NamesOf, ReadAsASentence) {
  EXPECT_EQ(names_of<Effect>(), "coh, dd, udf, uds, fs or rough");
  EXPECT_EQ(names_of<ShadowingTier>(), "li-torrance, smith, schlick or none");
  EXPECT_EQ(names_of<DistributionTier>(), "rough-limit, he-torrance, he-torrance-series or student-t");
}

TEST(CoefficientOf, CohAndDdShareOne) {
  EXPECT_EQ(coefficient_of(Effect::coh), Coefficient::k_dd);
  EXPECT_EQ(coefficient_of(Effect::dd), Coefficient::k_dd);
  EXPECT_EQ(coefficient_of(Effect::udf), Coefficient::k_udf);
  EXPECT_EQ(coefficient_of(Effect::uds), Coefficient::k_uds);
  EXPECT_EQ(coefficient_of(Effect::fs), Coefficient::k_fs);
  EXPECT_EQ(coefficient_of(Effect::rough), Coefficient::rho);
}

TEST(NormalReflectance, ClosedForms) {
  MaterialChannel c;
  EXPECT_EQ(c.normal_reflectance(), 0.0);
  c.n = 1.5;  // ((1.5 - 1)/(1.5 + 1))² = 0.04
  EXPECT_DOUBLE_EQ(c.normal_reflectance(), 0.04);
  c.n = 1.0;
  EXPECT_EQ(c.normal_reflectance(), 0.0);
  c.kappa = 2.0;  // 4 / (4 + 4)
  EXPECT_DOUBLE_EQ(c.normal_reflectance(), 0.5);
  c.n = 1.47;
  c.kappa = 7.79;  // aluminium at 0.65 µm
  EXPECT_NEAR(c.normal_reflectance(), 0.912, 0.001);
  c.n = 1e200;
  c.kappa = 1e200;
  EXPECT_DOUBLE_EQ(c.normal_reflectance(), 1.0);
  c.f0 = 0.3;
  EXPECT_EQ(c.normal_reflectance(), 0.3);
}

struct Case {
  std::string name;
  std::function<void(Material&)> change;
  std::string message;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

std::string case_name(const testing::TestParamInfo<Case>& tested) { return tested.param.name; }

class Rejected : public testing::TestWithParam<Case> {};

TEST_P(Rejected, ByKeyAndConstraint) {
  Material m = garnet_by_slope();
  GetParam().change(m);
  EXPECT_EQ(error_message([&] { validate(m, "m.json"); }), "2 m.json: " + GetParam().message);
}

double& coefficient(Material& m, Coefficient c) {
  std::optional<double>& k = m.channels[1].coefficient(c);
  if (!k) k = 0.0;
  return *k;
}

const std::string slope_range = "expected a number in [1e-06, 10]";
const std::string length = "expected a finite number above 0";
const std::string amount = "expected a finite number of at least 0";
const std::string not_given = "is not given, expected a number: ";

const std::vector<Case> rejected{
    {"NoEffect", [](Material& m) { m.components = {}; },
     "/components: no effect is named, expected at least one of coh, dd, udf, uds, fs or rough"},
    {"NoChannel", [](Material& m) { m.channels.clear(); }, "/channels: has no channel, expected at least one"},
    {"UnnamedChannel", [](Material& m) { m.channels[2].name = ""; },
     "/channels/2/name: is empty, expected the channel's name"},
    {"ControlCharacter", [](Material& m) { m.channels[0].name = std::string("R\0", 2); },
     "/channels/0/name: has a control character, expected none"},
    {"ParameterName", [](Material& m) { m.channels[0].name = "k_dd"; },
     "/channels/0/name: \"k_dd\" is the name of a parameter, expected another name"},
    {"DuplicatedChannel", [](Material& m) { m.channels[2].name = "R"; },
     "/channels/2/name: there is another channel \"R\", expected different names"},
    {"SlopeZero", [](Material& m) { m.surface.slope = 0.0; }, "/surface/slope: is 0, " + slope_range},
    {"SlopeTooSmall", [](Material& m) { m.surface.slope = 9e-7; }, "/surface/slope: is 9e-07, " + slope_range},
    {"SlopeTooLarge", [](Material& m) { m.surface.slope = 10.5; }, "/surface/slope: is 10.5, " + slope_range},
    {"SlopeNan", [](Material& m) { m.surface.slope = nan; }, "/surface/slope: is nan, " + slope_range},
    {"SlopeMissing", [](Material& m) { m.surface.slope.reset(); }, "/surface/slope: " + not_given + "dd reads it"},
    {"SigmaZero", [](Material& m) { m.surface.sigma_um = 0.0; }, "/surface/sigma_um: is 0, " + length},
    {"TauInfinite", [](Material& m) { m.surface.tau_um = infinity; }, "/surface/tau_um: is inf, " + length},
    {"SlopeDisagrees",
     [](Material& m) {
       m.surface = test::surface(0.5, 5.0);
       m.surface.slope = 0.1000002;
     },
     "/surface/slope: is 0.1000002, expected sigma_um / tau_um = 0.1 within 1e-6 of itself"},
    {"SolidAngleZero", [](Material& m) { m.solid_angle_sr = 0.0; },
     "/solid_angle_sr: is 0, expected a number above 0 and below 2 pi"},
    {"SolidAngleHemisphere", [](Material& m) { m.solid_angle_sr = 2.0 * std::acos(-1.0); },
     "/solid_angle_sr: is 6.283185307179586, expected a number above 0 and below 2 pi"},
    {"WavelengthNegative", [](Material& m) { m.channels[0].wavelength_um = -0.5; },
     "/channels/0/wavelength_um: is -0.5, " + length},
    {"IndexZero", [](Material& m) { m.channels[0].n = 0.0; }, "/channels/0/n: is 0, " + length},
    {"KappaNegative", [](Material& m) { m.channels[0].kappa = -1e-9; }, "/channels/0/kappa: is -1e-09, " + amount},
    {"KappaAlone", [](Material& m) { m.channels[0].n.reset(); },
     "/channels/0/n: is not given though kappa is, expected both"},
    {"F0AboveOne", [](Material& m) { m.channels[0].f0 = 1.5; }, "/channels/0/f0: is 1.5, expected a number in [0, 1]"},
    {"F0BesideIndex", [](Material& m) { m.channels[0].f0 = 0.1; },
     "/channels/0/f0: stands beside n or kappa, expected it in their place"},
    {"NoOptics",
     [](Material& m) {
       m.channels[0].n.reset();
       m.channels[0].kappa.reset();
     },
     "/channels/0/n: is not given, expected n (and kappa) or f0: dd reads it"},
    {"ExactWithF0",
     [](Material& m) {
       m.terms.fresnel = FresnelTier::exact;
       m.channels[0].n.reset();
       m.channels[0].kappa.reset();
       m.channels[0].f0 = 0.04;
     },
     "/channels/0/n: is not given, expected a number: fresnel exact needs n and kappa, f0 does not replace them"},
    {"CoefficientNegative", [](Material& m) { coefficient(m, Coefficient::k_dd) = -0.1; },
     "/channels/1/k_dd: is -0.1, " + amount},
    {"CoefficientNan", [](Material& m) { coefficient(m, Coefficient::k_fs) = nan; },
     "/channels/1/k_fs: is nan, " + amount},
    {"CohWithoutSigma",
     [](Material& m) {
       m.components.insert(Effect::coh);
       m.surface.sigma_um.reset();
     },
     "/surface/sigma_um: " + not_given + "coh reads it"},
    {"CohWithoutWavelength",
     [](Material& m) {
       m.components.insert(Effect::coh);
       m.surface.sigma_um = 0.7;
       m.channels[1].wavelength_um.reset();
     },
     "/channels/1/wavelength_um: " + not_given + "coh reads it"},
    {"SlopeYTooLarge", [](Material& m) { m.surface.slope_y = 11.0; }, "/surface/slope_y: is 11, " + slope_range},
    {"TauYAlone", [](Material& m) { m.surface.tau_y_um = 4.0; },
     "/surface/slope_y: is not given though tau_y_um is, expected both"},
    {"SlopeYDisagrees",
     [](Material& m) {
       m.surface = test::surface(0.5, 5.0);
       m.surface.slope_y = 0.2;
       m.surface.tau_y_um = 5.0;
     },
     "/surface/slope_y: is 0.2, expected sigma_um / tau_y_um = 0.1 within 1e-6 of itself"},
    {"TailOne", [](Material& m) { m.surface.tail = 1.0; }, "/surface/tail: is 1, expected a finite number above 1"},
    {"TailInfinite", [](Material& m) { m.surface.tail = infinity; },
     "/surface/tail: is inf, expected a finite number above 1"},
    {"TailMissing", [](Material& m) { m.terms.distribution = DistributionTier::student_t; },
     "/surface/tail: " + not_given + "distribution student-t reads it"},
    {"TailTooLongForSmith",
     [](Material& m) {
       m.terms.distribution = DistributionTier::student_t;
       m.terms.shadowing = ShadowingTier::smith;
       m.surface.tail = 1.5;
     },
     "/surface/tail: is 1.5, expected a number above 1.5 with shadowing smith: a longer tail has no mean slope, and "
     "such a surface shadows itself entirely"},
    {"FacetSlopeTooSteep", [](Material& m) { m.surface.facet_slope_deg = 81.0; },
     "/surface/facet_slope_deg: is 81, expected a number in [0, 80]"},
    {"FacetSlopeMissing",
     [](Material& m) {
       m.components.insert(Effect::rough);
       coefficient(m, Coefficient::rho) = 0.5;
     },
     "/surface/facet_slope_deg: " + not_given + "rough reads it"},
    {"WaveWithoutSigma", [](Material& m) { m.terms.distribution = DistributionTier::he_torrance; },
     "/surface/sigma_um: " + not_given + "distribution he-torrance reads it"},
    {"WaveWithoutWavelength",
     [](Material& m) {
       m.terms.distribution = DistributionTier::he_torrance_series;
       m.surface.sigma_um = 0.7;
       m.channels[1].wavelength_um.reset();
     },
     "/channels/1/wavelength_um: " + not_given + "distribution he-torrance reads it"},
    {"UnknownModel", [](Material& m) { m.model = "phong"; },
     "/model: \"phong\" is no model, expected one that `goniofit models` names"},
    {"ComponentsOfAPeer", [](Material& m) { m.model = "lambert"; },
     "/components: are named though the model is lambert, which has no effects"},
    {"LossInfinite",
     [](Material& m) {
       m.fit.emplace();
       m.fit->loss = infinity;
     },
     "/fit/loss: is inf, " + amount},
    {"UncertaintyNegative",
     [](Material& m) {
       m.fit.emplace();
       m.fit->channel_uncertainty["R"]["k_dd"] = -1.0;
     },
     "/fit/uncertainty/R/k_dd: is -1, " + amount},
    {"UncertaintyOfNoChannel",
     [](Material& m) {
       m.fit.emplace();
       m.fit->channel_uncertainty["a/b"]["k_dd"] = 1.0;
     },
     "/fit/uncertainty/a~1b: is not a channel of this material"},
    {"UncertaintyOfNoParameter",
     [](Material& m) {
       m.fit.emplace();
       m.fit->channel_uncertainty["R"]["k"] = 1.0;
     },
     "/fit/uncertainty/R/k: is not a parameter of a channel, expected k_dd, k_udf, k_uds, k_fs, rho, n or f0"},
    {"IdentifiableOfNothing",
     [](Material& m) {
       m.fit.emplace();
       m.fit->identifiable["X.k_dd"] = true;
     },
     "/fit/identifiable/X.k_dd: is not a shared parameter, expected slope, sigma_um, tau_um, slope_y, tau_y_um, tail "
     "or "
     "facet_slope_deg, or CHANNEL.PARAMETER, such as R.k_dd"},
};

INSTANTIATE_TEST_SUITE_P(Validate, Rejected, testing::ValuesIn(rejected), case_name);

class RejectedPeer : public testing::TestWithParam<Case> {};

TEST_P(RejectedPeer, ByKeyAndConstraint) {
  Material m = test::anisotropic_ggx();
  ASSERT_EQ(error_message([&] { validate(m, "m.json"); }), "no error") << "what the cases differ from";
  GetParam().change(m);
  EXPECT_EQ(error_message([&] { validate(m, "m.json"); }), "2 m.json: " + GetParam().message);
}

const std::vector<Case> rejected_peers{
    {"ParameterMissing", [](Material& m) { m.parameters.erase("alpha_y"); },
     "/parameters/alpha_y: is not given, expected a number: ggx-anisotropic reads it"},
    {"ParameterNull", [](Material& m) { m.parameters["alpha_x"].reset(); },
     "/parameters/alpha_x: is not given, expected a number: ggx-anisotropic reads it"},
    {"ParameterOutOfRange", [](Material& m) { m.parameters["alpha_x"] = 3.0; },
     "/parameters/alpha_x: is 3, expected a number in [0.001, 2]"},
    {"ParameterOfAnotherModel", [](Material& m) { m.parameters["alpha"] = 0.1; },
     "/parameters/alpha: is not a parameter of ggx-anisotropic"},
    {"CoefficientOfAnotherModel", [](Material& m) { m.channels[1].peer_k["C"] = 0.1; },
     "/channels/1/C: is not a coefficient of ggx-anisotropic"},
    {"CoefficientNegative", [](Material& m) { m.channels[1].peer_k["k_s"] = -1.0; },
     "/channels/1/k_s: is -1, " + amount},
    {"NoOptics",
     [](Material& m) {
       m.channels[0].n.reset();
       m.channels[0].kappa.reset();
     },
     "/channels/0/n: is not given, expected n (and kappa) or f0: ggx-anisotropic reads it"},
    {"ChannelNamedAsAParameter", [](Material& m) { m.channels[0].name = "alpha_x"; },
     "/channels/0/name: \"alpha_x\" is the name of a parameter, expected another name"},
    {"UncertaintyOfTheSurface",
     [](Material& m) {
       m.fit.emplace();
       m.fit->shared_uncertainty["slope"] = 0.1;
     },
     "/fit/uncertainty/slope: is not a shared parameter, expected alpha_x or alpha_y, or the object of a channel"},
    {"UncertaintyOfNoCoefficient",
     [](Material& m) {
       m.fit.emplace();
       m.fit->channel_uncertainty["R"]["k_dd"] = 0.1;
     },
     "/fit/uncertainty/R/k_dd: is not a parameter of a channel, expected k_d, k_s, n or f0"},
};

INSTANTIATE_TEST_SUITE_P(Validate, RejectedPeer, testing::ValuesIn(rejected_peers), case_name);

class Accepted : public testing::TestWithParam<Case> {};

TEST_P(Accepted, WithoutAWord) {
  Material m = garnet_by_slope();
  GetParam().change(m);
  EXPECT_EQ(error_message([&] { validate(m, "m.json"); }), "no error");
}

void forget_coefficients(Material& m, Coefficient c) {
  for (MaterialChannel& channel : m.channels) channel.coefficient(c).reset();
}

const std::vector<Case> accepted{
    {"AsPublished", [](Material&) {}, ""},
    {"CoefficientAboveOne", [](Material& m) { coefficient(m, Coefficient::k_uds) = 7.0; }, ""},
    {"SlopeWithinTolerance",
     [](Material& m) {
       m.surface = test::surface(0.5, 5.0);
       m.surface.slope = 0.1 * (1.0 + 9e-7);
     },
     ""},
    {"SigmaWithoutTau", [](Material& m) { m.surface.sigma_um = 0.7; }, ""},
    {"NoSlopeWhereNothingReadsIt",
     [](Material& m) {
       m.surface.slope.reset();
       m.components = {Effect::udf, Effect::uds};
     },
     ""},
    // An undetermined coefficient evaluates as 0, so that what it multiplies need not be known.
    {"NoSlopeWhereCoefficientsAreNull",
     [](Material& m) {
       m.surface.slope.reset();
       forget_coefficients(m, Coefficient::k_dd);
       forget_coefficients(m, Coefficient::k_fs);
     },
     ""},
    {"NoOpticsForUdf",
     [](Material& m) {
       m.components = {Effect::udf};
       for (MaterialChannel& c : m.channels) {
         c.coefficient(Coefficient::k_udf) = 0.3;
         c.n.reset();
         c.kappa.reset();
       }
     },
     ""},
    {"NoOpticsWithoutFresnel",
     [](Material& m) {
       m.terms.fresnel = FresnelTier::none;
       for (MaterialChannel& c : m.channels) {
         c.n.reset();
         c.kappa.reset();
       }
     },
     ""},
    {"ExactWithIndexAlone",
     [](Material& m) {
       m.terms.fresnel = FresnelTier::exact;
       for (MaterialChannel& c : m.channels) c.kappa.reset();
     },
     ""},
    {"CohWithAllItReads",
     [](Material& m) {
       m.components.insert(Effect::coh);
       m.surface.sigma_um = 0.7;
     },
     ""},
    {"Anisotropic",
     [](Material& m) {
       m.surface = test::surface(0.5, 5.0);
       m.surface.slope_y = 0.25;
       m.surface.tau_y_um = 2.0;
     },
     ""},
    {"TailAboveThreeHalvesWithSmith",
     [](Material& m) {
       m.terms.distribution = DistributionTier::student_t;
       m.terms.shadowing = ShadowingTier::smith;
       m.surface.tail = 1.6;
     },
     ""},
    {"FlatGrooves",
     [](Material& m) {
       m.components = {Effect::rough};
       m.surface = {};
       m.surface.facet_slope_deg = 0.0;
       for (MaterialChannel& c : m.channels) c.coefficient(Coefficient::rho) = 0.5;
     },
     ""},
    // Without a lobe nothing reads the widths.
    {"PeerOfUnknownShape",
     [](Material& m) {
       m = test::anisotropic_ggx();
       m.parameters.clear();
       for (MaterialChannel& c : m.channels) c.peer_k["k_s"].reset();
     },
     ""},
    {"ChannelNameWithDot",
     [](Material& m) {
       m.channels[0].name = "0.65um";
       m.fit.emplace();
       m.fit->identifiable["0.65um.k_dd"] = true;
     },
     ""},
};

INSTANTIATE_TEST_SUITE_P(Validate, Accepted, testing::ValuesIn(accepted), case_name);

TEST(Validate, WithoutAFileNamesTheKeyAlone) {
  Material m = garnet_by_slope();
  m.channels.clear();
  EXPECT_EQ(error_message([&] { validate(m, ""); }), "2 /channels: has no channel, expected at least one");
}

}  // namespace
}  // namespace goniofit
