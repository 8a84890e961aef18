#include "io/recipe_io.h"

#include <algorithm>
#include <array>
#include <set>

#include "geometry/angles.h"
#include "io/line_reader.h"
#include "io/tier_names.h"
#include "io/toml_value.h"
#include "support/error.h"
#include "support/text.h"

namespace goniofit {

namespace {

constexpr std::size_t largest_file = std::size_t{1} << 20U;
constexpr std::int64_t most_trials = 1'000'000;

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

Terms read_terms(const TomlValue& value) {
  Terms terms;
  if (value.is_string()) {
    if (value.text() != "li-torrance") {
      throw unknown_name(value.source(), value.pointer(), value.text(), "\"li-torrance\" or a table of tiers");
    }
    return terms;
  }
  if (!value.is_table()) value.fail_type("\"li-torrance\" or a table of tiers");
  value.expect_keys({"fresnel", "shadowing", "effective_roughness", "distribution"});
  read_name(value, "fresnel", terms.fresnel);
  read_name(value, "shadowing", terms.shadowing);
  read_name(value, "effective_roughness", terms.effective_roughness);
  read_name(value, "distribution", terms.distribution);
  return terms;
}

void read_loss(const TomlValue& value) {
  constexpr std::array<std::string_view, 4> later{"inverse-variance", "relative", "log1p", "cube-root"};
  const std::string& name = value.text();
  if (name == "cosine-l2") return;
  const bool known = std::find(later.begin(), later.end(), name) != later.end();
  value.fail(in_quotes(name) + (known ? " is not available" : " is not known") + ", expected \"cosine-l2\"");
}

Weight read_weight(const TomlValue& value) {
  if (value.text() == "cosine") return Weight::cosine;
  if (value.text() == "none") return Weight::none;
  value.fail(in_quotes(value.text()) + " is not known, expected \"cosine\" or \"none\"");
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

struct Range {
  bool (*holds)(double);
  std::string_view expected;
};
constexpr Range positive{[](double x) { return x > 0.0; }, "a number above 0"};
constexpr Range not_negative{[](double x) { return x >= 0.0; }, "a number of at least 0"};
constexpr Range unit_interval{[](double x) { return x >= 0.0 && x <= 1.0; }, "a number in [0, 1]"};
constexpr Range slope_range{[](double x) { return x >= smallest_slope && x <= largest_slope; },
                            "a number in [1e-06, 10]"};
constexpr Range solid_angle_range{[](double x) { return x > 0.0 && x < 2.0 * pi; }, "a number above 0 and below 2 pi"};
constexpr Range theta_range{[](double x) { return x > 0.0 && x <= 90.0; }, "degrees above 0 and up to 90"};

double read_number(const TomlValue& value, const Range& range) {
  const double number = value.number(std::string(range.expected));
  value.require(range.holds(number), number, std::string(range.expected));
  return number;
}

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
  read_free_optics(optics, "n", positive, FreeOptics::n, recipe, settings.n);
  read_free_optics(optics, "f0", unit_interval, FreeOptics::f0, recipe, settings.f0);
  if (const auto kappa = optics.find("kappa"))
    settings.kappa = read_numbers(*kappa, not_negative, recipe.channels.size());
  const bool differ = settings.n.size() > 1 && settings.kappa.size() > 1 && settings.n.size() != settings.kappa.size();
  if (differ) {
    optics.find("kappa")->fail("has " + std::to_string(settings.kappa.size()) + " numbers where n has " +
                               std::to_string(settings.n.size()) + ", expected as many");
  }
  if (constants) recipe.optical_constants = beside(recipe, *constants, "the path of a table of n and kappa");
}

struct Parameter {
  std::string_view name;
  bool shared;
  Range range;
};
constexpr std::array parameters{Parameter{"slope", true, slope_range},   Parameter{"sigma_um", true, positive},
                                Parameter{"tau_um", true, positive},     Parameter{"k_dd", false, not_negative},
                                Parameter{"k_udf", false, not_negative}, Parameter{"k_uds", false, not_negative},
                                Parameter{"k_fs", false, not_negative},  Parameter{"n", false, positive},
                                Parameter{"f0", false, unit_interval}};

const Parameter* find_parameter(std::string_view name) {
  const auto* found =
      std::find_if(parameters.begin(), parameters.end(), [&](const Parameter& p) { return p.name == name; });
  return found == parameters.end() ? nullptr : found;
}

std::string parameter_names(bool with_shared) {
  std::vector<std::string_view> names;
  for (const Parameter& p : parameters) {
    if (with_shared || !p.shared) names.push_back(p.name);
  }
  return alternatives(names);
}

// A number fixes, {value = ...} too, {min = ..., max = ...} bound.
ParameterSetting read_setting(const TomlValue& value, const Range& range) {
  if (value.is_number()) return {read_number(value, range), std::nullopt, std::nullopt};
  if (!value.is_table()) value.fail_type("a number that fixes it, or {min = ..., max = ...}");
  value.expect_keys({"value", "min", "max"});
  ParameterSetting setting;
  if (const auto fixed = value.find("value")) setting.value = read_number(*fixed, range);
  if (const auto min = value.find("min")) setting.min = read_number(*min, range);
  if (const auto max = value.find("max")) setting.max = read_number(*max, range);
  if (setting.value && (setting.min || setting.max)) {
    value.fail("has a value and bounds, expected one or the other: value fixes, min and max bound");
  }
  if (!setting.value && !setting.min && !setting.max) value.fail("is empty, expected value, min or max");
  if (setting.min && setting.max && *setting.min >= *setting.max) {
    value.fail("has min = " + shortest(*setting.min) + " and max = " + shortest(*setting.max) +
               ", expected min below max (value fixes)");
  }
  return setting;
}

void read_channel_parameters(const TomlValue& table, const std::string& channel, Recipe& recipe) {
  const std::vector<std::string>& channels = recipe.channels;
  if (!channels.empty() && std::find(channels.begin(), channels.end(), channel) == channels.end()) {
    table.fail("is neither a parameter nor a channel, expected " + parameter_names(true) + ", or a channel (" +
               alternatives(channels) + ")");
  }
  table.for_each_member("a table", [&](const std::string& name, const TomlValue& value) {
    const Parameter* parameter = find_parameter(name);
    if (parameter == nullptr) value.fail("is not a parameter of a channel, expected " + parameter_names(false));
    if (parameter->shared) value.fail("is shared by all channels, expected it directly under [parameters]");
    recipe.settings.parameters[channel + "." + name] = read_setting(value, parameter->range);
  });
}

void read_parameters(const TomlValue& table, Recipe& recipe) {
  table.for_each_member("a table", [&](const std::string& name, const TomlValue& value) {
    if (const Parameter* parameter = find_parameter(name)) {
      recipe.settings.parameters[name] = read_setting(value, parameter->range);
    } else if (value.is_table()) {
      read_channel_parameters(value, name, recipe);
    } else {
      value.fail("is not a parameter, expected " + parameter_names(true) + ", or a channel's table");
    }
  });
}

Noise read_noise(const TomlValue& table) {
  table.expect_keys({"relative", "additive"});
  Noise noise{0.0, 0.0};
  if (const auto relative = table.find("relative")) noise.relative = read_number(*relative, not_negative);
  if (const auto additive = table.find("additive")) noise.additive = read_number(*additive, not_negative);
  return noise;
}

Sampling read_sampling(const TomlValue& value) {
  if (value.text() == "incidence-plane") return Sampling::incidence_plane;
  if (value.text() == "hemisphere") return Sampling::hemisphere;
  value.fail(in_quotes(value.text()) + " is not known, expected \"incidence-plane\" or \"hemisphere\"");
}

std::size_t read_trials(const TomlValue& value) {
  const std::string expected = "a whole number from 1 to " + std::to_string(most_trials);
  const std::int64_t trials = value.whole_number(expected);
  if (trials < 1 || trials > most_trials) value.fail("is " + std::to_string(trials) + ", expected " + expected);
  return static_cast<std::size_t>(trials);
}

std::pair<double, double> read_coverage(const TomlValue& array) {
  const std::string expected = "[smallest, largest]";
  std::vector<double> limits;
  array.for_each_element(expected, [&](const TomlValue& v) { limits.push_back(read_number(v, unit_interval)); });
  if (limits.size() != 2) array.fail("has " + std::to_string(limits.size()) + " numbers, expected " + expected);
  if (limits[0] >= limits[1]) array.fail("is crossed, expected " + expected);
  return {limits[0], limits[1]};
}

VerifySettings read_verify(const TomlValue& table, const Recipe& recipe) {
  table.expect_keys({"truth", "noise", "sampling", "trials", "bounds"});
  VerifySettings verify;
  const auto truth = table.find("truth");
  if (!truth)
    throw key_error(table.source(), table.pointer() + "/truth", "is missing, expected the path of a material");
  verify.truth = beside(recipe, *truth, "the path of a material");
  if (const auto noise = table.find("noise")) verify.noise = read_noise(*noise);
  if (const auto sampling = table.find("sampling")) verify.sampling = read_sampling(*sampling);
  if (const auto trials = table.find("trials")) verify.trials = read_trials(*trials);
  if (const auto bounds = table.find("bounds")) {
    bounds->expect_keys({"slope_bias", "coverage_95"});
    if (const auto bias = bounds->find("slope_bias")) verify.slope_bias = read_number(*bias, positive);
    if (const auto coverage = bounds->find("coverage_95")) verify.coverage_95 = read_coverage(*coverage);
  }
  return verify;
}

FsForm read_forms(const TomlValue& table) {
  table.expect_keys({"fs"});
  FsForm form = FsForm::printed;
  read_name(table, "fs", form);
  return form;
}

std::uint64_t read_seed(const TomlValue& value) {
  const std::string expected = "a whole number of at least 0";
  const std::int64_t seed = value.whole_number(expected);
  if (seed < 0) value.fail("is " + std::to_string(seed) + ", expected " + expected);
  return static_cast<std::uint64_t>(seed);
}

// Optics and parameters read what comes before them: the channels and the Fresnel tier.
Recipe read_document(const TomlValue& document) {
  document.expect_keys({"name", "scan", "components", "terms", "forms", "loss", "weight", "max_theta_deg",
                        "solid_angle_sr", "channels", "seed", "optics", "parameters", "verify"});
  Recipe recipe;
  recipe.source = document.source();
  FitSettings& settings = recipe.settings;
  if (const auto name = document.find("name")) recipe.name = name->text();
  if (const auto scan = document.find("scan")) read_scans(*scan, recipe);
  const auto components = document.find("components");
  const bool automatic = !components || (components->is_string() && components->text() == "auto");
  if (!automatic) settings.components = read_components(*components);
  if (const auto terms = document.find("terms")) settings.terms = read_terms(*terms);
  if (const auto forms = document.find("forms")) settings.fs_form = read_forms(*forms);
  if (const auto loss = document.find("loss")) read_loss(*loss);
  if (const auto weight = document.find("weight")) settings.weight = read_weight(*weight);
  if (const auto theta = document.find("max_theta_deg")) settings.max_theta_deg = read_number(*theta, theta_range);
  if (const auto angle = document.find("solid_angle_sr"))
    settings.solid_angle_sr = read_number(*angle, solid_angle_range);
  if (const auto channels = document.find("channels")) recipe.channels = read_channels(*channels);
  if (const auto seed = document.find("seed")) recipe.seed = read_seed(*seed);
  if (const auto optics = document.find("optics")) read_optics(*optics, recipe);
  if (const auto parameters_table = document.find("parameters")) read_parameters(*parameters_table, recipe);
  if (const auto verify = document.find("verify")) recipe.verify = read_verify(*verify, recipe);
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
