// Subsets of the effects, and the forms of the rough one.

#include <algorithm>
#include <array>

#include "brdf/paper_samples.h"
#include "cost/plan_search.h"
#include "cost/tradeoff_parts.h"

namespace goniofit::tradeoff {

namespace {

constexpr double added_k = 0.05;
constexpr const char* added_note = "effects that the sample lacks have a coefficient of 0.05";

// A material of the paper with all of its five effects: those that it lacks are added faintly, so that every subset
// can be timed. Its lengths are known.
Material with_five_effects(Material m) {
  for (const Effect e : {Effect::coh, Effect::dd, Effect::udf, Effect::uds, Effect::fs}) {
    m.components.insert(e);
    for (MaterialChannel& c : m.channels) {
      std::optional<double>& k = c.coefficient(coefficient_of(e));
      if (k.value_or(0.0) == 0.0) k = added_k;
    }
  }
  return m;
}

bool is_paper_sample(const Material& m) {
  const std::array<Material, 4> samples = paper_samples();
  return std::find(samples.begin(), samples.end(), m) != samples.end();
}

}  // namespace

Rows effect_rows(const Material& material, const TradeoffSettings& s) {
  Material full = is_paper_sample(material) ? with_five_effects(material) : material;
  full.terms = published_terms(material);
  const EvaluationCandidate exact{.name = effects_text(full.components), .material = full};
  Table table{.group = TradeoffGroup::effects, .material = material.name, .reference = exact.name};
  for (const EffectSet effects : subsets_of(acting_effects(full))) {
    EvaluationCandidate c{.name = effects_text(effects), .material = full, .compile = {.instructions = s.instructions}};
    c.material.components = effects;
    if (full.components != material.components) c.note = added_note;
    table.candidates.push_back(std::move(c));
  }
  if (table.candidates.empty()) return {};
  table.baseline = table.candidates.size() - 1;
  return measured(table, exact, error_samples(full, {}, s.errors), s);
}

Rows oren_nayar_rows(const Material& material, const TradeoffSettings& s) {
  Material rough = material;
  const bool has_grooves = acting_effects(material).has(Effect::rough);
  if (!has_grooves) {
    rough.surface.facet_slope_deg = 30.0;
    for (MaterialChannel& c : rough.channels) c.coefficient(Coefficient::rho) = 0.9;
  }
  rough.components = {Effect::rough};
  rough.forms.rough = RoughForm::integral;
  const EvaluationCandidate exact{.name = "integral", .material = rough};
  Table table{.group = TradeoffGroup::oren_nayar, .material = material.name, .reference = "integral over V-cavities"};
  if (!has_grooves) table.material = "matte grooves, facet slope 30 degrees, rho 0.9";
  for (const RoughForm form : {RoughForm::integral, RoughForm::functional, RoughForm::qualitative}) {
    EvaluationCandidate c{
        .name = std::string(name_of(form)), .material = rough, .compile = {.instructions = s.instructions}};
    c.material.forms.rough = form;
    table.candidates.push_back(std::move(c));
  }
  table.baseline = 2;
  return measured(table, exact, error_samples(rough, {}, s.errors), s);
}

}  // namespace goniofit::tradeoff
