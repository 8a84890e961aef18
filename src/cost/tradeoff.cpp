#include "cost/tradeoff.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <span>
#include <utility>

#include "cost/machine.h"
#include "cost/pareto.h"
#include "cost/tradeoff_parts.h"
#include "peers/peers.h"
#include "support/error.h"
#include "support/named.h"
#include "support/text.h"

namespace goniofit {

namespace {

constexpr std::array group_names{Named<TradeoffGroup>{TradeoffGroup::model, "model"},
                                 Named<TradeoffGroup>{TradeoffGroup::fresnel, "fresnel"},
                                 Named<TradeoffGroup>{TradeoffGroup::shadowing, "shadowing"},
                                 Named<TradeoffGroup>{TradeoffGroup::effective_roughness, "effective_roughness"},
                                 Named<TradeoffGroup>{TradeoffGroup::distribution, "distribution"},
                                 Named<TradeoffGroup>{TradeoffGroup::oren_nayar, "oren-nayar"},
                                 Named<TradeoffGroup>{TradeoffGroup::effects, "effects"},
                                 Named<TradeoffGroup>{TradeoffGroup::fit, "fit"}};

TradeoffRow row_of(const tradeoff::Table& table, const EvaluationCandidate& c) {
  TradeoffRow row{.group = table.group,
                  .name = c.name,
                  .material = table.material,
                  .reference = table.reference,
                  .model = c.material.model,
                  .arithmetic = std::string(name_of(c.arithmetic)),
                  .tolerance = c.compile.tolerance,
                  .shadowing_shortcut = c.compile.shadowing_shortcut,
                  .note = c.note,
                  .ratio_to = table.candidates[table.baseline].name};
  if (c.material.model == surface_model) {
    row.terms = c.material.terms;
    row.effects = c.material.components;
  }
  return row;
}

// Slow candidates (the series, the integral over grooves) get fewer pairs, so that a measurement fits between two
// interruptions of a busy machine.
constexpr double longest_seconds = 0.002;
std::size_t affordable(const EvaluationCandidate& c, std::size_t pairs) {
  constexpr std::size_t tried = 32;
  const DirectionBatch few = random_pairs(tried, 0);
  const TimedTask task = evaluation_task(c, few);
  // The least of a few: one interruption must not pass for a slow candidate.
  const TimingSettings few_rounds{.rounds = 3, .least_seconds = 0.0};
  const double ns = time_interleaved(std::span(&task, 1), 0, few_rounds)[0].min_ns * task.evaluations / tried;
  return std::clamp(static_cast<std::size_t>(1e9 * longest_seconds / std::max(ns, 1e-3)), tried, pairs);
}

// Of each candidate its first channel alone, then all channels where they are wanted and affordable.
class Tasks {
 public:
  Tasks(const tradeoff::Table& table, const TradeoffSettings& settings) : all_channels_(table.candidates.size()) {
    std::vector<std::size_t> pairs;
    for (const EvaluationCandidate& c : table.candidates) {
      EvaluationCandidate one = c;
      one.material = first_channel_of(c.material);
      pairs.push_back(affordable(one, settings.pairs));
      add(one, pairs.back(), settings.seed);
    }
    for (std::size_t i = 0; i < table.candidates.size(); ++i) {
      const EvaluationCandidate& c = table.candidates[i];
      if (!table.all_channels || pairs[i] < settings.pairs || c.material.channels.size() == 1) continue;
      all_channels_[i] = tasks_.size();
      add(c, pairs[i], settings.seed);
    }
  }

  void time(const tradeoff::Table& table, const TradeoffSettings& settings, tradeoff::Rows& rows) const {
    const std::vector<Timing> timings = time_interleaved(tasks_, table.baseline, settings.timing);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      rows[i].time = timings[i];
      const auto channels = static_cast<double>(table.candidates[i].material.channels.size());
      if (all_channels_[i]) rows[i].ns_per_direction = channels * timings[*all_channels_[i]].median_ns;
      if (channels == 1.0) rows[i].ns_per_direction = timings[i].median_ns;
    }
  }

 private:
  void add(const EvaluationCandidate& c, std::size_t pairs, std::uint64_t seed) {
    batches_.push_back(std::make_unique<const DirectionBatch>(random_pairs(pairs, seed)));
    tasks_.push_back(evaluation_task(c, *batches_.back()));
  }

  std::vector<std::unique_ptr<const DirectionBatch>> batches_;
  std::vector<TimedTask> tasks_;
  std::vector<std::optional<std::size_t>> all_channels_;
};

void append(tradeoff::Rows& to, tradeoff::Rows rows) {
  to.insert(to.end(), std::make_move_iterator(rows.begin()), std::make_move_iterator(rows.end()));
}

tradeoff::Rows rows_of(TradeoffGroup group, const Material& m, const TradeoffSettings& s, const tradeoff::Note& note) {
  switch (group) {
    case TradeoffGroup::model:
      return tradeoff::model_rows(m, s, note);
    case TradeoffGroup::oren_nayar:
      return tradeoff::oren_nayar_rows(m, s);
    case TradeoffGroup::effects:
      return tradeoff::effect_rows(m, s);
    case TradeoffGroup::fit:
      return tradeoff::fit_rows(m, s, note);
    case TradeoffGroup::fresnel:
    case TradeoffGroup::shadowing:
    case TradeoffGroup::effective_roughness:
    case TradeoffGroup::distribution:
      break;
  }
  return tradeoff::term_rows(group, m, s);
}

}  // namespace

namespace tradeoff {

Rows timed(const Table& table, const TradeoffSettings& settings) {
  Rows rows;
  for (const EvaluationCandidate& c : table.candidates) rows.push_back(row_of(table, c));
  Tasks(table, settings).time(table, settings, rows);
  return rows;
}

Rows measured(const Table& table, const EvaluationCandidate& exact, const ErrorSamples& samples,
              const TradeoffSettings& settings) {
  Rows rows = timed(table, settings);
  const ModelValues reference = model_values(exact, samples);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].error = model_error(samples, reference, model_values(table.candidates[i], samples));
  }
  mark_pareto(rows);
  return rows;
}

void mark_pareto(Rows& rows) {
  std::vector<CostAndError> points;
  for (const TradeoffRow& row : rows) points.push_back({row.time.median_ns, row.error.l1});
  const std::vector<bool> front = pareto_front(points);
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].pareto = front[i];
}

}  // namespace tradeoff

std::string_view name_of(TradeoffGroup group) noexcept {
  return name_in(std::span<const Named<TradeoffGroup>>(group_names), group);
}

template <>
std::optional<TradeoffGroup> parse_name<TradeoffGroup>(std::string_view name) noexcept {
  return value_in(std::span<const Named<TradeoffGroup>>(group_names), name);
}
template <>
std::string names_of<TradeoffGroup>() {
  return names_in(std::span<const Named<TradeoffGroup>>(group_names));
}

std::string effects_text(EffectSet effects) {
  std::string text;
  for (const Effect e : all_effects) {
    if (effects.has(e)) text += (text.empty() ? "" : "+") + std::string(name_of(e));
  }
  return text;
}

TradeoffSettings TradeoffSettings::quick() {
  TradeoffSettings s;
  s.timing = {.rounds = 3, .least_seconds = 2e-5};
  s.errors = {.incidences = 5, .directions = 64};
  s.pairs = 512;
  return s;
}

Tradeoff measure_tradeoff(const std::vector<Material>& materials, const TradeoffSettings& settings,
                          const TradeoffProgress& progress) {
  Tradeoff t{.machine = machine_name(),
             .reference = {},
             .instructions = settings.instructions,
             .settings = settings,
             .rows = {}};
  for (const std::string& peer : settings.peers.value_or(std::vector<std::string>{})) {
    if (!make_peer(peer)) throw usage_error(in_quotes(peer) + " is no peer that `goniofit models` names");
  }
  std::vector<Material> valid;
  for (const Material& m : materials) {
    const Reference r = reference_of(m, WaveOptics::series);
    if (t.reference.find(r.name) == std::string::npos) t.reference += (t.reference.empty() ? "" : "; ") + r.name;
    valid.push_back(m);
    valid.back().fit.reset();
  }
  const std::size_t total = valid.size() * settings.groups.size();
  std::size_t done = 0;
  for (const TradeoffGroup group : settings.groups) {
    bool grooves_shown = false;  // materials without any share a demonstration
    for (const Material& m : valid) {
      if (group == TradeoffGroup::oren_nayar && !acting_effects(m).has(Effect::rough)) {
        if (std::exchange(grooves_shown, true)) continue;
      }
      const tradeoff::Note note = [&](const std::string& what) {
        if (progress) progress(std::string(name_of(group)) + ": " + what, done, total);
      };
      note(m.name);
      append(t.rows, rows_of(group, m, settings, note));
      ++done;
    }
  }
  return t;
}

}  // namespace goniofit
