#include "io/material_io.h"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "support/error_message.h"
#include "support/materials.h"
#include "support/paths.h"
#include "support/replaced.h"

namespace goniofit {

namespace {

using test::error_message;
using test::garnet_by_slope;
using test::replaced;

// Every key of the format.
const std::string complete = R"({
  "format": "goniofit-material",
  "version": 1,
  "name": "Garnet Red Paint #13",
  "components": [
    "dd",
    "uds",
    "fs"
  ],
  "terms": {
    "fresnel": "schlick",
    "shadowing": "li-torrance",
    "effective_roughness": "li-torrance",
    "distribution": "rough-limit"
  },
  "surface": {
    "slope": 0.0854,
    "sigma_um": null,
    "tau_um": null,
    "slope_y": null,
    "tau_y_um": null,
    "tail": null,
    "facet_slope_deg": null
  },
  "forms": {
    "fs": "printed",
    "rough": "functional",
    "anisotropy": "consistent"
  },
  "channels": [
    {
      "name": "R",
      "wavelength_um": 0.65,
      "n": 1.7,
      "kappa": 0.0,
      "k_dd": 0.59,
      "k_udf": 0.0,
      "k_uds": 0.1,
      "k_fs": 1.1,
      "rho": 0.0
    }
  ],
  "solid_angle_sr": 0.0005,
  "fit": {
    "loss": 0.25,
    "rms": 0.5,
    "samples": 1,
    "converged": true,
    "uncertainty": {
      "slope": 0.001,
      "R": {
        "k_dd": 0.02
      }
    },
    "identifiable": {
      "R.k_fs": false,
      "sigma_um": false,
      "slope": true
    }
  }
}
)";

TEST(MaterialIo, ReadsEveryKey) {
  const Material m = parse_material(complete, "m.json");
  EXPECT_EQ(m.name, "Garnet Red Paint #13");
  EXPECT_EQ(m.components, (EffectSet{Effect::dd, Effect::uds, Effect::fs}));
  EXPECT_EQ(m.terms, Terms{});
  EXPECT_EQ(m.surface, test::slope_alone(0.0854));
  ASSERT_EQ(m.channels.size(), 1U);
  EXPECT_EQ(m.channels[0].coefficient(Coefficient::k_fs), 1.1);
  EXPECT_EQ(m.channels[0].wavelength_um, 0.65);
  ASSERT_TRUE(m.fit);
  EXPECT_EQ(m.fit->samples, 1U);
  EXPECT_EQ(m.fit->channel_uncertainty.at("R").at("k_dd"), 0.02);
  EXPECT_FALSE(m.fit->identifiable.at("R.k_fs"));
}

TEST(MaterialIo, WritesTheDocumentedText) { EXPECT_EQ(to_json(parse_material(complete, "m.json")), complete); }

TEST(MaterialIo, HandWrittenMaterialNeedsLittle) {
  const Material m = parse_material(R"({"format": "goniofit-material", "version": 1, "components": ["coh", "dd"],
    "surface": {"sigma_um": 0.7, "tau_um": 8.2},
    "channels": [{"name": "550nm", "wavelength_um": 0.55, "f0": 0.07, "k_dd": 1}]})",
                                    "m.json");
  EXPECT_EQ(m.surface.slope, 0.7 / 8.2);
  EXPECT_EQ(m.channels[0].f0, 0.07);
  EXPECT_EQ(m.channels[0].n, std::nullopt);
  EXPECT_EQ(m.channels[0].coefficient(Coefficient::k_udf), std::nullopt);
  EXPECT_EQ(m.solid_angle_sr, default_solid_angle_sr);
  EXPECT_FALSE(m.fit);
}

TEST(MaterialIo, ReadsOtherTiersAndForms) {
  std::string text = replaced(complete, "\"fresnel\": \"schlick\"", "\"fresnel\": \"exact\"");
  text = replaced(text, "\"shadowing\": \"li-torrance\"", "\"shadowing\": \"none\"");
  text = replaced(text, "\"fs\": \"printed\"", "\"fs\": \"reciprocal\"");
  const Material m = parse_material(text, "m.json");
  EXPECT_EQ(m.terms.fresnel, FresnelTier::exact);
  EXPECT_EQ(m.terms.shadowing, ShadowingTier::none);
  EXPECT_EQ(m.forms.fs, FsForm::reciprocal);
}

TEST(MaterialIo, ReadsHesTermsAndAnAnisotropicSurface) {
  std::string text = replaced(complete, "\"fresnel\": \"schlick\"", "\"fresnel\": \"exact\"");
  text = replaced(text, "\"shadowing\": \"li-torrance\"", "\"shadowing\": \"smith\"");
  text = replaced(text, "\"effective_roughness\": \"li-torrance\"", "\"effective_roughness\": \"he\"");
  text = replaced(text, "rough-limit", "he-torrance");
  text = replaced(text,
                  "\"slope\": 0.0854,\n    \"sigma_um\": null,\n    \"tau_um\": null,\n    \"slope_y\": null,\n    "
                  "\"tau_y_um\": null",
                  "\"sigma_um\": 0.5, \"tau_um\": 5.0, \"tau_y_um\": 2.0");
  text = replaced(text, "consistent", "printed");
  const Material m = parse_material(text, "m.json");
  EXPECT_EQ(m.terms, (Terms{FresnelTier::exact, ShadowingTier::smith, EffectiveRoughnessTier::he,
                            DistributionTier::he_torrance}));
  EXPECT_EQ(m.surface.slope, 0.1) << "derived";
  EXPECT_EQ(m.surface.slope_y, 0.25) << "derived";
  EXPECT_EQ(m.forms.anisotropy, AnisotropyForm::printed);
  EXPECT_EQ(parse_material(to_json(m), "m.json"), m);
}

TEST(MaterialIo, ReadsGroovesAndLongTails) {
  std::string text = replaced(complete, "\"dd\",", "\"dd\", \"rough\",");
  text = replaced(text, "rough-limit", "student-t");
  text = replaced(text, "\"tail\": null", "\"tail\": 2.5");
  text = replaced(text, "\"facet_slope_deg\": null", "\"facet_slope_deg\": 25");
  text = replaced(text, "functional", "integral");
  text = replaced(text, "\"rho\": 0.0", "\"rho\": 0.4");
  const Material m = parse_material(text, "m.json");
  EXPECT_TRUE(m.components.has(Effect::rough));
  EXPECT_EQ(m.terms.distribution, DistributionTier::student_t);
  EXPECT_EQ(m.surface.tail, 2.5);
  EXPECT_EQ(m.surface.facet_slope_deg, 25.0);
  EXPECT_EQ(m.forms.rough, RoughForm::integral);
  EXPECT_EQ(m.channels[0].coefficient(Coefficient::rho), 0.4);
}

TEST(MaterialIo, FilesGoThroughTheSameText) {
  const test::ScratchDir folder;
  write_material(folder / "paint.json", garnet_by_slope());
  EXPECT_EQ(read_material(folder / "paint.json"), garnet_by_slope());
}

TEST(MaterialIo, MissingFileIsNamed) {
  EXPECT_EQ(error_message([] { (void)read_material("/nowhere/m.json"); }),
            "2 /nowhere/m.json: cannot be read: No such file or directory");
}

TEST(MaterialIo, FolderIsNoMaterial) {
  const test::ScratchDir folder;
  EXPECT_EQ(error_message([&] { (void)read_material(folder.path()); }),
            "2 " + folder.path().string() + ": cannot be read: Is a directory");
}

TEST(MaterialIo, NothingUnreadableIsWritten) {
  Material m = garnet_by_slope();
  m.surface.slope = std::numeric_limits<double>::quiet_NaN();
  const test::ScratchDir folder;
  EXPECT_EQ(error_message([&] { write_material(folder / "m.json", m); }),
            "2 Garnet Red Paint #13: /surface/slope: is nan, expected a number in [1e-06, 10]");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(MaterialIo, NameThatIsNotUtf8IsStillWritten) {
  Material m = garnet_by_slope();
  m.name = "Bl\xe4ulich";
  EXPECT_EQ(parse_material(to_json(m), "m.json").name, "Bl\xef\xbf\xbdulich");
}

// ---- what is wrong, in exact words

struct BadMaterial {
  std::string name, from, to, message;
};
void PrintTo(const BadMaterial& bad, std::ostream* out) { *out << bad.name; }

class BadMaterials : public testing::TestWithParam<BadMaterial> {};

TEST_P(BadMaterials, AreRefusedByKey) {
  const BadMaterial& bad = GetParam();
  const std::string text = replaced(complete, bad.from, bad.to);
  EXPECT_EQ(error_message([&] { (void)parse_material(text, "m.json"); }), "2 m.json" + bad.message);
}

const std::string components = "[\n    \"dd\",\n    \"uds\",\n    \"fs\"\n  ]";
const std::string forms =
    "{\n    \"fs\": \"printed\",\n    \"rough\": \"functional\",\n    \"anisotropy\": \"consistent\"\n  }";

const std::vector<BadMaterial> bad_materials{
    {"NoFormat", "\"format\": \"goniofit-material\",", "", ": /format: is missing"},
    {"OtherFormat", "goniofit-material", "gltf", ": /format: is \"gltf\", expected \"goniofit-material\""},
    {"LaterVersion", "\"version\": 1", "\"version\": 2", ": /version: is 2, expected 1"},
    {"FractionalVersion", "\"version\": 1", "\"version\": 1.5",
     ": /version: is \"1.5\", expected a whole number of at least 0"},
    {"OtherModel", "\"version\": 1", "\"version\": 1, \"model\": \"ward\"",
     ": /forms: is not a known key, expected format, version, name, model, components, terms, parameters, channels, "
     "solid_angle_sr or fit"},
    {"NameOfWrongType", "\"Garnet Red Paint #13\"", "13", ": /name: is a number, expected a string"},
    {"UnknownKey", "\"solid_angle_sr\"", "\"solid_angle\"",
     ": /solid_angle: is not a known key, expected format, version, name, model, components, terms, surface, forms, "
     "channels, solid_angle_sr or fit"},
    {"NoComponents", components, "[]",
     ": /components: no effect is named, expected at least one of coh, dd, udf, uds, fs or rough"},
    {"ComponentsOfWrongType", components, "\"dd\"", ": /components: is a string, expected an array"},
    {"UnknownEffect", "\"uds\"", "\"ud\"",
     ": /components/1: \"ud\" is not known, expected coh, dd, udf, uds, fs or rough"},
    {"EffectTwice", "\"uds\"", "\"dd\"", ": /components/1: \"dd\" is named twice, expected each effect once"},
    {"UnknownFresnel", "\"schlick\"", "\"shlick\"",
     ": /terms/fresnel: \"shlick\" is not known, expected schlick, exact or none"},
    {"UnknownTerm", "\"fresnel\"", "\"Fresnel\"",
     ": /terms/Fresnel: is not a known key, expected fresnel, shadowing, effective_roughness or distribution"},
    {"FormsOfWrongType", forms, "[]", ": /forms: is an array, expected an object"},
    {"SlopeOfWrongType", "0.0854", "\"0.0854\"", ": /surface/slope: is a string, expected a number or null"},
    {"SlopeOutOfRange", "0.0854", "-0.0854", ": /surface/slope: is -0.0854, expected a number in [1e-06, 10]"},
    {"SlopeMissing", "0.0854", "null", ": /surface/slope: is not given, expected a number: dd reads it"},
    {"SlopeDisagrees", "\"sigma_um\": null,\n    \"tau_um\": null", "\"sigma_um\": 0.7,\n    \"tau_um\": 7.0",
     ": /surface/slope: is 0.0854, expected sigma_um / tau_um = 0.09999999999999999 within 1e-6 of itself"},
    {"UnknownShadowing", "\"shadowing\": \"li-torrance\"", "\"shadowing\": \"Smith\"",
     ": /terms/shadowing: \"Smith\" is not known, expected li-torrance, smith, schlick or none"},
    {"UnknownRoughness", "\"effective_roughness\": \"li-torrance\"", "\"effective_roughness\": \"smith\"",
     ": /terms/effective_roughness: \"smith\" is not known, expected li-torrance, he or none"},
    {"UnknownDistribution", "rough-limit", "ggx",
     ": /terms/distribution: \"ggx\" is not known, expected rough-limit, he-torrance, he-torrance-series or student-t"},
    {"TailOfOne", "\"tail\": null", "\"tail\": 1", ": /surface/tail: is 1, expected a finite number above 1"},
    {"TauYAlone", "\"tau_y_um\": null", "\"tau_y_um\": 2",
     ": /surface/slope_y: is not given though tau_y_um is, expected both"},
    {"UnknownSurfaceKey", "\"tail\"", "\"gamma\"",
     ": /surface/gamma: is not a known key, expected slope, sigma_um, tau_um, slope_y, tau_y_um, tail or "
     "facet_slope_deg"},
    {"UnknownRoughForm", "functional", "exact",
     ": /forms/rough: \"exact\" is not known, expected functional, integral or qualitative"},
    {"UnknownAnisotropyForm", "consistent", "mean",
     ": /forms/anisotropy: \"mean\" is not known, expected consistent or printed"},
    {"ParametersOfTheSurface", "\"forms\"", "\"parameters\": {}, \"forms\"",
     ": /parameters: is not a known key, expected format, version, name, model, components, terms, surface, forms, "
     "channels, solid_angle_sr or fit"},
    {"RhoNegative", "\"rho\": 0.0", "\"rho\": -0.5",
     ": /channels/0/rho: is -0.5, expected a finite number of at least 0"},
    {"UnknownFsForm", "\"printed\"", "\"Printed\"",
     ": /forms/fs: \"Printed\" is not known, expected printed or reciprocal"},
    {"ChannelWithoutName", "\"name\": \"R\",", "", ": /channels/0/name: is missing"},
    {"UnknownChannelKey", "\"k_dd\": 0.59", "\"kdd\": 0.59",
     ": /channels/0/kdd: is not a known key, expected name, wavelength_um, n, kappa, f0, k_dd, k_udf, k_uds, k_fs or "
     "rho"},
    {"CoefficientNegative", "0.59", "-0.59", ": /channels/0/k_dd: is -0.59, expected a finite number of at least 0"},
    {"CoefficientBoolean", "0.59", "true", ": /channels/0/k_dd: is a boolean, expected a number or null"},
    {"NumberBeyondDouble", "0.59", "1e999", ": /channels/0/k_dd: is a number beyond 1.8e308, expected a smaller one"},
    {"KeyTwice", "\"k_udf\": 0.0", "\"k_dd\": 0.0", ": /channels/0/k_dd: is given twice, expected each key once"},
    {"SolidAngleNull", "0.0005", "null", ": /solid_angle_sr: is null, expected a number"},
    {"SamplesNegative", "\"samples\": 1", "\"samples\": -1",
     ": /fit/samples: is \"-1\", expected a whole number of at least 0"},
    {"ConvergedOfWrongType", "\"converged\": true", "\"converged\": 1",
     ": /fit/converged: is a number, expected true or false"},
    {"LossMissing", "\"loss\": 0.25,", "", ": /fit/loss: is missing"},
    {"UncertaintyOfNothing", "\"slope\": 0.001", "\"k_dd\": 0.001",
     ": /fit/uncertainty/k_dd: is not a shared parameter, expected slope, sigma_um, tau_um, slope_y, tau_y_um, tail or "
     "facet_slope_deg, or the object of a channel"},
    {"UncertaintyOfNoChannel", "\"R\": {", "\"G\": {", ": /fit/uncertainty/G: is not a channel of this material"},
    {"IdentifiableOfWrongType", "\"R.k_fs\": false", "\"R.k_fs\": null",
     ": /fit/identifiable/R.k_fs: is null, expected true or false"},
    {"Unfinished", "  \"name\": \"Garnet", "  \"name\" \"Garnet",
     ":4: column 31: syntax error while parsing object separator - unexpected string literal; expected ':'"},
    {"TrailingComma", "\"rho\": 0.0", "\"rho\": 0.0,",
     ":41: column 5: syntax error while parsing object key - unexpected '}'; expected string literal"},
    {"TooDeep", "0.0854", "[[[[[[[[0]]]]]]]]",
     ": /surface/slope/0/0/0/0/0/0: is nested too deeply, expected at most 8 levels"},
};

std::string case_name(const testing::TestParamInfo<BadMaterial>& tested) { return tested.param.name; }
INSTANTIATE_TEST_SUITE_P(MaterialIo, BadMaterials, testing::ValuesIn(bad_materials), case_name);

TEST(MaterialIo, DocumentsThatAreNoObject) {
  const auto complaint = [](const std::string& text) {
    return error_message([&] { (void)parse_material(text, "m.json"); });
  };
  EXPECT_EQ(complaint("[]"), "2 m.json: /: is an array, expected an object");
  EXPECT_EQ(complaint("null"), "2 m.json: /: is null, expected an object");
  EXPECT_EQ(complaint("").substr(0, 44), "2 m.json:1: column 1: syntax error while par");
  EXPECT_EQ(complaint("{\"name\": \"\xff\"}").substr(0, 23), "2 m.json:1: column 11: ");
}

// Each must end in an Error, soon: none may take the program down or run for long.
TEST(MaterialIo, HostileDocumentsEndInAnError) {
  std::string many_keys = "{";
  for (int i = 0; i < 100000; ++i) many_keys += "\"" + std::to_string(i) + "\":0,";
  for (const std::string& text :
       {std::string(1000000, '['), std::string(1000000, '{'), many_keys + "\"x\":0}", "\"" + std::string(1000000, 'a'),
        std::string(1000000, '9'), std::string(17 << 20, ' ')}) {
    const std::string message = error_message([&] { (void)parse_material(text, "m.json"); });
    EXPECT_EQ(message.substr(0, 9), "2 m.json:") << message.substr(0, 200);
    EXPECT_LT(message.size(), 600U);
  }
}

// Every cut of a good file is a bad one.
TEST(MaterialIo, TruncatedFilesAreRefused) {
  for (std::size_t length = 0; length + 2 < complete.size(); length += 7) {
    EXPECT_THROW((void)parse_material(std::string_view(complete).substr(0, length), "m.json"), Error) << length;
  }
}

}  // namespace
}  // namespace goniofit
