#include "synthetic/selection_study.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "fit/selection.h"
#include "support/error.h"
#include "synthetic/parallel.h"
#include "synthetic/random.h"
#include "synthetic/simulate.h"

namespace goniofit {
namespace {

constexpr Noise noise{0.02, 0.0};
constexpr double standing = 5.0;
constexpr std::size_t most_draws = 100;
constexpr double least_right = 0.95;

struct Truth {
  bool metal = false;
  EffectSet components;
};

MaterialChannel channel(const char* name, double wavelength_um, double n, double kappa) {
  MaterialChannel c;
  c.name = name;
  c.wavelength_um = wavelength_um;
  c.n = n;
  c.kappa = kappa;
  return c;
}

// A dielectric's n is that of paints and glasses, a metal's is about aluminium's.
Material random_material(const Truth& truth, std::uint64_t key) {
  RandomStream random(subkey(key, "material"));
  Material m;
  m.name = truth.metal ? "metal" : "dielectric";
  m.components = truth.components;
  const double dielectric_n = random.uniform(1.35, 1.9);
  const bool three = random.uniform() < 0.5;
  for (const auto& [name, wavelength_um] : {std::pair{"G", 0.55}, {"R", 0.65}, {"B", 0.45}}) {
    const double n = truth.metal ? random.uniform(0.6, 1.5) : dielectric_n;
    MaterialChannel c = channel(name, wavelength_um, n, truth.metal ? random.uniform(5.4, 7.8) : 0.0);
    for (const Effect e : all_effects) {
      // logarithmic: weak effects beside strong ones are the hard ones
      const double k = random.log_uniform(0.02, 0.95);
      if (truth.components.has(e) && e != Effect::coh) c.coefficient(coefficient_of(e)) = e == Effect::fs ? 2.0 * k : k;
    }
    if (three || m.channels.empty()) m.channels.push_back(std::move(c));
  }
  const double slope = random.log_uniform(0.015, 0.45);
  const double sigma = random.log_uniform(0.02, 0.25);
  const double facets = random.log_uniform(5.0, 45.0);
  if (m.components.has(Effect::dd)) m.surface.slope = slope;
  if (m.components.has(Effect::coh)) {
    m.surface.sigma_um = sigma;
    m.surface.tau_um = sigma / slope;
  }
  if (m.components.has(Effect::rough)) m.surface.facet_slope_deg = facets;
  return m;
}

std::string describe(const Material& m, Sampling sampling) {
  std::string text = fmt::format("{}, {}", m.name, sampling == Sampling::hemisphere ? "hemisphere" : "incidence-plane");
  for (const auto& [name, value] : {std::pair{"slope", m.surface.slope},
                                    {"sigma_um", m.surface.sigma_um},
                                    {"facet_slope_deg", m.surface.facet_slope_deg}}) {
    if (value) text += fmt::format(", {} {:.4g}", name, *value);
  }
  for (const MaterialChannel& c : m.channels) {
    text += fmt::format("; {}", c.name);
    for (const Coefficient k : all_coefficients) {
      if (c.coefficient(k)) text += fmt::format(" {} {:.4g}", name_of(k), *c.coefficient(k));
    }
  }
  return text;
}

bool stands(const FitResult& fit, std::string_view name) {
  return std::any_of(fit.parameters.begin(), fit.parameters.end(), [name](const FittedParameter& p) {
    return p.name == name && p.value && p.u && *p.value >= standing * *p.u;
  });
}

bool stands(const FitResult& fit, Effect e) {
  if (e == Effect::coh) return stands(fit, "sigma_um");
  if (e == Effect::rough && !stands(fit, "facet_slope_deg")) return false;
  return stands(fit, name_of(coefficient_of(e)));
}

bool all_stand(const Scan& scan, EffectSet components) {
  FitSettings settings;
  settings.components = components;
  const FitResult result = fit(scan, settings);
  return std::all_of(all_effects.begin(), all_effects.end(),
                     [&](Effect e) { return !components.has(e) || stands(result, e); });
}

std::optional<double> score_difference(const Selection& selection, EffectSet truth) {
  const auto at = std::find_if(selection.rows.begin(), selection.rows.end(),
                               [truth](const SelectionRow& row) { return row.components == truth; });
  if (at == selection.rows.end() || !at->cross_validated || !selection.rows.front().cross_validated)
    return std::nullopt;
  return *at->cross_validated - *selection.rows.front().cross_validated;
}

SelectionTrial run_trial(const Truth& truth, Sampling sampling, std::uint64_t key) {
  for (std::size_t draw = 0; draw < most_draws; ++draw) {
    const Material material = random_material(truth, subkey(key, draw));
    const Scan scan = simulate(material, sampling, noise, subkey(subkey(key, draw), "noise"));
    if (!all_stand(scan, truth.components)) continue;
    const Selection selection = select_components(scan, {});
    return {truth.components, selection.chosen(), draw + 1, describe(material, sampling),
            score_difference(selection, truth.components)};
  }
  throw Error(ErrorKind::failed_result,
              "selection: no random material of a set has effects that all stand at five uncertainties");
}

// As the program itself makes them, from a scan that has all that an effect may need.
std::vector<Truth> truths() {
  std::vector<Truth> all;
  for (const bool metal : {false, true}) {
    const Truth richest{metal, {Effect::coh, Effect::dd}};
    const Scan scan = simulate(random_material(richest, 1), Sampling::hemisphere, noise, 1);
    for (const EffectSet set : sensible_components(scan, {})) all.push_back({metal, set});
  }
  return all;
}

}  // namespace

bool SelectionTrial::left_out() const noexcept {
  return std::any_of(all_effects.begin(), all_effects.end(),
                     [this](Effect e) { return truth.has(e) && !chosen.has(e); });
}

std::size_t SelectionStudy::right() const noexcept {
  return static_cast<std::size_t>(
      std::count_if(trials.begin(), trials.end(), [](const SelectionTrial& t) { return t.right(); }));
}

std::size_t SelectionStudy::left_out() const noexcept {
  return static_cast<std::size_t>(
      std::count_if(trials.begin(), trials.end(), [](const SelectionTrial& t) { return t.left_out(); }));
}

bool SelectionStudy::passed() const noexcept {
  return left_out() == 0 && static_cast<double>(right()) >= least_right * static_cast<double>(trials.size());
}

SelectionStudy verify_selection(std::size_t scans, std::uint64_t seed, const Progress& progress) {
  const std::vector<Truth> all = truths();
  SelectionStudy study;
  study.sets = std::min(scans, all.size());
  study.trials.resize(scans);
  const auto task = [&](std::size_t i) {
    // Each set meets both samplings.
    const Sampling sampling = (i + i / all.size()) % 2 == 0 ? Sampling::hemisphere : Sampling::incidence_plane;
    study.trials[i] = run_trial(all[i % all.size()], sampling, subkey(seed, i));
  };
  parallel_for(scans, task, progress);
  return study;
}

}  // namespace goniofit
