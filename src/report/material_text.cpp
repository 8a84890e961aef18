#include "report/material_text.h"

#include <vector>

#include <fmt/format.h>

namespace goniofit {

std::string terms_text(const Material& material) {
  const Terms& terms = material.terms;
  if (material.model != surface_model) return fmt::format("Fresnel {}", name_of(terms.fresnel));
  return fmt::format("Fresnel {}, shadowing {}, effective roughness {}, distribution {}", name_of(terms.fresnel),
                     name_of(terms.shadowing), name_of(terms.effective_roughness), name_of(terms.distribution));
}

std::string forms_text(const Material& material) {
  std::vector<std::string> parts;
  const auto add = [&](const char* of, std::string_view form) { parts.push_back(fmt::format("{} {}", of, form)); };
  if (material.components.has(Effect::fs)) add("fs", name_of(material.forms.fs));
  if (material.components.has(Effect::rough)) add("rough", name_of(material.forms.rough));
  if (material.surface.anisotropic()) add("anisotropy", name_of(material.forms.anisotropy));
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace goniofit
