#include "fit/comparison.h"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <set>
#include <string_view>

#include "brdf/effects.h"
#include "brdf/named_terms.h"
#include "fit/comparison_criteria.h"
#include "peers/peers.h"
#include "support/error.h"
#include "support/text.h"

namespace goniofit {

namespace {

constexpr std::array<std::string_view, 14> isotropic_models{
    "lambert", "oren-nayar",    "blinn-phong", "neumann-neumann", "lafortune-1",    "lafortune-2", "lafortune-3",
    "ward",    "cook-torrance", "ggx",         "schlick-single",  "schlick-double", "rough+dd",    "li-torrance"};
constexpr std::array<std::string_view, 7> choosable_models{
    "li-torrance", "li-torrance-student-t", "he-torrance", "ggx", "cook-torrance", "ward", "lafortune-1"};
constexpr std::string_view oren_nayar = "oren-nayar";
constexpr std::string_view surface_li_torrance = "li-torrance";
constexpr std::string_view long_tails = "li-torrance-student-t";

// "rough+dd" as effects; nullopt where a part is none.
std::optional<EffectSet> parse_effects(std::string_view text) {
  EffectSet effects;
  while (true) {
    const std::size_t plus = text.find('+');
    const std::optional<Effect> effect = parse_name<Effect>(text.substr(0, plus));
    if (!effect || effects.has(*effect)) return std::nullopt;
    effects.insert(*effect);
    if (plus == std::string_view::npos) return effects;
    text.remove_prefix(plus + 1);
  }
}

// The part of a key behind the channel: "k_dd" of "R.k_dd".
std::string parameter_of(const std::string& key) { return key.substr(key.rfind('.') + 1); }

bool has_parameter(const std::string& model, const std::string& name) {
  if (name == "n" || name == "f0") return true;
  if (model == surface_model) {
    return Surface{}.find(name) != nullptr || parse_name<Coefficient>(name).has_value();
  }
  const std::unique_ptr<const Basis> basis = make_peer(model);
  return std::any_of(basis->shape_parameters().begin(), basis->shape_parameters().end(),
                     [&](const ShapeParameter& p) { return p.name == name; }) ||
         std::any_of(basis->coefficients().begin(), basis->coefficients().end(),
                     [&](const BasisCoefficient& c) { return !c.constant() && c.name == name; });
}

// Whether the model reads n and kappa at all. Automatic components do.
bool reads_optics(const FitSettings& settings) {
  if (settings.model != surface_model) {
    const std::unique_ptr<const Basis> basis = make_peer(settings.model);
    return std::any_of(basis->columns().begin(), basis->columns().end(),
                       [](const BasisColumn& c) { return c.optics != OpticsFactor::one; });
  }
  return !settings.components || std::any_of(all_effects.begin(), all_effects.end(), [&](Effect e) {
    return settings.components->has(e) && optics_factor_of(coefficient_of(e)) != OpticsFactor::one;
  });
}

// What the name says; the rest of the settings stays.
void choose_model(const std::string& model, FitSettings& settings) {
  settings.model = std::string(surface_model);
  if (make_peer(model)) {
    settings.model = model;
    settings.components.reset();
    settings.terms = {.fresnel = settings.terms.fresnel};
    settings.forms = {};
    settings.anisotropic = false;
  } else if (model == oren_nayar) {
    settings.components = EffectSet{Effect::rough};
  } else if (const std::optional<Terms> terms = named_terms(model)) {
    settings.terms = *terms;
  } else if (model == long_tails) {
    settings.terms = {.distribution = DistributionTier::student_t};
  } else if (const std::optional<EffectSet> effects = parse_effects(model)) {
    settings.components = *effects;
  } else {
    throw usage_error("model " + in_quotes(model) +
                      ": no such model, expected one that `goniofit models` names, oren-nayar, li-torrance, " +
                      std::string(long_tails) + ", he-torrance, or effects such as rough+dd");
  }
}

bool wavelengths_known(const Scan& scan) {
  return std::all_of(scan.channels.begin(), scan.channels.end(),
                     [](const ScanChannel& c) { return c.wavelength_um.has_value(); });
}

void check_models(const FitSettings& settings, const std::vector<std::string>& models) {
  if (models.empty()) throw usage_error("no model to compare, expected at least one");
  std::set<std::string> given;
  for (const std::string& model : models) {
    if (!given.insert(model).second) throw usage_error("model " + in_quotes(model) + " is named twice");
    (void)settings_for_model(model, settings);  // a slip in the last name shall not cost the fits of those before it
  }
  for (const auto& [key, setting] : settings.parameters) {
    const bool known = std::any_of(models.begin(), models.end(), [&, &name = key](const std::string& model) {
      return has_parameter(settings_for_model(model, settings).model, parameter_of(name));
    });
    if (!known) throw usage_error("parameter " + key + ": none of the models compared has it");
  }
}

// Whether these are Li & Torrance's effects with other terms: with the components that were chosen for the published
// ones they differ in the terms alone.
bool other_terms(const std::string& model) {
  return model != surface_li_torrance && (model == long_tails || named_terms(model).has_value());
}

ComparedFit fitted(const Scan& scan, const FitSettings& settings, const std::string& model,
                   const std::optional<EffectSet>& chosen) {
  ComparedFit row{model, {}, 0, {}};
  FitSettings own = settings_for_model(model, settings);
  if (other_terms(model) && !own.components && chosen) own.components = chosen;
  try {
    row.fit = fit(scan, own);
  } catch (const Error& error) {
    throw Error(error.kind(), "model " + model + ": " + error.what());
  }
  for (const FittedParameter& p : row.fit.parameters) {
    if (p.value && !p.fixed && !p.derived) ++row.free_parameters;
  }
  return row;
}

}  // namespace

ModelList default_models(const Scan& scan, const FitSettings& settings) {
  ModelList list;
  list.models.assign(isotropic_models.begin(), isotropic_models.end());
  list.models.emplace_back(long_tails);
  if (settings.anisotropic) list.models.insert(list.models.end(), {"ward-anisotropic", "ggx-anisotropic"});
  if (!wavelengths_known(scan)) {
    list.notes.emplace_back(
        "he-torrance was left out: it needs each channel's wavelength; add a line '# wavelength_um: ...' to the scan");
  } else if (!settings.f0.empty() || settings.free_optics == FreeOptics::f0) {
    list.notes.emplace_back("he-torrance was left out: its exact Fresnel term needs n and kappa in place of f0");
  } else {
    list.models.emplace_back("he-torrance");
  }
  return list;
}

ModelList models_to_choose_from(const Scan& scan, const FitSettings& settings) {
  ModelList list = default_models(scan, settings);
  std::erase_if(list.models, [](const std::string& model) {
    return std::find(choosable_models.begin(), choosable_models.end(), model) == choosable_models.end();
  });
  return list;
}

FitSettings settings_for_model(const std::string& model, const FitSettings& settings) {
  FitSettings own = settings;
  choose_model(model, own);
  std::erase_if(own.parameters,
                [&](const auto& entry) { return !has_parameter(own.model, parameter_of(entry.first)); });
  // A free index that nothing reads would only be one more parameter that is not determined.
  if (!reads_optics(own)) own.free_optics = FreeOptics::none;
  return own;
}

Comparison compare(const Scan& scan, const FitSettings& settings, const std::vector<std::string>& models,
                   const ComparisonProgress& progress) {
  check_models(settings, models);
  Comparison result;
  std::optional<EffectSet> chosen;
  for (const std::string& model : models) {
    if (progress) progress(model, result.rows.size(), models.size());
    result.rows.push_back(fitted(scan, settings, model, chosen));
    const FitResult& latest = result.rows.back().fit;
    if (model == surface_li_torrance && latest.components_were_auto) chosen = latest.selection->chosen();
    for (const auto& [key, setting] : settings.parameters) {
      if (has_parameter(result.rows.back().fit.material.model, parameter_of(key))) continue;
      result.notes.push_back(model + " has no parameter " + parameter_of(key) + " and goes without its setting");
    }
  }
  std::stable_sort(result.rows.begin(), result.rows.end(),
                   [](const ComparedFit& a, const ComparedFit& b) { return a.fit.loss < b.fit.loss; });
  add_criteria(scan, settings, result);
  return result;
}

}  // namespace goniofit
