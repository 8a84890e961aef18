#include "io/material_io.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "support/error_message.h"
#include "support/materials.h"
#include "support/paths.h"

namespace goniofit {

namespace {

using test::error_message;

// Of which, as a fit without coh gives it, only the slope is known.
Material garnet_red_paint() {
  Material m = test::garnet_red_paint_13();
  m.surface = {m.surface.slope, std::nullopt, std::nullopt};
  return m;
}

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

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(MaterialIo, ReadsEveryKey) {
  const Material m = parse_material(complete, "m.json");
  EXPECT_EQ(m.name, "Garnet Red Paint #13");
  EXPECT_EQ(m.components, (EffectSet{Effect::dd, Effect::uds, Effect::fs}));
  EXPECT_EQ(m.terms, Terms{});
  EXPECT_EQ(m.surface, (Surface{0.0854, std::nullopt, std::nullopt}));
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
  EXPECT_EQ(m.fs_form, FsForm::reciprocal);
}

TEST(MaterialIo, FilesGoThroughTheSameText) {
  const test::ScratchDir folder;
  write_material(folder / "paint.json", garnet_red_paint());
  EXPECT_EQ(read_material(folder / "paint.json"), garnet_red_paint());
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
  Material m = garnet_red_paint();
  m.surface.slope = std::numeric_limits<double>::quiet_NaN();
  const test::ScratchDir folder;
  EXPECT_EQ(error_message([&] { write_material(folder / "m.json", m); }),
            "2 Garnet Red Paint #13: /surface/slope: is nan, expected a number in [1e-06, 10]");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(MaterialIo, NameThatIsNotUtf8IsStillWritten) {
  Material m = garnet_red_paint();
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
     ": /model: \"ward\" is not available, expected \"surface\""},
    {"NameOfWrongType", "\"Garnet Red Paint #13\"", "13", ": /name: is a number, expected a string"},
    {"UnknownKey", "\"solid_angle_sr\"", "\"solid_angle\"",
     ": /solid_angle: is not a known key, expected format, version, name, model, components, terms, surface, forms, "
     "channels, solid_angle_sr or fit"},
    {"NoComponents", components, "[]",
     ": /components: no effect is named, expected at least one of coh, dd, udf, uds or fs"},
    {"ComponentsOfWrongType", components, "\"dd\"", ": /components: is a string, expected an array"},
    {"UnknownEffect", "\"uds\"", "\"ud\"", ": /components/1: \"ud\" is not known, expected coh, dd, udf, uds or fs"},
    {"LaterEffect", "\"uds\"", "\"rough\"",
     ": /components/1: \"rough\" is not available, expected coh, dd, udf, uds or fs"},
    {"EffectTwice", "\"uds\"", "\"dd\"", ": /components/1: \"dd\" is named twice, expected each effect once"},
    {"LaterShadowing", "\"shadowing\": \"li-torrance\"", "\"shadowing\": \"smith\"",
     ": /terms/shadowing: \"smith\" is not available, expected li-torrance or none"},
    {"LaterRoughness", "\"effective_roughness\": \"li-torrance\"", "\"effective_roughness\": \"he\"",
     ": /terms/effective_roughness: \"he\" is not available, expected li-torrance or none"},
    {"LaterDistribution", "rough-limit", "student-t",
     ": /terms/distribution: \"student-t\" is not available, expected rough-limit"},
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
    {"Anisotropic", "\"slope_y\": null", "\"slope_y\": 0.1", ": /surface/slope_y: is not available, expected null"},
    {"Tail", "\"tail\": null", "\"tail\": 2", ": /surface/tail: is not available, expected null"},
    {"LaterRoughForm", "functional", "integral",
     ": /forms/rough: \"integral\" is not available, expected \"functional\""},
    {"UnknownFsForm", "\"printed\"", "\"Printed\"",
     ": /forms/fs: \"Printed\" is not known, expected printed or reciprocal"},
    {"ChannelWithoutName", "\"name\": \"R\",", "", ": /channels/0/name: is missing"},
    {"UnknownChannelKey", "\"k_dd\": 0.59", "\"kdd\": 0.59",
     ": /channels/0/kdd: is not a known key, expected name, wavelength_um, n, kappa, f0, k_dd, k_udf, k_uds, k_fs or "
     "rho"},
    {"CoefficientNegative", "0.59", "-0.59", ": /channels/0/k_dd: is -0.59, expected a finite number of at least 0"},
    {"CoefficientBoolean", "0.59", "true", ": /channels/0/k_dd: is a boolean, expected a number or null"},
    {"Rho", "\"rho\": 0.0", "\"rho\": 0.5", ": /channels/0/rho: is not available, expected 0 or null"},
    {"NumberBeyondDouble", "0.59", "1e999", ": /channels/0/k_dd: is a number beyond 1.8e308, expected a smaller one"},
    {"KeyTwice", "\"k_udf\": 0.0", "\"k_dd\": 0.0", ": /channels/0/k_dd: is given twice, expected each key once"},
    {"SolidAngleNull", "0.0005", "null", ": /solid_angle_sr: is null, expected a number"},
    {"SamplesNegative", "\"samples\": 1", "\"samples\": -1",
     ": /fit/samples: is \"-1\", expected a whole number of at least 0"},
    {"ConvergedOfWrongType", "\"converged\": true", "\"converged\": 1",
     ": /fit/converged: is a number, expected true or false"},
    {"LossMissing", "\"loss\": 0.25,", "", ": /fit/loss: is missing"},
    {"UncertaintyOfNothing", "\"slope\": 0.001", "\"k_dd\": 0.001",
     ": /fit/uncertainty/k_dd: is not a shared parameter, expected slope, sigma_um or tau_um, or the object of a "
     "channel"},
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

// ---- round trips

double any_number(double low, double high) {
  const auto bits = *rc::gen::arbitrary<std::uint32_t>();
  return low + (high - low) * (static_cast<double>(bits) / 4294967296.0);
}

std::optional<double> maybe(double low, double high) {
  if (*rc::gen::arbitrary<bool>()) return std::nullopt;
  return any_number(low, high);
}

MaterialChannel any_channel(const std::string& name, bool with_f0) {
  MaterialChannel channel;
  channel.name = name;
  channel.wavelength_um = any_number(0.3, 12.0);
  if (with_f0) {
    channel.f0 = any_number(0.0, 1.0);
  } else {
    channel.n = any_number(0.01, 5.0);
    channel.kappa = maybe(0.0, 10.0);
  }
  for (const Coefficient c : all_coefficients) channel.coefficient(c) = maybe(0.0, 3.0);
  return channel;
}

FitSummary any_fit(const std::vector<MaterialChannel>& channels) {
  FitSummary fit;
  fit.loss = any_number(0.0, 1e9);
  fit.rms = any_number(0.0, 1e-9);
  fit.samples = *rc::gen::arbitrary<std::uint32_t>();
  fit.converged = *rc::gen::arbitrary<bool>();
  fit.shared_uncertainty["slope"] = any_number(0.0, 1e-3);
  fit.identifiable["sigma_um"] = *rc::gen::arbitrary<bool>();
  for (const MaterialChannel& channel : channels) {
    fit.channel_uncertainty[channel.name]["k_dd"] = any_number(0.0, 1.0);
    fit.identifiable[channel.name + ".k_dd"] = *rc::gen::arbitrary<bool>();
  }
  return fit;
}

Material any_material() {
  Material m;
  m.name = *rc::gen::string<std::string>();
  for (char& c : m.name) c = static_cast<char>(c & 0x7f);  // any ASCII, controls and quotes included
  m.components.insert(*rc::gen::element(Effect::coh, Effect::dd, Effect::udf, Effect::uds, Effect::fs));
  m.components.insert(*rc::gen::element(Effect::coh, Effect::dd, Effect::udf, Effect::uds, Effect::fs));
  m.terms.fresnel = *rc::gen::element(FresnelTier::schlick, FresnelTier::exact, FresnelTier::none);
  m.terms.shadowing = *rc::gen::element(ShadowingTier::li_torrance, ShadowingTier::none);
  m.terms.effective_roughness = *rc::gen::element(EffectiveRoughnessTier::li_torrance, EffectiveRoughnessTier::none);
  m.fs_form = *rc::gen::element(FsForm::printed, FsForm::reciprocal);
  m.surface.sigma_um = any_number(0.01, 2.0);
  m.surface.tau_um = maybe(1.0, 30.0);
  m.surface.slope = m.surface.tau_um ? *m.surface.sigma_um / *m.surface.tau_um : any_number(1e-4, 1.0);
  m.solid_angle_sr = any_number(1e-6, 1e-2);
  const bool with_f0 = m.terms.fresnel != FresnelTier::exact && *rc::gen::arbitrary<bool>();
  const int channels = *rc::gen::inRange(1, 5);
  for (int i = 0; i < channels; ++i) m.channels.push_back(any_channel("c/" + std::to_string(i) + ".~\"", with_f0));
  if (*rc::gen::arbitrary<bool>()) m.fit = any_fit(m.channels);
  return m;
}

RC_GTEST_PROP(MaterialIo, RoundTripIsExact, ()) {
  const Material m = any_material();
  const std::string text = to_json(m);
  const Material back = parse_material(text, "m.json");
  RC_ASSERT(back == m);
  RC_ASSERT(to_json(back) == text);
}

// ---- the CSV table

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> out{""};
  bool inside = false;
  for (const char c : line) {
    if (c == '"')
      inside = !inside;
    else if (c == ',' && !inside)
      out.emplace_back();
    else
      out.back() += c;
  }
  return out;
}

TEST(MaterialTable, OneRowAChannel) {
  Material m = garnet_red_paint();
  m.name = "red, \"garnet\"";
  m.fit.emplace();
  m.fit->loss = 0.125;
  m.fit->samples = 42;
  m.fit->shared_uncertainty["slope"] = 0.001;
  m.fit->channel_uncertainty["G"]["k_fs"] = 0.17;
  std::istringstream table(to_csv({m, parse_material(complete, "m.json")}));
  std::vector<std::map<std::string, std::string>> rows;
  std::string line;
  ASSERT_TRUE(std::getline(table, line));
  const std::vector<std::string> header = cells(line);
  while (std::getline(table, line)) {
    const std::vector<std::string> row = cells(line);
    ASSERT_EQ(row.size(), header.size()) << line;
    auto& by_name = rows.emplace_back();
    for (std::size_t i = 0; i < row.size(); ++i) by_name[header[i]] = row[i];
  }
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows[1]["name"], "red, garnet");  // the reader above drops the doubled quotes
  EXPECT_EQ(rows[1]["channel"], "G");
  EXPECT_EQ(rows[1]["components"], "dd uds fs");
  EXPECT_EQ(rows[1]["terms"],
            "fresnel=schlick shadowing=li-torrance effective_roughness=li-torrance distribution=rough-limit");
  EXPECT_EQ(rows[1]["k_dd"], "0.72");
  EXPECT_EQ(rows[1]["u_k_dd"], "");
  EXPECT_EQ(rows[1]["u_k_fs"], "0.17");
  EXPECT_EQ(rows[0]["u_k_fs"], "");
  EXPECT_EQ(rows[0]["u_slope"], "0.001");
  EXPECT_EQ(rows[0]["sigma_um"], "");
  EXPECT_EQ(rows[0]["f0"], "");
  EXPECT_EQ(rows[0]["samples"], "42");
  EXPECT_EQ(rows[0]["loss"], "0.125");
  EXPECT_EQ(rows[0]["converged"], "false");
  EXPECT_EQ(rows[3]["n"], "1.7");
  EXPECT_EQ(rows[3]["converged"], "true");
}

TEST(MaterialTable, QuotesAsRfc4180) {
  Material m = garnet_red_paint();
  m.name = "a\"b,c";
  const std::string table = to_csv({m});
  EXPECT_NE(table.find("\n\"a\"\"b,c\",R,0.65,1.7,,0,"), std::string::npos) << table;
}

TEST(MaterialTable, HandWrittenMaterialHasEmptyCells) {
  std::istringstream table(to_csv({garnet_red_paint()}));
  std::string header;
  std::string row;
  std::getline(table, header);
  std::getline(table, row);
  EXPECT_EQ(cells(header).size(), cells(row).size());
  EXPECT_TRUE(row.ends_with(",5e-04,,,,")) << row;
}

}  // namespace
}  // namespace goniofit
