#include "io/material_io.h"

#include <memory>
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

// Of a channel, in the order of files: of a peer, or of the surface family where there is none.
std::vector<std::string> coefficient_names(const Basis* peer) {
  std::vector<std::string> names;
  if (peer == nullptr) {
    for (const Coefficient c : all_coefficients) names.emplace_back(name_of(c));
    return names;
  }
  for (const BasisCoefficient& c : peer->coefficients()) {
    if (!c.constant()) names.push_back(c.name);
  }
  return names;
}

void read_format(const JsonValue& document) {
  const JsonValue format = document.at("format");
  if (format.text() != format_name)
    format.fail("is " + in_quotes(format.text()) + ", expected " + in_quotes(format_name));
  const JsonValue version = document.at("version");
  if (version.count() != format_version) {
    version.fail("is " + std::to_string(version.count()) + ", expected " + std::to_string(format_version));
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
  object.expect_keys({surface_parameter_names.begin(), surface_parameter_names.end()});
  Surface surface;
  for (const std::string_view name : surface_parameter_names) *surface.find(name) = read_number(object, name);
  const auto derive = [&](std::optional<double>& slope, const std::optional<double>& tau) {
    const bool both = surface.sigma_um.value_or(0.0) > 0.0 && tau.value_or(0.0) > 0.0;
    if (!slope && both) slope = *surface.sigma_um / *tau;
  };
  derive(surface.slope, surface.tau_um);
  derive(surface.slope_y, surface.tau_y_um);
  return surface;
}

Forms read_forms(const JsonValue& object) {
  object.expect_keys({"fs", "rough", "anisotropy"});
  Forms forms;
  read_name(object, "fs", forms.fs);
  read_name(object, "rough", forms.rough);
  read_name(object, "anisotropy", forms.anisotropy);
  return forms;
}

// `coefficients` are those of the model.
MaterialChannel read_channel(const JsonValue& object, const std::vector<std::string>& coefficients) {
  std::vector<std::string_view> keys{"name", "wavelength_um", "n", "kappa", "f0"};
  keys.insert(keys.end(), coefficients.begin(), coefficients.end());
  object.expect_keys(keys);
  MaterialChannel channel;
  channel.name = object.at("name").text();
  channel.wavelength_um = read_number(object, "wavelength_um");
  channel.n = read_number(object, "n");
  channel.kappa = read_number(object, "kappa");
  channel.f0 = read_number(object, "f0");
  for (const std::string& name : coefficients) {
    if (const auto value = object.find(name)) channel.set_coefficient(name, value->number_or_null());
  }
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

Interval read_interval(const JsonValue& value) {
  std::vector<double> limits;
  value.for_each_element([&](const JsonValue& limit) { limits.push_back(limit.number()); });
  if (limits.size() != 2 || limits[0] > limits[1]) value.fail("is no interval, expected [lower, upper]");
  return {limits[0], limits[1]};
}

FitSummary read_fit(const JsonValue& object) {
  object.expect_keys(
      {"loss", "rms", "samples", "converged", "uncertainty", "identifiable", "uncertainty_from", "interval_95"});
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
  if (const auto from = object.find("uncertainty_from")) fit.uncertainty_from = from->text();
  if (const auto intervals = object.find("interval_95")) {
    intervals->for_each_member(
        [&](const std::string& name, const JsonValue& value) { fit.interval_95[name] = read_interval(value); });
  }
  return fit;
}

void read_surface_model(const JsonValue& document, Material& material) {
  document.expect_keys({"format", "version", "name", "model", "components", "terms", "surface", "forms", "channels",
                        "solid_angle_sr", "fit"});
  material.components = read_components(document.at("components"));
  if (const auto terms = document.find("terms")) material.terms = read_terms(*terms);
  if (const auto surface = document.find("surface")) material.surface = read_surface(*surface);
  if (const auto forms = document.find("forms")) material.forms = read_forms(*forms);
}

// A peer has no effects, and of the terms Fresnel's alone.
void read_peer(const JsonValue& document, Material& material) {
  document.expect_keys(
      {"format", "version", "name", "model", "components", "terms", "parameters", "channels", "solid_angle_sr", "fit"});
  if (const auto components = document.find("components")) material.components = read_components(*components);
  if (const auto terms = document.find("terms")) {
    terms->expect_keys({"fresnel"});
    read_name(*terms, "fresnel", material.terms.fresnel);
  }
  if (const auto parameters = document.find("parameters")) {
    parameters->for_each_member(
        [&](const std::string& name, const JsonValue& value) { material.parameters[name] = value.number_or_null(); });
  }
}

Material read_document(const JsonValue& document) {
  read_format(document);
  Material material;
  if (const auto model = document.find("model")) material.model = model->text();
  const std::unique_ptr<const Basis> peer = require_model(document.source(), "/model", material.model);
  if (peer) {
    read_peer(document, material);
  } else {
    read_surface_model(document, material);
  }
  if (const auto name = document.find("name")) material.name = name->text();
  const std::vector<std::string> coefficients = coefficient_names(peer.get());
  document.at("channels").for_each_element([&](const JsonValue& c) {
    material.channels.push_back(read_channel(c, coefficients));
  });
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

Ordered channel_json(const MaterialChannel& channel, const Basis* peer) {
  Ordered out{{"name", channel.name}, {"wavelength_um", number_or_null(channel.wavelength_um)}};
  if (channel.f0) {
    out["f0"] = *channel.f0;
  } else {
    out["n"] = number_or_null(channel.n);
    out["kappa"] = number_or_null(channel.kappa);
  }
  for (const std::string& name : coefficient_names(peer)) {
    if (peer == nullptr || channel.peer_k.contains(name)) out[name] = number_or_null(channel.coefficient(name));
  }
  return out;
}

void add_surface(Ordered& out, const Material& material) {
  out["components"] = components_json(material.components);
  out["terms"] = {{"fresnel", name_of(material.terms.fresnel)},
                  {"shadowing", name_of(material.terms.shadowing)},
                  {"effective_roughness", name_of(material.terms.effective_roughness)},
                  {"distribution", name_of(material.terms.distribution)}};
  Surface surface = material.surface;
  for (const std::string_view name : surface_parameter_names) {
    out["surface"][std::string(name)] = number_or_null(*surface.find(name));
  }
  out["forms"] = {{"fs", name_of(material.forms.fs)},
                  {"rough", name_of(material.forms.rough)},
                  {"anisotropy", name_of(material.forms.anisotropy)}};
}

void add_peer(Ordered& out, const Material& material, const Basis& peer) {
  out["model"] = material.model;
  out["terms"] = {{"fresnel", name_of(material.terms.fresnel)}};
  out["parameters"] = Ordered::object();
  for (const ShapeParameter& p : peer.shape_parameters()) {
    const auto found = material.parameters.find(p.name);
    if (found != material.parameters.end()) out["parameters"][p.name] = number_or_null(found->second);
  }
}

Ordered fit_json(const FitSummary& fit, const std::vector<MaterialChannel>& channels) {
  Ordered uncertainty = Ordered::object();
  for (const auto& [parameter, u] : fit.shared_uncertainty) uncertainty[parameter] = u;
  for (const MaterialChannel& channel : channels) {
    const auto by_parameter = fit.channel_uncertainty.find(channel.name);
    if (by_parameter != fit.channel_uncertainty.end()) uncertainty[channel.name] = by_parameter->second;
  }
  Ordered out{{"loss", fit.loss},
              {"rms", fit.rms},
              {"samples", fit.samples},
              {"converged", fit.converged},
              {"uncertainty", std::move(uncertainty)},
              {"identifiable", fit.identifiable}};
  if (!fit.uncertainty_from.empty()) out["uncertainty_from"] = fit.uncertainty_from;
  for (const auto& [parameter, interval] : fit.interval_95) {
    out["interval_95"][parameter] = {interval.lower, interval.upper};
  }
  return out;
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
  const std::unique_ptr<const Basis> peer = require_model(material.name, "/model", material.model);
  Ordered out{{"format", format_name}, {"version", format_version}, {"name", material.name}};
  if (peer) {
    add_peer(out, material, *peer);
  } else {
    add_surface(out, material);
  }
  out["channels"] = Ordered::array();
  for (const MaterialChannel& channel : material.channels) out["channels"].push_back(channel_json(channel, peer.get()));
  out["solid_angle_sr"] = material.solid_angle_sr;
  if (material.fit) out["fit"] = fit_json(*material.fit, material.channels);
  // A name from a Latin-1 scan is not UTF-8: a replaced character is better than no output.
  return out.dump(2, ' ', false, Ordered::error_handler_t::replace) + '\n';
}

void write_material(const std::filesystem::path& path, const Material& material) {
  write_file(path, to_json(material));
}

}  // namespace goniofit
