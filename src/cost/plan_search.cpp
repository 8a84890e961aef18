#include "cost/plan_search.h"

#include <algorithm>
#include <utility>

#include "cost/reference.h"

namespace goniofit {

namespace {

template <class T>
void add_tier(std::vector<T>& tiers, T tier) {
  if (std::find(tiers.begin(), tiers.end(), tier) == tiers.end()) tiers.push_back(tier);
}

void add(ModelValues& to, const ModelValues& part) {
  const auto add_all = [](std::vector<double>& sum, const std::vector<double>& x) {
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += x[i];
  };
  add_all(to.f, part.f);
  add_all(to.mirror, part.mirror);
  add_all(to.mirror_energy, part.mirror_energy);
}

}  // namespace

std::vector<EffectSet> subsets_of(EffectSet all) {
  std::vector<EffectSet> sets{{}};
  for (const Effect e : all_effects) {
    if (!all.has(e)) continue;
    const std::size_t without = sets.size();
    for (std::size_t i = 0; i < without; ++i) {
      sets.push_back(sets[i]);
      sets.back().insert(e);
    }
  }
  sets.erase(sets.begin());
  return sets;
}

bool reads_fresnel(EffectSet e) noexcept {
  return e.has(Effect::coh) || e.has(Effect::dd) || e.has(Effect::uds) || e.has(Effect::fs);
}
bool reads_shadowing(EffectSet e) noexcept { return e.has(Effect::coh) || e.has(Effect::dd); }
bool reads_effective_roughness(EffectSet e) noexcept { return reads_shadowing(e) || e.has(Effect::fs); }
bool reads_distribution(EffectSet e) noexcept { return e.has(Effect::dd); }

PlanSearch::PlanSearch(Material reference, const Terms& given, const PlanSamples& samples, const PlanSettings& settings)
    : reference_(std::move(reference)),
      given_(given),
      compile_(settings.compile),
      arithmetic_(settings.arithmetic),
      acting_(acting_effects(reference_)),
      samples_(samples),
      fresnel_{reference_.terms.fresnel},
      shadowing_{reference_.terms.shadowing},
      roughness_{reference_.terms.effective_roughness},
      distribution_{reference_.terms.distribution} {
  add_tier(fresnel_, FresnelTier::schlick);
  add_tier(fresnel_, FresnelTier::none);
  for (const ShadowingTier t : {ShadowingTier::li_torrance, ShadowingTier::schlick, ShadowingTier::none}) {
    add_tier(shadowing_, t);
  }
  add_tier(roughness_, EffectiveRoughnessTier::li_torrance);
  add_tier(roughness_, EffectiveRoughnessTier::none);
  add_tier(distribution_, DistributionTier::rough_limit);
  for (const RoughForm form : {RoughForm::integral, RoughForm::functional, RoughForm::qualitative}) {
    if (form >= reference_.forms.rough) rough_.push_back(form);
  }
  const EvaluationCandidate exact{.name = "reference", .material = material(this->reference())};
  exact_ = model_values(exact, samples_.directions);
}

PlanChoice PlanSearch::reference() const { return canonical({acting_, reference_.terms, reference_.forms.rough}); }

PlanChoice PlanSearch::canonical(PlanChoice c) const {
  if (!reads_fresnel(c.effects)) c.terms.fresnel = given_.fresnel;
  if (!reads_shadowing(c.effects)) c.terms.shadowing = given_.shadowing;
  if (!reads_effective_roughness(c.effects)) c.terms.effective_roughness = given_.effective_roughness;
  if (!reads_distribution(c.effects)) c.terms.distribution = given_.distribution;
  if (!c.effects.has(Effect::rough)) c.rough = reference_.forms.rough;
  return c;
}

std::vector<PlanChoice> PlanSearch::all() const {
  std::vector<PlanChoice> choices;
  const auto add_all_tiers = [&](EffectSet effects) {
    const std::size_t first = choices.size();
    for (const FresnelTier f : fresnel_)
      for (const ShadowingTier s : shadowing_)
        for (const EffectiveRoughnessTier r : roughness_)
          for (const DistributionTier d : distribution_)
            for (const RoughForm form : rough_) {
              const PlanChoice c = canonical({effects, {f, s, r, d}, form});
              const auto begin = choices.begin() + static_cast<std::ptrdiff_t>(first);
              if (std::find(begin, choices.end(), c) == choices.end()) choices.push_back(c);
            }
  };
  for (const EffectSet effects : subsets_of(acting_)) {
    const bool keeps_all = std::all_of(samples_.keep.begin(), samples_.keep.end(), [&](const auto& kept) {
      return effects.has(kept.first) || !acting_.has(kept.first);
    });
    if (keeps_all) add_all_tiers(effects);
  }
  return choices;
}

Material PlanSearch::material(const PlanChoice& c) const {
  Material m = reference_;
  m.components = c.effects;
  m.terms = c.terms;
  m.forms.rough = c.rough;
  return m;
}

const ModelValues& PlanSearch::part(Effect effect, const PlanChoice& choice) {
  PlanChoice alone = choice;
  alone.effects = {effect};
  alone = canonical(alone);
  const Terms& t = alone.terms;
  const Key key{effect, t.fresnel, t.shadowing, t.effective_roughness, t.distribution, alone.rough};
  const auto found = parts_.find(key);
  if (found != parts_.end()) return found->second;
  const EvaluationCandidate candidate{.name = std::string(name_of(effect)),
                                      .material = material(alone),
                                      .compile = compile_,
                                      .arithmetic = arithmetic_};
  return parts_.emplace(key, model_values(candidate, samples_.directions)).first->second;
}

ModelValues PlanSearch::sum(const PlanChoice& choice) {
  const std::size_t channels = reference_.channels.size();
  const std::size_t mirrors = channels * samples_.directions.mirrors.size();
  ModelValues total{.channels = channels,
                    .f = std::vector<double>(channels * samples_.directions.directions.size()),
                    .mirror = std::vector<double>(mirrors),
                    .mirror_energy = std::vector<double>(mirrors)};
  for (const Effect e : all_effects) {
    if (choice.effects.has(e)) add(total, part(e, choice));
  }
  return total;
}

ModelError PlanSearch::error(const PlanChoice& choice) { return samples_.error(exact_, sum(choice)); }

const std::string* PlanSearch::reason_to_keep(Effect effect) const noexcept {
  const auto found = samples_.keep.find(effect);
  return found == samples_.keep.end() ? nullptr : &found->second;
}

bool no_dearer(const PlanChoice& a, const PlanChoice& b) noexcept {
  for (const Effect e : all_effects) {
    if (a.effects.has(e) && !b.effects.has(e)) return false;
  }
  const auto same_or = [](auto x, auto y, auto least) { return x == y || x == least; };
  const Terms& s = a.terms;
  const Terms& t = b.terms;
  if (reads_fresnel(a.effects) && !same_or(s.fresnel, t.fresnel, FresnelTier::none) &&
      !(s.fresnel == FresnelTier::schlick && t.fresnel == FresnelTier::exact)) {
    return false;
  }
  if (reads_shadowing(a.effects) && !same_or(s.shadowing, t.shadowing, ShadowingTier::none)) return false;
  if (reads_effective_roughness(a.effects) &&
      !same_or(s.effective_roughness, t.effective_roughness, EffectiveRoughnessTier::none)) {
    return false;
  }
  if (reads_distribution(a.effects) && !same_or(s.distribution, t.distribution, DistributionTier::rough_limit)) {
    return false;
  }
  return !a.effects.has(Effect::rough) || a.rough >= b.rough;
}

namespace {

/// Of double precision and AVX-512 on a server processor of 2020; their order matters more than the numbers.
constexpr double usual(FresnelTier t) { return t == FresnelTier::exact ? 3.0 : t == FresnelTier::schlick ? 0.4 : 0.0; }
constexpr double usual(ShadowingTier t) {
  return t == ShadowingTier::smith         ? 3.5
         : t == ShadowingTier::li_torrance ? 2.5
         : t == ShadowingTier::schlick     ? 0.5
                                           : 0.0;
}
constexpr double usual(EffectiveRoughnessTier t) {
  return t == EffectiveRoughnessTier::he ? 6.0 : t == EffectiveRoughnessTier::li_torrance ? 3.0 : 0.0;
}
constexpr double usual(DistributionTier t) {
  return t == DistributionTier::he_torrance_series ? 400.0
         : t == DistributionTier::he_torrance      ? 7.0
         : t == DistributionTier::student_t        ? 2.0
                                                   : 0.0;
}
constexpr double usual(RoughForm f) {
  return f == RoughForm::integral ? 3000.0 : f == RoughForm::functional ? 20.0 : 15.0;
}

}  // namespace

double usual_ns(const PlanChoice& choice) noexcept {
  const EffectSet e = choice.effects;
  constexpr double directions_to_cosines = 1.5;
  double ns = directions_to_cosines;
  if (e.has(Effect::dd)) ns += 1.0;
  if (e.has(Effect::uds)) ns += 0.1;
  if (e.has(Effect::fs)) ns += 1.2;
  if (e.has(Effect::coh)) ns += 0.5;
  if (e.has(Effect::rough)) ns += usual(choice.rough);
  if (reads_fresnel(e)) ns += usual(choice.terms.fresnel);
  if (reads_shadowing(e)) ns += usual(choice.terms.shadowing);
  if (reads_effective_roughness(e)) ns += usual(choice.terms.effective_roughness);
  if (reads_distribution(e)) ns += usual(choice.terms.distribution);
  return ns;
}

}  // namespace goniofit
