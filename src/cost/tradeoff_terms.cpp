// The tiers of one term: the error of the term by itself over uniform cosines, the time of dd with it.

#include <array>
#include <cmath>

#include "basis/optics.h"
#include "brdf/surface_shape.h"
#include "cost/fitted_models.h"
#include "cost/tradeoff_parts.h"
#include "support/text.h"
#include "synthetic/random.h"

namespace goniofit::tradeoff {

namespace {

constexpr std::size_t cosines = 4096;

// dd alone, all terms as published.
Material dd_of(const Material& material) {
  Material m = material;
  m.components = {Effect::dd};
  m.terms = published_terms(material);
  return m;
}

EvaluationCandidate tier(std::string name, const Material& m, const TradeoffSettings& s) {
  return {.name = std::move(name), .material = m, .compile = {.instructions = s.instructions}};
}

// A term's function and its arguments, uniform in (0, 1), for the time of the function alone.
template <class Function>
TimedTask term_task(const Function& f) {
  std::vector<double> x;
  RandomStream random(subkey(1, "cosines"));
  for (std::size_t i = 0; i < cosines; ++i) x.push_back(random.uniform());
  std::vector<double> out(cosines);
  return {[f, x = std::move(x), out = std::move(out)]() mutable {
            for (std::size_t i = 0; i < cosines; ++i) out[i] = f(x[i]);
            keep(out.data());
          },
          static_cast<double>(cosines)};
}

// One tier: what it is called and its function of a uniform number.
struct Tier {
  ApproximationError error;
  TimedTask task;
};
template <class Exact, class Function>
Tier tier_of(const Exact& exact, const Function& f) {
  return {approximation_error(exact, f, 0.0, 1.0), term_task(f)};
}

Tier fresnel_tier(FresnelTier t, const MaterialChannel& c) {
  const double n = c.n.value_or(1.0);
  const double kappa = c.kappa.value_or(0.0);
  const double f0 = c.normal_reflectance();
  const auto exact = [=](double u) { return fresnel_exact(n, kappa, u, 1.0 - u); };
  if (t == FresnelTier::exact) return tier_of(exact, exact);
  if (t == FresnelTier::none) return tier_of(exact, [](double) { return 1.0; });
  return tier_of(exact, [=](double u) { return fresnel_schlick(f0, 1.0 - u); });
}

// S1(c). The shortcut is LT (7), S1 = 1 where c > 1 - 0.005^(sigma/tau).
Tier shadowing_tier(ShadowingTier t, bool shortcut, double slope) {
  const double q = 1.0 / slope;
  const auto exact = [=](double c) {
    return c * shadowing_smith_over_cosine(slope, c, std::sqrt((1.0 - c) * (1.0 + c)));
  };
  const auto li_torrance = [=](double c) { return shadowing_li_torrance(q, std::log1p(-c)); };
  if (t == ShadowingTier::smith) return tier_of(exact, exact);
  if (t == ShadowingTier::none) return tier_of(exact, [](double) { return 1.0; });
  if (t == ShadowingTier::schlick) {
    return tier_of(exact, [=](double c) { return c * shadowing_schlick_over_cosine(slope, c); });
  }
  if (!shortcut) return tier_of(exact, li_torrance);
  const double open_from = 1.0 - std::pow(0.005, slope);
  return tier_of(exact, [=](double c) { return c > open_from ? 1.0 : li_torrance(c); });
}

// sigma_e/sigma of two cosines, c and another one drawn by c's lower digits: both uniform.
Tier roughness_tier(EffectiveRoughnessTier t, double slope) {
  const auto pair_of = [](double x) {
    const double shifted = x * 1000.0;
    Pair p{};
    p.cos_i = x;
    p.cos_r = std::max(shifted - std::floor(shifted), 1e-6);
    p.one_minus_cos_i = 1.0 - p.cos_i;
    p.one_minus_cos_r = 1.0 - p.cos_r;
    return p;
  };
  const auto exact = [=](double x) { return std::exp(log_effective_roughness_he(slope, pair_of(x))); };
  if (t == EffectiveRoughnessTier::he) return tier_of(exact, exact);
  if (t == EffectiveRoughnessTier::none) return tier_of(exact, [](double) { return 1.0; });
  const double q = 1.0 / slope;
  return tier_of(exact, [=](double x) {
    const Pair p = pair_of(x);
    return std::exp(log_visible_part(q, std::log1p(-p.cos_i)) + log_visible_part(q, std::log1p(-p.cos_r)));
  });
}

// The tiers of a table with their functions; the exact one comes first.
struct Ladder {
  Table table;
  std::vector<Tier> tiers;
  void add(EvaluationCandidate c, Tier t) {
    table.candidates.push_back(std::move(c));
    tiers.push_back(std::move(t));
  }
};

void add_fresnel(Ladder& ladder, const Material& dd, const TradeoffSettings& s) {
  ladder.table.reference = "Fresnel's formula";
  for (const FresnelTier t : {FresnelTier::exact, FresnelTier::schlick, FresnelTier::none}) {
    Material m = dd;
    m.terms.fresnel = t;
    ladder.add(tier(std::string(name_of(t)), m, s), fresnel_tier(t, dd.channels.front()));
  }
}

void add_shadowing(Ladder& ladder, const Material& dd, const TradeoffSettings& s) {
  ladder.table.reference = "Smith's function";
  const double slope = *dd.surface.slope;
  for (const ShadowingTier t :
       {ShadowingTier::smith, ShadowingTier::li_torrance, ShadowingTier::schlick, ShadowingTier::none}) {
    Material m = dd;
    m.terms.shadowing = t;
    ladder.add(tier(std::string(name_of(t)), m, s), shadowing_tier(t, false, slope));
  }
  EvaluationCandidate shortcut = tier("li-torrance, S = 1 shortcut", dd, s);
  shortcut.compile.shadowing_shortcut = true;
  ladder.add(std::move(shortcut), shadowing_tier(ShadowingTier::li_torrance, true, slope));
}

void add_roughness(Ladder& ladder, const Material& dd, const TradeoffSettings& s) {
  ladder.table.reference = "He et al.'s sigma_e";
  for (const EffectiveRoughnessTier t :
       {EffectiveRoughnessTier::he, EffectiveRoughnessTier::li_torrance, EffectiveRoughnessTier::none}) {
    Material m = dd;
    m.terms.effective_roughness = t;
    ladder.add(tier(std::string(name_of(t)), m, s), roughness_tier(t, *dd.surface.slope));
  }
}

Rows ladder_rows(const Ladder& ladder, const TradeoffSettings& s) {
  Rows rows = timed(ladder.table, s);
  std::vector<TimedTask> tasks;
  for (const Tier& t : ladder.tiers) tasks.push_back(t.task);
  const std::vector<Timing> times = time_interleaved(tasks, 0, s.timing);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const ApproximationError& e = ladder.tiers[i].error;
    rows[i].term = TermFigures{.error = e, .time = times[i], .gain = 1.0 / times[i].ratio};
    rows[i].error = {.l1 = e.l1, .rms_relative = e.rms_relative, .max_relative = e.max_relative};
  }
  mark_pareto(rows);
  return rows;
}

// The tail that comes nearest to the lobe of dd, all else held; the longest that a fit tries where it is no better than
// none at all.
EvaluationCandidate long_tailed(const Material& exact, const TradeoffSettings& s) {
  FitSettings settings;
  settings.components = EffectSet{Effect::dd};
  settings.terms = exact.terms;
  settings.terms.distribution = DistributionTier::student_t;
  settings.parameters["slope"] = {exact.surface.slope, {}, {}};
  for (const MaterialChannel& c : exact.channels) {
    if (c.f0) settings.f0.push_back(*c.f0);
    settings.parameters[c.name + ".k_dd"] = {c.coefficient(Coefficient::k_dd), {}, {}};
  }
  EvaluationCandidate c = tier("student-t", l1_fit(reference_scan(exact, s.seed + 1), settings), s);
  std::optional<double>& tail = c.material.surface.tail;
  if (!tail) tail = tail_max;
  c.note = "student-t: tail " + shortest(std::round(10.0 * *tail) / 10.0);
  return c;
}

Rows distribution_rows(const Material& dd, const TradeoffSettings& s) {
  const bool wave_optics =
      reference_of(dd, WaveOptics::fast).material.terms.distribution == DistributionTier::he_torrance;
  if (!wave_optics) return {};
  Table table{.group = TradeoffGroup::distribution, .material = dd.name, .reference = "he-torrance-series"};
  for (const DistributionTier t :
       {DistributionTier::he_torrance_series, DistributionTier::he_torrance, DistributionTier::rough_limit}) {
    EvaluationCandidate c = tier(std::string(name_of(t)), dd, s);
    c.material.terms.distribution = t;
    table.candidates.push_back(std::move(c));
  }
  const EvaluationCandidate exact = table.candidates[0];
  table.candidates.push_back(long_tailed(table.candidates[1].material, s));
  table.baseline = 2;
  return measured(table, exact, error_samples(table.candidates[1].material, {}, s.errors), s);
}

}  // namespace

Rows term_rows(TradeoffGroup group, const Material& material, const TradeoffSettings& s) {
  if (!acting_effects(material).has(Effect::dd)) return {};
  const Material dd = dd_of(material);
  if (group == TradeoffGroup::distribution) return distribution_rows(dd, s);
  Ladder ladder;
  ladder.table.group = group;
  ladder.table.material = material.name;
  const bool index_known = dd.channels.front().n.has_value();
  if (group == TradeoffGroup::fresnel && !index_known) return {};
  if (group == TradeoffGroup::fresnel) add_fresnel(ladder, dd, s);
  if (group == TradeoffGroup::shadowing) add_shadowing(ladder, dd, s);
  if (group == TradeoffGroup::effective_roughness) add_roughness(ladder, dd, s);
  return ladder_rows(ladder, s);
}

}  // namespace goniofit::tradeoff
