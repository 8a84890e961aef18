#include "io/recipe_io.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "support/error_message.h"
#include "support/paths.h"

namespace goniofit {
namespace {

using test::error_message;
using Path = std::filesystem::path;

std::string complaint(const std::string& toml) {
  return error_message([&] { (void)parse_recipe(toml, "r.toml"); });
}

TEST(RecipeIo, EmptyRecipeIsTheDefaults) {
  const Recipe r = parse_recipe("", "r.toml");
  EXPECT_EQ(r.source, "r.toml");
  EXPECT_TRUE(r.scans.empty());
  EXPECT_TRUE(r.channels.empty());
  EXPECT_FALSE(r.settings.components);
  EXPECT_EQ(r.settings.terms, Terms{});
  EXPECT_EQ(r.settings.weight, Weight::cosine);
  EXPECT_EQ(r.settings.free_optics, FreeOptics::none);
  EXPECT_EQ(r.settings.max_theta_deg, 90.0);
  EXPECT_EQ(r.seed, 1U);
  EXPECT_FALSE(r.verify);
  EXPECT_FALSE(r.optical_constants);
}

TEST(RecipeIo, ReadsEveryKey) {
  const Recipe r = parse_recipe(R"(
name = "red paint"
scan = ["../data/a.csv", "/abs/b.csv"]
components = ["dd", "uds", "fs"]
loss = "cosine-l2"
weight = "none"
max_theta_deg = 75
solid_angle_sr = 0.001
channels = ["R", "G"]
seed = 7
[terms]
fresnel = "exact"
shadowing = "none"
effective_roughness = "none"
distribution = "rough-limit"
[forms]
fs = "reciprocal"
[optics]
n = [1.7, 2]
kappa = 0.5
[parameters]
slope = 0.1
sigma_um = {value = 0.7}
k_fs = {min = 0.0, max = 10.0}
k_uds = {max = 0.5}
[parameters.R]
k_dd = 0.5
[parameters.G]
k_dd = {min = 0.1}
n = {min = 1.2, max = 2.5}
[verify]
truth = "truth.json"
noise = {relative = 0.05, additive = 0.01, known = true}
sampling = "incidence-plane"
trials = 12
bounds = {slope_bias = 0.02, bias = 0.3, coverage_68 = [0.6, 0.75], coverage_95 = [0.9, 0.99], failure_rate = 0.01}
)",
                                "fits/r.toml");
  EXPECT_EQ(r.name, "red paint");
  EXPECT_EQ(r.scans, (std::vector<Path>{"data/a.csv", "/abs/b.csv"}));
  EXPECT_EQ(r.settings.components, (EffectSet{Effect::dd, Effect::uds, Effect::fs}));
  EXPECT_EQ(r.settings.weight, Weight::none);
  EXPECT_EQ(r.settings.max_theta_deg, 75.0);
  EXPECT_EQ(r.settings.solid_angle_sr, 0.001);
  EXPECT_EQ(r.channels, (std::vector<std::string>{"R", "G"}));
  EXPECT_EQ(r.seed, 7U);
  EXPECT_EQ(r.settings.terms, (Terms{FresnelTier::exact, ShadowingTier::none, EffectiveRoughnessTier::none,
                                     DistributionTier::rough_limit}));
  EXPECT_EQ(r.settings.forms.fs, FsForm::reciprocal);
  EXPECT_EQ(r.settings.n, (std::vector<double>{1.7, 2.0}));
  EXPECT_EQ(r.settings.kappa, (std::vector<double>{0.5}));
  ASSERT_EQ(r.settings.parameters.size(), 7U);
  EXPECT_EQ(r.settings.parameters.at("slope").value, 0.1);
  EXPECT_EQ(r.settings.parameters.at("sigma_um").value, 0.7);
  EXPECT_EQ(r.settings.parameters.at("k_fs").min, 0.0);
  EXPECT_EQ(r.settings.parameters.at("k_fs").max, 10.0);
  EXPECT_EQ(r.settings.parameters.at("k_fs").value, std::nullopt);
  EXPECT_EQ(r.settings.parameters.at("k_uds").min, std::nullopt);
  EXPECT_EQ(r.settings.parameters.at("R.k_dd").value, 0.5);
  EXPECT_EQ(r.settings.parameters.at("G.k_dd").min, 0.1);
  EXPECT_EQ(r.settings.parameters.at("G.n").max, 2.5);
  ASSERT_TRUE(r.verify);
  EXPECT_EQ(r.verify->truth, Path("fits/truth.json"));
  EXPECT_EQ(r.verify->noise.relative, 0.05);
  EXPECT_EQ(r.verify->noise.additive, 0.01);
  EXPECT_EQ(r.verify->sampling, Sampling::incidence_plane);
  EXPECT_EQ(r.verify->trials, 12U);
  EXPECT_EQ(r.verify->slope_bias, 0.02);
  EXPECT_EQ(r.verify->coverage_95, (std::pair{0.9, 0.99}));
  EXPECT_TRUE(r.verify->known_noise);
  EXPECT_EQ(r.verify->bias, 0.3);
  EXPECT_EQ(r.verify->coverage_68, (std::pair{0.6, 0.75}));
  EXPECT_EQ(r.verify->failure_rate, 0.01);
}

TEST(RecipeIo, AutoAndTheNamedTermsAreTheDefaults) {
  const Recipe r = parse_recipe("components = \"auto\"\nterms = \"li-torrance\"\nscan = \"s.csv\"", "/a/b/r.toml");
  EXPECT_FALSE(r.settings.components);
  EXPECT_EQ(r.settings.terms, Terms{});
  EXPECT_EQ(r.scans, (std::vector<Path>{"/a/b/s.csv"}));
}

TEST(RecipeIo, HesTermsByTheirName) {
  const Recipe r = parse_recipe("terms = \"he-torrance\"", "r.toml");
  EXPECT_EQ(r.settings.terms, (Terms{FresnelTier::exact, ShadowingTier::smith, EffectiveRoughnessTier::he,
                                     DistributionTier::he_torrance}));
}

TEST(RecipeIo, AnisotropicSurfaceWithGrooves) {
  const Recipe r = parse_recipe(R"(
components = ["dd", "rough"]
anisotropic = true
terms.distribution = "student-t"
forms = {rough = "qualitative", anisotropy = "printed"}
[parameters]
slope_y = {min = 0.1, max = 0.4}
tail = 2.0
facet_slope_deg = {max = 40}
[parameters.R]
rho = 0.5
)",
                                "r.toml");
  EXPECT_TRUE(r.settings.anisotropic);
  EXPECT_EQ(r.settings.components, (EffectSet{Effect::dd, Effect::rough}));
  EXPECT_EQ(r.settings.forms.rough, RoughForm::qualitative);
  EXPECT_EQ(r.settings.forms.anisotropy, AnisotropyForm::printed);
  EXPECT_EQ(r.settings.forms.fs, FsForm::printed);
  EXPECT_EQ(r.settings.parameters.at("slope_y").max, 0.4);
  EXPECT_EQ(r.settings.parameters.at("tail").value, 2.0);
  EXPECT_EQ(r.settings.parameters.at("R.rho").value, 0.5);
}

TEST(RecipeIo, APeerAndItsParameters) {
  const Recipe r = parse_recipe(R"(
model = "schlick-double"
components = "auto"
terms = {fresnel = "exact"}
[parameters]
p_1 = 1.0
C_2 = {max = 0.5}
[parameters.G]
C_2 = 0.25
)",
                                "r.toml");
  EXPECT_EQ(r.settings.model, "schlick-double");
  EXPECT_FALSE(r.settings.components);
  EXPECT_EQ(r.settings.terms.fresnel, FresnelTier::exact);
  EXPECT_EQ(r.settings.parameters.at("p_1").value, 1.0);
  EXPECT_EQ(r.settings.parameters.at("C_2").max, 0.5);
  EXPECT_EQ(r.settings.parameters.at("G.C_2").value, 0.25);
}

TEST(RecipeIo, FreeOptics) {
  const Recipe n = parse_recipe("[optics]\nn = \"free\"\nkappa = 0.1", "r.toml");
  EXPECT_EQ(n.settings.free_optics, FreeOptics::n);
  EXPECT_TRUE(n.settings.n.empty());
  EXPECT_EQ(n.settings.kappa, (std::vector<double>{0.1}));
  EXPECT_EQ(parse_recipe("optics.f0 = \"free\"", "r.toml").settings.free_optics, FreeOptics::f0);
  EXPECT_EQ(parse_recipe("optics.f0 = 0.05", "r.toml").settings.f0, (std::vector<double>{0.05}));
}

TEST(RecipeIo, OpticalConstantsAreBesideTheRecipe) {
  const Recipe r = parse_recipe("optics.optical_constants = \"../data/aluminium.csv\"", "fits/r.toml");
  EXPECT_EQ(r.optical_constants, Path("data/aluminium.csv"));
}

TEST(RecipeIo, ReadsFiles) {
  const test::ScratchDir folder;
  std::ofstream(folder / "r.toml") << "scan = \"s.csv\"\n";
  EXPECT_EQ(read_recipe(folder / "r.toml").scans, (std::vector<Path>{folder / "s.csv"}));
  EXPECT_EQ(error_message([] { (void)read_recipe("/nowhere/r.toml"); }),
            "2 /nowhere/r.toml: cannot be read: No such file or directory");
}

TEST(RecipeIo, ShippedRecipesAreRead) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::source_dir() / "fits")) {
    if (entry.path().extension() != ".toml") continue;
    ++count;
    const Recipe r = read_recipe(entry.path());
    EXPECT_EQ(r.scans.size(), 1U) << entry.path();
    ASSERT_TRUE(r.verify) << entry.path();
    EXPECT_TRUE(std::filesystem::exists(r.verify->truth)) << r.verify->truth;
  }
  EXPECT_GE(count, 4U);  // the paper's four samples
}

// ---- what is wrong, in exact words

struct BadRecipe {
  std::string name, toml, message;
};
void PrintTo(const BadRecipe& bad, std::ostream* out) { *out << bad.name; }

class BadRecipes : public testing::TestWithParam<BadRecipe> {};

TEST_P(BadRecipes, AreRefusedByKey) { EXPECT_EQ(complaint(GetParam().toml), "2 r.toml" + GetParam().message); }

const std::vector<BadRecipe> bad_recipes{
    {"UnknownKey", "scans = \"a.csv\"",
     ": /scans: is not a known key, expected name, scan, model, components, terms, forms, anisotropic, loss, weight, "
     "robust, exclude, reflectances, "
     "max_theta_deg, solid_angle_sr, channels, seed, uncertainty, scale_u, optics, parameters or verify"},
    {"ScanOfWrongType", "scan = 3", ": /scan: is an integer, expected a path or an array of paths"},
    {"NoScan", "scan = []", ": /scan: is empty, expected at least one path"},
    {"EmptyScan", "scan = [\"a.csv\", \"\"]", ": /scan/1: is empty, expected a path"},
    {"ComponentsOfWrongType", "components = \"dd\"",
     ": /components: is a string, expected \"auto\" or an array of coh, dd, udf, uds, fs or rough"},
    {"NoComponents", "components = []",
     ": /components: is empty, expected \"auto\" or an array of coh, dd, udf, uds, fs or rough"},
    {"UnknownEffect", "components = [\"dd\", \"matt\"]",
     ": /components/1: \"matt\" is not known, expected coh, dd, udf, uds, fs or rough"},
    {"EffectTwice", "components = [\"dd\", \"dd\"]",
     ": /components/1: \"dd\" is named twice, expected each effect once"},
    {"UnknownTerms", "terms = \"torrance\"",
     ": /terms: \"torrance\" is not known, expected \"li-torrance\", \"he-torrance\" or a table of tiers"},
    {"TermsOfWrongType", "terms = 1",
     ": /terms: is an integer, expected \"li-torrance\", \"he-torrance\" or a table of tiers"},
    {"UnknownTier", "terms.shadowing = \"Smith\"",
     ": /terms/shadowing: \"Smith\" is not known, expected li-torrance, smith, schlick or none"},
    {"UnknownRoughForm", "forms.rough = \"exact\"",
     ": /forms/rough: \"exact\" is not known, expected functional, integral or qualitative"},
    {"AnisotropicOfWrongType", "anisotropic = 1", ": /anisotropic: is an integer, expected true or false"},
    {"UnknownModel", "model = \"phong\"", ": /model: \"phong\" is no model, expected one that `goniofit models` names"},
    {"ComponentsOfAPeer", "model = \"ward\"\ncomponents = [\"dd\"]",
     ": /components: is given though the model is ward, which has no effects"},
    {"FormsOfAPeer", "model = \"ward\"\nforms.fs = \"printed\"",
     ": /forms: is given though the model is ward, which has no forms"},
    {"AnisotropicPeer", "model = \"ward\"\nanisotropic = true",
     ": /anisotropic: is given though the model is ward, expected a model that is anisotropic"},
    {"NamedTermsOfAPeer", "model = \"ward\"\nterms = \"li-torrance\"",
     ": /terms: is a string, expected a table of the tier fresnel, which alone this model reads"},
    {"TierOfAPeer", "model = \"ward\"\nterms.shadowing = \"none\"",
     ": /terms/shadowing: is not a known key, expected fresnel"},
    {"ParameterOfAnotherModel", "model = \"ward\"\nparameters.slope = 0.1",
     ": /parameters/slope: is not a parameter, expected alpha, k_d, k_s, n or f0, or a channel's table"},
    {"PeerParameterOutOfRange", "model = \"ward\"\nparameters.alpha = 3",
     ": /parameters/alpha: is 3, expected a number in [0.001, 2]"},
    {"TailOfOne", "parameters.tail = 1", ": /parameters/tail: is 1, expected a number above 1"},
    {"FacetSlopeTooSteep", "parameters.facet_slope_deg = 81",
     ": /parameters/facet_slope_deg: is 81, expected degrees above 0 and up to 80"},
    {"UnknownTerm", "terms.shadow = \"none\"",
     ": /terms/shadow: is not a known key, expected fresnel, shadowing, effective_roughness or distribution"},
    {"UnknownFsForm", "forms.fs = \"both\"", ": /forms/fs: \"both\" is not known, expected printed or reciprocal"},
    {"UnknownLoss", "loss = \"l2\"",
     ": /loss: \"l2\" is not known, expected cosine-l2, inverse-variance, relative, log1p or cube-root"},
    {"UnknownWeight", "weight = \"sine\"",
     ": /weight: \"sine\" is not known, expected cosine, none, cosine-solid-angle or solid-angle"},
    {"UnknownKernel", "robust = \"l1\"",
     ": /robust: \"l1\" is not known, expected none, huber, soft-l1, cauchy or tukey"},
    {"KernelOfWrongType", "robust = 1",
     ": /robust: is an integer, expected none, huber, soft-l1, cauchy or tukey, or a table of kernel and scale"},
    {"RobustScaleZero", "robust = {kernel = \"huber\", scale = 0.0}",
     ": /robust/scale: is 0, expected a number above 0"},
    {"UnknownExclusion", "exclude = {retro = 7.0}",
     ": /exclude/retro: is not a known key, expected retro_deg, saturated or clamped"},
    {"RetroTooLarge", "exclude = {retro_deg = 181.0}", ": /exclude/retro_deg: is 181, expected a number in [0, 180]"},
    {"SaturatedOfWrongType", "exclude = {saturated = \"yes\"}",
     ": /exclude/saturated: is a string, expected true or false"},
    {"ReflectancesEmpty", "reflectances = \"\"", ": /reflectances: is empty, expected a path"},
    {"ThetaTooLarge", "max_theta_deg = 91", ": /max_theta_deg: is 91, expected degrees above 0 and up to 90"},
    {"ThetaNan", "max_theta_deg = nan", ": /max_theta_deg: is nan, expected degrees above 0 and up to 90"},
    {"SolidAngleZero", "solid_angle_sr = 0.0", ": /solid_angle_sr: is 0, expected a number above 0 and below 2 pi"},
    {"ChannelTwice", "channels = [\"R\", \"R\"]", ": /channels/1: \"R\" is named twice, expected each channel once"},
    {"ChannelOfWrongType", "channels = [450]", ": /channels/0: is an integer, expected a channel's name"},
    {"SeedNegative", "seed = -1", ": /seed: is -1, expected a whole number of at least 0"},
    {"SeedFraction", "seed = 1.5", ": /seed: is a floating-point, expected a whole number of at least 0"},
    {"UnknownOptics", "optics.k = 1", ": /optics/k: is not a known key, expected n, kappa, f0 or optical_constants"},
    {"IndexZero", "optics.n = [1.5, 0]", ": /optics/n/1: is 0, expected a number above 0"},
    {"IndexOfWrongType", "optics.n = true", ": /optics/n: is a boolean, expected a number, one a channel, or \"free\""},
    {"IndexOfUnknownWord", "optics.n = \"fitted\"",
     ": /optics/n: \"fitted\" is not known, expected a number or \"free\""},
    {"KappaFree", "optics.kappa = \"free\"", ": /optics/kappa: is a string, expected a number of at least 0"},
    {"TooManyIndices", "channels = [\"R\", \"G\"]\noptics.n = [1.5, 1.5, 1.5]",
     ": /optics/n: has 3 numbers for 2 channels, expected one, or one a channel"},
    {"KappaCountDiffers", "optics = {n = [1.5, 1.5], kappa = [0, 0, 0]}",
     ": /optics/kappa: has 3 numbers where n has 2, expected as many"},
    {"F0BesideKappa", "optics = {f0 = 0.1, kappa = 1}",
     ": /optics/kappa: stands beside f0, expected f0 or n and kappa"},
    {"IndexBesideTable", "optics = {n = 1.5, optical_constants = \"al.csv\"}",
     ": /optics/n: stands beside optical_constants, expected one of the two"},
    {"F0WithExactFresnel", "terms.fresnel = \"exact\"\noptics.f0 = 0.1",
     ": /optics/f0: does not serve fresnel exact, expected n and kappa"},
    {"IndexBeyondAnInteger", "optics.n = 0x7fffffffffffffff\nseed = -1",
     ": /seed: is -1, expected a whole number of at least 0"},
    {"F0AboveOne", "optics.f0 = 1.1", ": /optics/f0: is 1.1, expected a number in [0, 1]"},
    {"UnknownParameter", "parameters.k_ds = 0.5",
     ": /parameters/k_ds: is not a parameter, expected slope, sigma_um, tau_um, slope_y, tail, facet_slope_deg, k_dd, "
     "k_udf, "
     "k_uds, k_fs, rho, n or f0, or a channel's table"},
    {"ParameterOfWrongType", "parameters.k_dd = \"0.5\"",
     ": /parameters/k_dd: is a string, expected a number that fixes it, or {min = ..., max = ...}"},
    {"ParameterNegative", "parameters.k_dd = -0.5", ": /parameters/k_dd: is -0.5, expected a number of at least 0"},
    {"SlopeOutOfRange", "parameters.slope = {max = 11}",
     ": /parameters/slope/max: is 11, expected a number in [1e-06, 10]"},
    {"BoundsCrossed", "parameters.k_fs = {min = 2, max = 1}",
     ": /parameters/k_fs: has min = 2 and max = 1, expected min below max (value fixes)"},
    {"BoundInfinite", "parameters.k_fs = {max = inf}",
     ": /parameters/k_fs/max: is inf, expected a number of at least 0"},
    {"ValueBesideBounds", "parameters.k_fs = {value = 1, max = 2}",
     ": /parameters/k_fs: has a value and bounds, expected one or the other: value fixes, min and max bound"},
    {"EmptyParameter", "parameters.k_fs = {}", ": /parameters/k_fs: is empty, expected value, min or max"},
    {"UnknownBound", "parameters.k_fs = {lower = 0}",
     ": /parameters/k_fs/lower: is not a known key, expected value, min or max"},
    {"SharedUnderChannel", "parameters.R.slope = 0.1",
     ": /parameters/R/slope: is shared by all channels, expected it directly under [parameters]"},
    {"UnknownUnderChannel", "parameters.R.k = 0.1",
     ": /parameters/R/k: is not a parameter of a channel, expected k_dd, k_udf, k_uds, k_fs, rho, n or f0"},
    {"ParameterOfNoChannel", "channels = [\"R\", \"G\"]\nparameters.B.k_dd = 0.1",
     ": /parameters/B: is neither a parameter nor a channel, expected slope, sigma_um, tau_um, slope_y, tail, "
     "facet_slope_deg, k_dd, k_udf, k_uds, k_fs, rho, n or f0, or a channel (R or G)"},
    {"NoTruth", "[verify]\ntrials = 3", ": /verify/truth: is missing, expected the path of a material"},
    {"NoiseNegative", "verify = {truth = \"t.json\", noise = {relative = -0.02}}",
     ": /verify/noise/relative: is -0.02, expected a number of at least 0"},
    {"UnknownSampling", "verify = {truth = \"t.json\", sampling = \"plane\"}",
     ": /verify/sampling: \"plane\" is not known, expected \"incidence-plane\" or \"hemisphere\""},
    {"NoTrials", "verify = {truth = \"t.json\", trials = 0}",
     ": /verify/trials: is 0, expected a whole number from 1 to 1000000"},
    {"CoverageCrossed", "verify = {truth = \"t.json\", bounds = {coverage_95 = [0.97, 0.93]}}",
     ": /verify/bounds/coverage_95: is crossed, expected [smallest, largest]"},
    {"CoverageOfThree", "verify = {truth = \"t.json\", bounds = {coverage_95 = [0.9, 0.93, 0.97]}}",
     ": /verify/bounds/coverage_95: has 3 numbers, expected [smallest, largest]"},
    {"UnknownVerifyBound", "verify = {truth = \"t.json\", bounds = {spread = 0.1}}",
     ": /verify/bounds/spread: is not a known key, expected slope_bias, bias, coverage_68, coverage_95 or "
     "failure_rate"},
    {"FailureRateAboveOne", "verify = {truth = \"t.json\", bounds = {failure_rate = 2}}",
     ": /verify/bounds/failure_rate: is 2, expected a number in [0, 1]"},
    {"KnownOfWrongType", "verify = {truth = \"t.json\", noise = {known = 1}}",
     ": /verify/noise/known: is an integer, expected true or false"},
    {"VerifyOfWrongType", "verify = true", ": /verify: is a boolean, expected a table"},
};

std::string case_name(const testing::TestParamInfo<BadRecipe>& tested) { return tested.param.name; }
INSTANTIATE_TEST_SUITE_P(RecipeIo, BadRecipes, testing::ValuesIn(bad_recipes), case_name);

TEST(RecipeIo, SyntaxErrorsNameTheLine) {
  EXPECT_EQ(complaint("seed = 1\nscan = \n").substr(0, 18), "2 r.toml:2: column");
  EXPECT_EQ(complaint("seed = 1\n\nseed = 2\n").substr(0, 18), "2 r.toml:3: column");
  EXPECT_EQ(complaint("[optics\nn = 1").substr(0, 18), "2 r.toml:1: column");
}

// Each must end in an Error, soon.
TEST(RecipeIo, HostileDocumentsEndInAnError) {
  for (const std::string& text :
       {"scan = " + std::string(100000, '['), "seed = " + std::string(100000, '9'), std::string(2 << 20, '#'),
        std::string("scan = \"\xff\""), std::string("a\0b = 1", 7), "x" + std::string(100000, '.') + "y = 1"}) {
    const std::string message = complaint(text);
    EXPECT_EQ(message.substr(0, 9), "2 r.toml:") << message.substr(0, 200);
    EXPECT_LT(message.size(), 1000U);
  }
}

}  // namespace
}  // namespace goniofit
