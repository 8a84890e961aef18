#include "io/recipe_io.h"

#include <algorithm>
#include <array>
#include <memory>

#include "brdf/named_terms.h"
#include "fit/loss.h"
#include "geometry/angles.h"
#include "io/line_reader.h"
#include "io/recipe_parameters.h"
#include "io/recipe_verify.h"
#include "io/tier_names.h"
#include "io/toml_value.h"
#include "support/error.h"
#include "support/text.h"

namespace goniofit {

namespace {

constexpr std::size_t largest_file = std::size_t{1} << 20U;

std::filesystem::path beside(const Recipe& recipe, const TomlValue& value, const std::string& expected) {
  const std::string& text = value.text(expected);
  if (text.empty()) value.fail("is empty, expected " + expected);
  return (recipe.source.parent_path() / text).lexically_normal();
}

void read_scans(const TomlValue& value, Recipe& recipe) {
  if (value.is_string()) {
    recipe.scans.push_back(beside(recipe, value, "a path"));
    return;
  }
  value.for_each_element("a path or an array of paths",
                         [&](const TomlValue& element) { recipe.scans.push_back(beside(recipe, element, "a path")); });
  if (recipe.scans.empty()) value.fail("is empty, expected at least one path");
}

EffectSet read_components(const TomlValue& array) {
  const std::string expected = "\"auto\" or an array of " + names_of<Effect>();
  EffectSet components;
  array.for_each_element(expected, [&](const TomlValue& element) {
    const auto effect = require_name<Effect>(element.source(), element.pointer(), element.text());
    if (components.has(effect)) element.fail(in_quotes(element.text()) + " is named twice, expected each effect once");
    components.insert(effect);
  });
  if (components.empty()) array.fail("is empty, expected " + expected);
  return components;
}

template <class E>
void read_name(const TomlValue& table, std::string_view key, E& value) {
  if (const auto member = table.find(key)) {
    value = require_name<E>(member->source(), member->pointer(), member->text());
  }
}

// A named set, or a table of tiers. A peer reads Fresnel's alone.
Terms read_terms(const TomlValue& value, const Basis* peer) {
  constexpr std::string_view expected = "\"li-torrance\", \"he-torrance\" or a table of tiers";
  if (value.is_string() && peer == nullptr) {
    const std::optional<Terms> terms = named_terms(value.text());
    if (!terms) throw unknown_name(value.source(), value.pointer(), value.text(), std::string(expected));
    return *terms;
  }
  Terms terms;
  if (peer != nullptr) {
    if (!value.is_table()) value.fail_type("a table of the tier fresnel, which alone this model reads");
    value.expect_keys({"fresnel"});
    read_name(value, "fresnel", terms.fresnel);
    return terms;
  }
  if (!value.is_table()) value.fail_type(std::string(expected));
  value.expect_keys({"fresnel", "shadowing", "effective_roughness", "distribution"});
  read_name(value, "fresnel", terms.fresnel);
  read_name(value, "shadowing", terms.shadowing);
  read_name(value, "effective_roughness", terms.effective_roughness);
  read_name(value, "distribution", terms.distribution);
  return terms;
}

// loss = "log1p"; robust = "huber" or {kernel = "huber", scale = 0.02}.
void read_loss(const TomlValue& document, FitSettings& settings) {
  read_name(document, "loss", settings.loss);
  read_name(document, "weight", settings.weight);
  const auto robust = document.find("robust");
  if (!robust) return;
  if (robust->is_string()) return read_name(document, "robust", settings.robust);
  if (!robust->is_table()) robust->fail_type(names_of<RobustKernel>() + ", or a table of kernel and scale");
  robust->expect_keys({"kernel", "scale"});
  read_name(*robust, "kernel", settings.robust);
  if (const auto scale = robust->find("scale")) settings.robust_scale = read_number(*scale, Range::above(0.0));
}

// exclude = {retro_deg = 7.0, saturated = true, clamped = true}; saturated may be the value from which on.
void read_exclusions(const TomlValue& table, ExclusionSettings& exclude) {
  table.expect_keys({"retro_deg", "saturated", "clamped"});
  if (const auto retro = table.find("retro_deg")) {
    exclude.retro_cone_deg = read_number(*retro, Range::closed(0.0, 180.0));
  }
  if (const auto saturated = table.find("saturated")) {
    if (saturated->is_number()) {
      exclude.saturated_from = read_number(*saturated, Range::above(0.0));
    } else {
      exclude.saturated = saturated->boolean();
    }
  }
  if (const auto clamped = table.find("clamped")) exclude.clamped = clamped->boolean();
}

void read_uncertainty_source(const TomlValue& value, FitSettings& settings) {
  if (parse_uncertainty(value.text(), settings.uncertainty)) return;
  value.fail(in_quotes(value.text()) + " is not known, expected " + std::string(uncertainty_words));
}

std::vector<std::string> read_channels(const TomlValue& array) {
  std::vector<std::string> names;
  array.for_each_element("an array of channel names", [&](const TomlValue& element) {
    const std::string& name = element.text("a channel's name");
    if (name.empty()) element.fail("is empty, expected a channel's name");
    if (std::find(names.begin(), names.end(), name) != names.end()) {
      element.fail(in_quotes(name) + " is named twice, expected each channel once");
    }
    names.push_back(name);
  });
  if (names.empty()) array.fail("is empty, expected at least one channel's name");
  return names;
}

Range positive() { return Range::above(0.0); }
Range not_negative() { return Range::at_least(0.0); }
Range unit_interval() { return Range::closed(0.0, 1.0); }
Range solid_angle_range() { return {0.0, 2.0 * pi, false, false, "a number above 0 and below 2 pi"}; }
Range theta_range() { return {0.0, 90.0, false, true, "degrees above 0 and up to 90"}; }

// One value, or one a channel.
std::vector<double> read_numbers(const TomlValue& value, const Range& range, std::size_t channels) {
  if (!value.is_array()) return {read_number(value, range)};
  std::vector<double> numbers;
  value.for_each_element("a number or an array of numbers",
                         [&](const TomlValue& element) { numbers.push_back(read_number(element, range)); });
  if (numbers.empty()) value.fail("is empty, expected one number, or one a channel");
  if (numbers.size() > 1 && channels > 0 && numbers.size() != channels) {
    value.fail("has " + std::to_string(numbers.size()) + " numbers for " + std::to_string(channels) +
               " channels, expected one, or one a channel");
  }
  return numbers;
}

// A number, an array, or "free".
void read_free_optics(const TomlValue& optics, std::string_view key, const Range& range, FreeOptics what,
                      Recipe& recipe, std::vector<double>& numbers) {
  const std::optional<TomlValue> value = optics.find(key);
  if (!value) return;
  if (!value->is_string()) {
    if (!value->is_number() && !value->is_array()) value->fail_type("a number, one a channel, or \"free\"");
    numbers = read_numbers(*value, range, recipe.channels.size());
    return;
  }
  if (value->text() != "free") value->fail(in_quotes(value->text()) + " is not known, expected a number or \"free\"");
  recipe.settings.free_optics = what;
}

void read_optics(const TomlValue& optics, Recipe& recipe) {
  optics.expect_keys({"n", "kappa", "f0", "optical_constants"});
  FitSettings& settings = recipe.settings;
  const auto f0 = optics.find("f0");
  const auto constants = optics.find("optical_constants");
  for (const std::string_view key : {"n", "kappa"}) {
    const auto beside_it = optics.find(key);
    if (beside_it && constants) beside_it->fail("stands beside optical_constants, expected one of the two");
    if (beside_it && f0) beside_it->fail("stands beside f0, expected f0 or n and kappa");
  }
  if (f0 && constants) f0->fail("stands beside optical_constants, expected one of the two");
  if (f0 && settings.terms.fresnel == FresnelTier::exact)
    f0->fail("does not serve fresnel exact, expected n and kappa");
  read_free_optics(optics, "n", positive(), FreeOptics::n, recipe, settings.n);
  read_free_optics(optics, "f0", unit_interval(), FreeOptics::f0, recipe, settings.f0);
  if (const auto kappa = optics.find("kappa"))
    settings.kappa = read_numbers(*kappa, not_negative(), recipe.channels.size());
  const bool differ = settings.n.size() > 1 && settings.kappa.size() > 1 && settings.n.size() != settings.kappa.size();
  if (differ) {
    optics.find("kappa")->fail("has " + std::to_string(settings.kappa.size()) + " numbers where n has " +
                               std::to_string(settings.n.size()) + ", expected as many");
  }
  if (constants) recipe.optical_constants = beside(recipe, *constants, "the path of a table of n and kappa");
}

Forms read_forms(const TomlValue& table) {
  table.expect_keys({"fs", "rough", "anisotropy"});
  Forms forms;
  read_name(table, "fs", forms.fs);
  read_name(table, "rough", forms.rough);
  read_name(table, "anisotropy", forms.anisotropy);
  return forms;
}

std::uint64_t read_seed(const TomlValue& value) {
  const std::string expected = "a whole number of at least 0";
  const std::int64_t seed = value.whole_number(expected);
  if (seed < 0) value.fail("is " + std::to_string(seed) + ", expected " + expected);
  return static_cast<std::uint64_t>(seed);
}

// What a fit fits. Of these a peer has the terms alone, and of the terms Fresnel's.
void read_model(const TomlValue& document, const Basis* peer, FitSettings& settings) {
  const auto components = document.find("components");
  const auto anisotropic = document.find("anisotropic");
  const bool automatic = !components || (components->is_string() && components->text() == "auto");
  if (peer != nullptr) {
    const std::string model = "though the model is " + settings.model;
    if (!automatic) components->fail("is given " + model + ", which has no effects");
    if (const auto forms = document.find("forms")) forms->fail("is given " + model + ", which has no forms");
    if (anisotropic) anisotropic->fail("is given " + model + ", expected a model that is anisotropic");
  }
  if (!automatic) settings.components = read_components(*components);
  if (const auto terms = document.find("terms")) settings.terms = read_terms(*terms, peer);
  if (const auto forms = document.find("forms")) settings.forms = read_forms(*forms);
  if (anisotropic) settings.anisotropic = anisotropic->boolean();
}

// Optics and parameters read what comes before them: the model, the channels and the Fresnel tier.
Recipe read_document(const TomlValue& document) {
  document.expect_keys({"name",          "scan",           "model",    "components", "terms",       "forms",
                        "anisotropic",   "loss",           "weight",   "robust",     "exclude",     "reflectances",
                        "max_theta_deg", "solid_angle_sr", "channels", "seed",       "uncertainty", "scale_u",
                        "optics",        "parameters",     "verify"});
  Recipe recipe;
  recipe.source = document.source();
  FitSettings& settings = recipe.settings;
  if (const auto name = document.find("name")) recipe.name = name->text();
  if (const auto scan = document.find("scan")) read_scans(*scan, recipe);
  if (const auto model = document.find("model")) settings.model = model->text();
  const std::unique_ptr<const Basis> peer = require_model(document.source(), "/model", settings.model);
  read_model(document, peer.get(), settings);
  read_loss(document, settings);
  if (const auto exclude = document.find("exclude")) read_exclusions(*exclude, settings.exclusions);
  if (const auto file = document.find("reflectances")) recipe.reflectances = beside(recipe, *file, "a path");
  if (const auto from = document.find("uncertainty")) read_uncertainty_source(*from, settings);
  if (const auto u = document.find("scale_u")) settings.scale_u = read_number(*u, unit_interval());
  if (const auto theta = document.find("max_theta_deg")) settings.max_theta_deg = read_number(*theta, theta_range());
  if (const auto angle = document.find("solid_angle_sr"))
    settings.solid_angle_sr = read_number(*angle, solid_angle_range());
  if (const auto channels = document.find("channels")) recipe.channels = read_channels(*channels);
  if (const auto seed = document.find("seed")) recipe.seed = read_seed(*seed);
  if (const auto optics = document.find("optics")) read_optics(*optics, recipe);
  if (const auto parameters = document.find("parameters")) read_parameters(*parameters, peer.get(), recipe);
  if (const auto verify = document.find("verify")) recipe.verify = read_verify(*verify, recipe.source);
  return recipe;
}

}  // namespace

Recipe parse_recipe(std::string_view toml, const std::string& source) {
  if (toml.size() > largest_file) throw input_error(source, 0, "", "is too large for a recipe");
  const toml::table document = parse_toml(toml, source);
  return read_document({document, source});
}

Recipe read_recipe(const std::filesystem::path& path) {
  std::ifstream in = open_input(path);
  return parse_recipe(read_whole(in, path.string(), largest_file), path.string());
}

}  // namespace goniofit
