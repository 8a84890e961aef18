#include "render/material_variants.h"

#include <algorithm>
#include <string_view>

#include "brdf/evaluator.h"
#include "brdf/named_terms.h"
#include "support/error.h"
#include "support/text.h"

namespace goniofit {

namespace {

Material lambertian(const Material& material) {
  const std::vector<double> reflectance = hemispherical_reflectance(Evaluator(material), 0.0);
  Material diffuse;
  diffuse.name = material.name;
  diffuse.components = {Effect::udf};
  for (std::size_t c = 0; c < material.channels.size(); ++c) {
    MaterialChannel channel;
    channel.name = material.channels[c].name;
    channel.wavelength_um = material.channels[c].wavelength_um;
    channel.coefficient(Coefficient::k_udf) = std::min(reflectance[c], 1.0);
    diffuse.channels.push_back(channel);
  }
  return diffuse;
}

// nullopt where one of the names is no effect of the material.
std::optional<EffectSet> effects_named(std::string_view text, EffectSet of) {
  EffectSet effects;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('+', begin), text.size());
    const std::optional<Effect> effect = parse_name<Effect>(text.substr(begin, end - begin));
    if (!effect || !of.has(*effect)) return std::nullopt;
    effects.insert(*effect);
    begin = end + 1;
  }
  return effects;
}

}  // namespace

Material variant_of(const Material& material, const std::string& name) {
  if (name == "given") return material;
  if (name == "lambert") return lambertian(material);
  if (material.model != surface_model) {
    throw usage_error(in_quotes(name) + " of a material of model " + material.model + ", expected given or lambert");
  }
  Material variant = material;
  const bool neither = name == "neither";
  if (const std::optional<Terms> terms = named_terms(name)) {
    variant.terms = *terms;
  } else if (neither || name == "no-shadowing" || name == "no-roughness") {
    if (neither || name == "no-shadowing") variant.terms.shadowing = ShadowingTier::none;
    if (neither || name == "no-roughness") variant.terms.effective_roughness = EffectiveRoughnessTier::none;
  } else if (const std::optional<EffectSet> effects = effects_named(name, material.components)) {
    variant.components = *effects;
  } else {
    throw usage_error(in_quotes(name) + " is no model and names no effects of " + in_quotes(material.name) +
                      ", expected " + variant_words);
  }
  validate(variant, material.name + " as " + name);
  return variant;
}

}  // namespace goniofit
