#include "cost/planner.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "cost/plan_lines.h"
#include "cost/plan_search.h"
#include "cost/reference.h"
#include "support/error.h"
#include "support/text.h"

namespace goniofit {

namespace {

struct Feasible {
  PlanChoice choice;
  ModelError error;
};

// Of times that differ by less the plan with the smaller error is taken.
constexpr double even_time = 0.02;
// Measured again with all rounds: who may still be the fastest.
constexpr double finalist_time = 1.15;

std::vector<Feasible> within_tolerance(PlanSearch& search, double tolerance, bool bound_rms, std::size_t& searched) {
  std::vector<Feasible> feasible;
  const std::vector<PlanChoice> all = search.all();
  searched = all.size();
  for (const PlanChoice& choice : all) {
    const ModelError e = search.error(choice);
    if (e.worst_l1_bound <= tolerance && (!bound_rms || e.rms_relative <= tolerance)) feasible.push_back({choice, e});
  }
  return feasible;
}

// Of many only those that no other should be cheaper than need a clock; few are all timed, since a kernel may know
// better.
std::vector<Feasible> worth_timing(const std::vector<Feasible>& feasible) {
  constexpr std::size_t few = 48;
  if (feasible.size() <= few) return feasible;
  std::vector<Feasible> kept;
  for (const Feasible& f : feasible) {
    const bool beaten = std::any_of(feasible.begin(), feasible.end(), [&](const Feasible& g) {
      return !(g.choice == f.choice) && no_dearer(g.choice, f.choice) && (!no_dearer(f.choice, g.choice) || &g < &f);
    });
    if (!beaten) kept.push_back(f);
  }
  return kept;
}

class Clock {
 public:
  Clock(const PlanSettings& settings, const std::vector<std::size_t>& channels)
      : settings_(settings), channels_(channels), pairs_(random_pairs(settings.pairs, settings.seed)) {}

  // Times of all, ratios over the first.
  [[nodiscard]] std::vector<Timing> time(const std::vector<Material>& materials, std::size_t rounds) const {
    std::vector<TimedTask> tasks;
    for (const Material& m : materials) {
      EvaluationCandidate c{
          .name = {}, .material = m, .compile = settings_.compile, .arithmetic = settings_.arithmetic};
      c.material.channels.clear();
      for (const std::size_t i : channels_) c.material.channels.push_back(m.channels[i]);
      tasks.push_back(evaluation_task(c, pairs_));
    }
    TimingSettings timing = settings_.timing;
    timing.rounds = rounds;
    return time_interleaved(tasks, 0, timing);
  }

 private:
  const PlanSettings& settings_;
  std::vector<std::size_t> channels_;
  DirectionBatch pairs_;
};

Feasible usually_fastest(const std::vector<Feasible>& candidates) {
  return *std::min_element(candidates.begin(), candidates.end(), [](const Feasible& a, const Feasible& b) {
    const double ns_a = usual_ns(a.choice);
    const double ns_b = usual_ns(b.choice);
    return ns_a != ns_b ? ns_a < ns_b : a.error.worst_l1_bound < b.error.worst_l1_bound;
  });
}

Feasible fastest(PlanSearch& search, const Clock& clock, std::vector<Feasible> candidates, std::size_t rounds) {
  const auto timed = [&](std::size_t n) {
    std::vector<Material> materials;
    for (const Feasible& f : candidates) materials.push_back(search.material(f.choice));
    return clock.time(materials, n);
  };
  const auto least_of = [](const std::vector<Timing>& times) {
    return std::min_element(times.begin(), times.end(),
                            [](const Timing& a, const Timing& b) { return a.ratio < b.ratio; })
        ->ratio;
  };
  const auto keep_below = [&](const std::vector<Timing>& times, double factor) {
    const double limit = factor * least_of(times);
    std::vector<Feasible> kept;
    for (std::size_t i = 0; i < times.size(); ++i) {
      if (times[i].ratio <= limit) kept.push_back(std::move(candidates[i]));
    }
    candidates = std::move(kept);
  };
  keep_below(timed(std::max<std::size_t>(3, rounds / 3)), finalist_time);
  if (candidates.size() > 1) keep_below(timed(rounds), 1.0 + even_time);
  return *std::min_element(candidates.begin(), candidates.end(), [](const Feasible& a, const Feasible& b) {
    return a.error.worst_l1_bound < b.error.worst_l1_bound;
  });
}

// The plan, the material as given, the reference and each decision the other way, in one run.
void add_times(Plan& p, PlanSearch& search, const Clock& clock, const Material& given,
               std::vector<PlanAlternative> alternatives, std::size_t rounds) {
  std::vector<Material> materials{p.material, given, search.material(search.reference())};
  for (const PlanAlternative& a : alternatives) materials.push_back(search.material(a.other));
  const std::vector<Timing> times = clock.time(materials, rounds);
  p.ns = times[0].median_ns;
  p.ns_before = times[1].median_ns;
  p.ratio_before = times[1].ratio;
  p.ns_reference = times[2].median_ns;
  p.ratio_reference = times[2].ratio;
  for (std::size_t i = 0; i < alternatives.size(); ++i) {
    PlanLine line = std::move(alternatives[i].line);
    const double ratio = times[3 + i].ratio;
    line.saves = line.simplified ? 1.0 - 1.0 / ratio : 1.0 - ratio;
    p.lines.push_back(std::move(line));
  }
}

void check(const Material& material, double tolerance) {
  if (!(tolerance > 0.0 && tolerance < 1.0)) {
    throw usage_error("tolerance " + shortest(tolerance) + ": expected a number between 0 and 1");
  }
  validate(material, "");
  if (material.model == surface_model && acting_effects(material).empty()) {
    throw key_error(material.name, "/components", "none of the effects has a coefficient above 0, nothing to plan");
  }
}

Plan searched(const Material& material, const PlanSamples& samples, double tolerance, const PlanSettings& settings,
              const PlanProgress& progress) {
  const auto tell = [&](const char* what) {
    if (progress) progress(what);
  };
  Reference reference = reference_of(material, WaveOptics::fast);
  PlanSearch search(reference.material, material.terms, samples, settings);
  Plan p;
  p.tolerance = tolerance;
  p.reference = std::move(reference.name);
  tell("errors of all combinations");
  const std::vector<Feasible> feasible = within_tolerance(search, tolerance, settings.bound_rms, p.searched);
  if (feasible.empty()) {
    throw Error(ErrorKind::failed_result, "nothing stays within " + shortest(tolerance) + ": terms compiled to " +
                                              shortest(settings.compile.tolerance) + " are too coarse for it");
  }
  const std::vector<Feasible> candidates = worth_timing(feasible);
  p.within = feasible.size();
  p.timed = settings.by_the_clock ? candidates.size() : 0;
  tell("times of those within the tolerance");
  const Clock clock(settings, samples.channels);
  const Feasible chosen =
      settings.by_the_clock ? fastest(search, clock, candidates, settings.timing.rounds) : usually_fastest(candidates);
  p.material = search.material(chosen.choice);
  p.error = chosen.error;
  Material given = material;
  given.fit.reset();
  p.error_before = search.error(search.canonical({acting_effects(material), material.terms, material.forms.rough}));
  tell("what each decision changes and saves");
  add_times(p, search, clock, given, plan_alternatives(search, chosen.choice), settings.timing.rounds);
  return p;
}

}  // namespace

PlanSettings PlanSettings::quick() {
  PlanSettings s;
  s.errors = {.incidences = 17, .directions = 192};
  s.timing = {.rounds = 5, .least_seconds = 2e-5};
  s.pairs = 512;
  return s;
}

std::vector<std::size_t> channels_in(const Material& material, const Domain& domain) {
  constexpr double tolerance_um = 0.0005;
  std::vector<std::size_t> channels;
  for (const double wavelength : domain.wavelengths_um) {
    const std::size_t found = channels.size();
    for (std::size_t c = 0; c < material.channels.size(); ++c) {
      const std::optional<double>& of_channel = material.channels[c].wavelength_um;
      if (of_channel && std::fabs(*of_channel - wavelength) <= tolerance_um) channels.push_back(c);
    }
    if (channels.size() == found) {
      throw usage_error("wavelength " + shortest(wavelength) + " um: " + material.name + " has no channel of it");
    }
  }
  if (channels.empty()) {
    for (std::size_t c = 0; c < material.channels.size(); ++c) channels.push_back(c);
  }
  return channels;
}

ModelError error_within(const Material& reference, const Material& other, const Domain& domain,
                        const ErrorSettings& settings) {
  const ErrorSamples samples = error_samples(reference, domain, settings);
  const auto values = [&](const Material& m) { return model_values({.name = {}, .material = m}, samples); };
  return model_error(samples, values(reference), values(other), channels_in(reference, domain));
}

Plan plan(const Material& material, const Domain& domain, double tolerance, const PlanSettings& settings,
          const PlanProgress& progress) {
  check(material, tolerance);
  ErrorSettings errors = settings.errors;
  errors.seed = settings.seed;
  PlanSamples samples{.directions = error_samples(reference_of(material, WaveOptics::fast).material, domain, errors),
                      .error = {},
                      .channels = channels_in(material, domain)};
  samples.error = [&samples](const ModelValues& reference, const ModelValues& other) {
    return model_error(samples.directions, reference, other, samples.channels);
  };
  Plan p = searched(material, samples, tolerance, settings, progress);
  p.domain = domain;
  p.bound_rms = settings.bound_rms;
  return p;
}

Plan plan_on(const PlanSamples& samples, const Material& material, double tolerance, const PlanSettings& settings,
             const PlanProgress& progress) {
  check(material, tolerance);
  PlanSettings without_rms = settings;
  without_rms.bound_rms = false;
  return searched(material, samples, tolerance, without_rms, progress);
}

}  // namespace goniofit
