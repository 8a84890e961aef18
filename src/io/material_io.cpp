#include "io/material_io.h"

#include <array>
#include <utility>

#include "io/json_value.h"
#include "io/line_reader.h"
#include "io/tier_names.h"
#include "support/error.h"
#include "support/output_file.h"
#include "support/text.h"

namespace goniofit {

namespace {

constexpr std::size_t largest_file = std::size_t{16} << 20U;
constexpr int deepest_nesting = 8;
constexpr std::string_view format_name = "goniofit-material";
constexpr std::size_t format_version = 1;

// A key of the format whose model this version does not have: it may be there, without a value.
void expect_no_value(const JsonValue& object, std::string_view key) {
  const std::optional<JsonValue> value = object.find(key);
  if (value && !value->is_null()) value->fail("is not available, expected null");
}

void read_header(const JsonValue& document) {
  document.expect_keys({"format", "version", "name", "model", "components", "terms", "surface", "forms", "channels",
                        "solid_angle_sr", "fit"});
  const JsonValue format = document.at("format");
  if (format.text() != format_name)
    format.fail("is " + in_quotes(format.text()) + ", expected " + in_quotes(format_name));
  const JsonValue version = document.at("version");
  if (version.count() != format_version) {
    version.fail("is " + std::to_string(version.count()) + ", expected " + std::to_string(format_version));
  }
  if (const auto model = document.find("model"); model && model->text() != "surface") {
    model->fail(in_quotes(model->text()) + " is not available, expected \"surface\"");
  }
}

EffectSet read_components(const JsonValue& array) {
  EffectSet components;
  array.for_each_element([&](const JsonValue& element) {
    const auto effect = require_name<Effect>(element.source(), element.pointer(), element.text());
    if (components.has(effect)) element.fail(in_quotes(element.text()) + " is named twice, expected each effect once");
    components.insert(effect);
  });
  return components;
}

template <class E>
void read_name(const JsonValue& object, std::string_view key, E& value) {
  if (const auto member = object.find(key)) {
    value = require_name<E>(member->source(), member->pointer(), member->text());
  }
}

Terms read_terms(const JsonValue& object) {
  object.expect_keys({"fresnel", "shadowing", "effective_roughness", "distribution"});
  Terms terms;
  read_name(object, "fresnel", terms.fresnel);
  read_name(object, "shadowing", terms.shadowing);
  read_name(object, "effective_roughness", terms.effective_roughness);
  read_name(object, "distribution", terms.distribution);
  return terms;
}

std::optional<double> read_number(const JsonValue& object, std::string_view key) {
  const std::optional<JsonValue> member = object.find(key);
  return member ? member->number_or_null() : std::nullopt;
}

Surface read_surface(const JsonValue& object) {
  object.expect_keys({"slope", "sigma_um", "tau_um", "slope_y", "tau_y_um", "tail", "facet_slope_deg"});
  for (const std::string_view key : {"slope_y", "tau_y_um", "tail", "facet_slope_deg"}) expect_no_value(object, key);
  Surface surface{read_number(object, "slope"), read_number(object, "sigma_um"), read_number(object, "tau_um")};
  const bool both = surface.sigma_um.value_or(0.0) > 0.0 && surface.tau_um.value_or(0.0) > 0.0;
  if (!surface.slope && both) surface.slope = *surface.sigma_um / *surface.tau_um;
  return surface;
}

FsForm read_forms(const JsonValue& object) {
  object.expect_keys({"fs", "rough", "anisotropy"});
  FsForm form = FsForm::printed;
  read_name(object, "fs", form);
  // Forms of effects that are not there: only what the writer puts is accepted, so that nothing is lost unnoticed.
  for (const auto& [key, only] : {std::pair{"rough", "functional"}, std::pair{"anisotropy", "consistent"}}) {
    const std::optional<JsonValue> member = object.find(key);
    if (member && member->text() != only) {
      member->fail(in_quotes(member->text()) + " is not available, expected " + in_quotes(only));
    }
  }
  return form;
}

MaterialChannel read_channel(const JsonValue& object) {
  object.expect_keys({"name", "wavelength_um", "n", "kappa", "f0", "k_dd", "k_udf", "k_uds", "k_fs", "rho"});
  MaterialChannel channel;
  channel.name = object.at("name").text();
  channel.wavelength_um = read_number(object, "wavelength_um");
  channel.n = read_number(object, "n");
  channel.kappa = read_number(object, "kappa");
  channel.f0 = read_number(object, "f0");
  for (const Coefficient c : all_coefficients) channel.coefficient(c) = read_number(object, name_of(c));
  if (read_number(object, "rho").value_or(0.0) != 0.0) object.at("rho").fail("is not available, expected 0 or null");
  return channel;
}

// {"slope": 0.001, "R": {"k_dd": 0.01}}
void read_uncertainty(const JsonValue& object, FitSummary& fit) {
  object.for_each_member([&](const std::string& key, const JsonValue& member) {
    if (!member.is_object()) {
      fit.shared_uncertainty[key] = member.number();
      return;
    }
    auto& by_parameter = fit.channel_uncertainty[key];
    member.for_each_member([&](const std::string& name, const JsonValue& u) { by_parameter[name] = u.number(); });
  });
}

FitSummary read_fit(const JsonValue& object) {
  object.expect_keys({"loss", "rms", "samples", "converged", "uncertainty", "identifiable"});
  FitSummary fit;
  fit.loss = object.at("loss").number();
  fit.rms = object.at("rms").number();
  fit.samples = object.at("samples").count();
  fit.converged = object.at("converged").boolean();
  if (const auto uncertainty = object.find("uncertainty")) read_uncertainty(*uncertainty, fit);
  if (const auto identifiable = object.find("identifiable")) {
    identifiable->for_each_member(
        [&](const std::string& name, const JsonValue& value) { fit.identifiable[name] = value.boolean(); });
  }
  return fit;
}

Material read_document(const JsonValue& document) {
  read_header(document);
  Material material;
  if (const auto name = document.find("name")) material.name = name->text();
  material.components = read_components(document.at("components"));
  if (const auto terms = document.find("terms")) material.terms = read_terms(*terms);
  if (const auto surface = document.find("surface")) material.surface = read_surface(*surface);
  if (const auto forms = document.find("forms")) material.fs_form = read_forms(*forms);
  document.at("channels").for_each_element([&](const JsonValue& c) { material.channels.push_back(read_channel(c)); });
  if (const auto angle = document.find("solid_angle_sr")) material.solid_angle_sr = angle->number();
  if (const auto fit = document.find("fit")) material.fit = read_fit(*fit);
  validate(material, document.source());
  return material;
}

using Ordered = nlohmann::ordered_json;

Ordered number_or_null(const std::optional<double>& value) { return value ? Ordered(*value) : Ordered(nullptr); }

Ordered components_json(EffectSet components) {
  Ordered out = Ordered::array();
  for (const Effect e : all_effects) {
    if (components.has(e)) out.push_back(name_of(e));
  }
  return out;
}

Ordered channel_json(const MaterialChannel& channel) {
  Ordered out{{"name", channel.name}, {"wavelength_um", number_or_null(channel.wavelength_um)}};
  if (channel.f0) {
    out["f0"] = *channel.f0;
  } else {
    out["n"] = number_or_null(channel.n);
    out["kappa"] = number_or_null(channel.kappa);
  }
  for (const Coefficient c : all_coefficients) out[std::string(name_of(c))] = number_or_null(channel.coefficient(c));
  out["rho"] = 0.0;
  return out;
}

Ordered fit_json(const FitSummary& fit, const std::vector<MaterialChannel>& channels) {
  Ordered uncertainty = Ordered::object();
  for (const auto& [parameter, u] : fit.shared_uncertainty) uncertainty[parameter] = u;
  for (const MaterialChannel& channel : channels) {
    const auto by_parameter = fit.channel_uncertainty.find(channel.name);
    if (by_parameter != fit.channel_uncertainty.end()) uncertainty[channel.name] = by_parameter->second;
  }
  return {{"loss", fit.loss},
          {"rms", fit.rms},
          {"samples", fit.samples},
          {"converged", fit.converged},
          {"uncertainty", std::move(uncertainty)},
          {"identifiable", fit.identifiable}};
}

}  // namespace

Material parse_material(std::string_view json, const std::string& source) {
  if (json.size() > largest_file) throw input_error(source, 0, "", "is too large for a material");
  const nlohmann::json document = parse_json(json, source, deepest_nesting);
  return read_document({document, source});
}

Material read_material(const std::filesystem::path& path) {
  std::ifstream in = open_input(path);
  return parse_material(read_whole(in, path.string(), largest_file), path.string());
}

std::string to_json(const Material& material) {
  validate(material, material.name);
  const Surface& s = material.surface;
  Ordered out{{"format", format_name},
              {"version", format_version},
              {"name", material.name},
              {"components", components_json(material.components)},
              {"terms",
               {{"fresnel", name_of(material.terms.fresnel)},
                {"shadowing", name_of(material.terms.shadowing)},
                {"effective_roughness", name_of(material.terms.effective_roughness)},
                {"distribution", name_of(material.terms.distribution)}}},
              {"surface",
               {{"slope", number_or_null(s.slope)},
                {"sigma_um", number_or_null(s.sigma_um)},
                {"tau_um", number_or_null(s.tau_um)},
                {"slope_y", nullptr},
                {"tau_y_um", nullptr},
                {"tail", nullptr},
                {"facet_slope_deg", nullptr}}},
              {"forms", {{"fs", name_of(material.fs_form)}, {"rough", "functional"}, {"anisotropy", "consistent"}}},
              {"channels", Ordered::array()},
              {"solid_angle_sr", material.solid_angle_sr}};
  for (const MaterialChannel& channel : material.channels) out["channels"].push_back(channel_json(channel));
  if (material.fit) out["fit"] = fit_json(*material.fit, material.channels);
  // A name from a Latin-1 scan is not UTF-8: a replaced character is better than no output.
  return out.dump(2, ' ', false, Ordered::error_handler_t::replace) + '\n';
}

void write_material(const std::filesystem::path& path, const Material& material) {
  write_file(path, to_json(material));
}

}  // namespace goniofit
