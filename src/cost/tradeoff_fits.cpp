// What fitting with cheaper terms gives: the time, and whether the slope is still right.

#include <cmath>

#include "cost/tradeoff_parts.h"
#include "fit/fit.h"
#include "geometry/angles.h"
#include "synthetic/simulate.h"

namespace goniofit::tradeoff {

namespace {

struct TierSet {
  std::string name;
  Terms terms;
};

// As published, each term made exact alone, all of them; and what is lost without the terms that are easily left out.
std::vector<TierSet> tier_sets(const Material& m, const Terms& exact) {
  const Terms published = published_terms(m);
  std::vector<TierSet> sets{{"li-torrance", published}};
  const auto add = [&](const std::string& name, const auto& change) {
    Terms t = published;
    change(t);
    if (t != published) sets.push_back({name, t});
  };
  add("li-torrance, exact Fresnel", [&](Terms& t) { t.fresnel = exact.fresnel; });
  add("li-torrance, Smith shadowing", [&](Terms& t) { t.shadowing = exact.shadowing; });
  add("li-torrance, He's sigma_e", [&](Terms& t) { t.effective_roughness = exact.effective_roughness; });
  add("li-torrance, He's distribution", [&](Terms& t) { t.distribution = exact.distribution; });
  add("li-torrance, Schlick's shadowing", [](Terms& t) { t.shadowing = ShadowingTier::schlick; });
  add("without shadowing and sigma_e", [](Terms& t) {
    t.shadowing = ShadowingTier::none;
    t.effective_roughness = EffectiveRoughnessTier::none;
  });
  sets.push_back({exact.distribution == DistributionTier::he_torrance ? "he-torrance" : "exact terms", exact});
  return sets;
}

// The paper's sampling: its 441 directions, and the mirror directions for coh alone, whose only readings they are.
// (Towards grazing He's lobe narrows to a spike there, which would outweigh all else.)
Scan scan_of(const Material& reference, std::uint64_t seed) {
  Scan scan = simulate(reference, Sampling::hemisphere, {}, seed);
  if (reference.components.has(Effect::coh)) return scan;
  Scan kept = scan;
  for (std::vector<double>* angles : {&kept.theta_i_deg, &kept.phi_i_deg, &kept.theta_r_deg, &kept.phi_r_deg}) {
    angles->clear();
  }
  for (ScanChannel& c : kept.channels) c.values.clear();
  for (std::size_t row = 0; row < scan.size(); ++row) {
    const AnglePair a = scan.angles(row);
    if (a.theta_r_deg == a.theta_i_deg && std::fabs(wrap_deg(a.phi_r_deg - a.phi_i_deg)) == 180.0) continue;
    kept.theta_i_deg.push_back(a.theta_i_deg);
    kept.phi_i_deg.push_back(a.phi_i_deg);
    kept.theta_r_deg.push_back(a.theta_r_deg);
    kept.phi_r_deg.push_back(a.phi_r_deg);
    for (std::size_t c = 0; c < kept.channels.size(); ++c)
      kept.channels[c].values.push_back(scan.channels[c].values[row]);
  }
  return kept;
}

FitSettings settings_for(const Material& m, const Terms& terms) {
  FitSettings settings;
  settings.components = acting_effects(m);
  settings.terms = terms;
  settings.forms = m.forms;
  settings.anisotropic = m.surface.anisotropic();
  // sigma and tau part through wave optics and coh alone; where they are known they are not what is asked.
  if (m.surface.sigma_um) settings.parameters["sigma_um"] = {m.surface.sigma_um, {}, {}};
  for (const MaterialChannel& c : m.channels) {
    if (c.f0) settings.f0.push_back(*c.f0);
  }
  return settings;
}

FitFigures figures_of(const FitResult& fit, const Timing& time, double truth) {
  FitFigures f{.ms = 1e-6 * time.median_ns, .loss = fit.loss, .converged = fit.converged};
  f.slope = fit.material.surface.slope.value_or(0.0);
  f.slope_error = std::fabs(f.slope - truth) / truth;
  return f;
}

}  // namespace

Rows fit_rows(const Material& material, const TradeoffSettings& s, const Note& note) {
  if (!acting_effects(material).has(Effect::dd)) return {};  // no lobe, no slope
  const Reference reference = reference_of(material, WaveOptics::fast);
  const Scan scan = scan_of(reference.material, s.seed);
  Table table{.group = TradeoffGroup::fit, .material = material.name, .reference = reference.name};
  std::vector<FitResult> fits;
  std::vector<TimedTask> tasks;
  for (const TierSet& set : tier_sets(material, reference.material.terms)) {
    note(material.name + ", fitting " + set.name);
    const FitSettings settings = settings_for(material, set.terms);
    fits.push_back(fit(scan, settings));
    EvaluationCandidate c{
        .name = set.name, .material = fits.back().material, .compile = {.instructions = s.instructions}};
    c.material.fit.reset();
    table.candidates.push_back(std::move(c));
    tasks.push_back({[&scan, settings] {
                       const FitResult again = fit(scan, settings);
                       keep(&again);
                     },
                     1.0});
  }
  const TimingSettings few{
      .rounds = s.timing.rounds < 5 ? std::size_t{1} : std::size_t{5}, .least_seconds = 0.0, .seed = s.seed};
  const std::vector<Timing> times = time_interleaved(tasks, 0, few);
  const EvaluationCandidate exact{.name = reference.name, .material = reference.material};
  Rows rows = measured(table, exact, error_samples(reference.material, {}, s.errors), s);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].fit = figures_of(fits[i], times[i], *material.surface.slope);
  }
  return rows;
}

}  // namespace goniofit::tradeoff
