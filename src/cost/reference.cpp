#include "cost/reference.h"

#include <algorithm>

#include "support/error.h"
#include "support/text.h"
#include "terms/student_t_shadowing.h"

namespace goniofit {

namespace {

bool knows_wave_optics(const Material& m) {
  return m.surface.sigma_um && std::all_of(m.channels.begin(), m.channels.end(),
                                           [](const MaterialChannel& c) { return c.wavelength_um.has_value(); });
}

}  // namespace

EffectSet acting_effects(const Material& m) {
  EffectSet acting;
  for (const Effect e : all_effects) {
    const bool acts = std::any_of(m.channels.begin(), m.channels.end(), [&](const MaterialChannel& c) {
      return c.coefficient(coefficient_of(e)).value_or(0.0) != 0.0;
    });
    if (acts && m.components.has(e)) acting.insert(e);
  }
  return acting;
}

Reference reference_of(const Material& material, WaveOptics wave_optics) {
  const std::string where = material.name.empty() ? "material" : material.name;
  validate(material, where);
  if (material.model != surface_model) {
    throw key_error(
        where, "/model",
        in_quotes(material.model) + " has no terms to exchange, expected \"" + std::string(surface_model) + "\"");
  }
  Reference r{material, {}};
  r.material.fit.reset();
  Terms& terms = r.material.terms;
  const bool indices = std::all_of(material.channels.begin(), material.channels.end(),
                                   [](const MaterialChannel& c) { return c.n.has_value(); });
  terms.fresnel = indices ? FresnelTier::exact : FresnelTier::schlick;
  terms.effective_roughness = EffectiveRoughnessTier::he;
  terms.shadowing = ShadowingTier::smith;
  if (terms.distribution == DistributionTier::student_t) {
    if (material.surface.tail.value_or(2.0) <= smallest_tail_with_smith) {
      terms.shadowing = material.terms.shadowing;
    }
  } else if (!knows_wave_optics(material)) {
    terms.distribution = DistributionTier::rough_limit;
  } else {
    terms.distribution =
        wave_optics == WaveOptics::series ? DistributionTier::he_torrance_series : DistributionTier::he_torrance;
  }
  r.name = std::string(name_of(terms.distribution)) + (indices ? ", exact terms" : ", exact terms but Schlick's F");
  if (terms.distribution == DistributionTier::rough_limit) r.name += " (sigma or a wavelength unknown)";
  return r;
}

Terms published_terms(const Material& material) {
  Terms terms;
  if (material.terms.distribution == DistributionTier::student_t) terms.distribution = DistributionTier::student_t;
  return terms;
}

}  // namespace goniofit
