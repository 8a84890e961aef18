#include "fit/selection_choice.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "fit/cross_validation.h"
#include "fit/selection_guard.h"
#include "fit/selection_noise.h"
#include "support/error.h"

namespace goniofit {

namespace {

std::size_t size_of(EffectSet set) {
  return static_cast<std::size_t>(
      std::count_if(all_effects.begin(), all_effects.end(), [set](Effect e) { return set.has(e); }));
}

EffectSet without(EffectSet set, Effect effect) {
  set.erase(effect);
  return set;
}

std::string text_of(EffectSet set) {
  std::string text;
  for (const Effect e : all_effects) {
    if (set.has(e)) text += (text.empty() ? "" : " + ") + std::string(name_of(e));
  }
  return text;
}

constexpr std::size_t least_groups = 4;
// A set that leaves twice as much as the largest sets is none to choose, by the loss asked for or by the score of the
// readings where they are fitted against the best score where they are left out. Nor are the sets that it contains,
// which leave more.
constexpr double hopeless = 2.0;

// All that a fit of noise-free readings leaves: none is better than another for leaving less.
double round_off(const Candidate& c) { return 1e-20 * c.problem->total; }

class Selector {
 public:
  Selector(const Scan& scan, const FitSettings& settings)
      : scan_(scan), settings_(settings), sets_(sensible_components(scan, settings)) {
    // Supersets first: what they cannot describe, their parts cannot.
    std::stable_sort(sets_.begin(), sets_.end(), [](EffectSet a, EffectSet b) { return size_of(a) > size_of(b); });
  }
  [[nodiscard]] Choice run();

 private:
  Candidate* add(EffectSet set);
  [[nodiscard]] const Candidate* smallest_around(EffectSet set) const;
  [[nodiscard]] bool is_full(EffectSet set) const;
  void weigh(Candidate& c);
  void settle_coh();
  void fit_full_sets();
  void fit_the_others();
  void cross_validate(Candidate& c);
  [[nodiscard]] bool is_hopeless(const Candidate& c) const;
  [[nodiscard]] bool pays(const Candidate& c) const;
  void add_differences(const Candidate& best);
  [[nodiscard]] const Candidate& best_score() const;
  [[nodiscard]] const Candidate& best_bic() const;
  [[nodiscard]] const Candidate& smallest_as_good(const Candidate& best) const;
  [[nodiscard]] std::string reason(const Candidate& chosen, const Candidate& best) const;

  const Scan& scan_;
  const FitSettings& settings_;
  std::vector<EffectSet> sets_;
  std::list<Candidate> fitted_;
  Selection selection_;
  Eigen::VectorXd variance_;
  AngleGroups groups_;
  double least_loss_ = std::numeric_limits<double>::infinity();  ///< as asked
  double least_bic_ = std::numeric_limits<double>::infinity();
  Eigen::VectorXd best_score_;  ///< of left-out readings, by group; empty at first
};

// Null where the set contradicts the settings, as bounds of sigma do without coh: then it is none of the sets. What
// contradicts a set that no other contains is the user's to know.
Candidate* Selector::add(EffectSet set) {
  for (Candidate& c : fitted_) {
    if (c.row.components == set) return &c;
  }
  try {
    fitted_.push_back(fit_candidate(scan_, settings_, set, smallest_around(set)));
    least_loss_ = std::min(least_loss_, fitted_.back().row.loss);
    if (groups_.count() == 0) groups_ = angle_groups(*fitted_.back().problem);
  } catch (const Error&) {
    if (is_full(set)) throw;
    std::erase(sets_, set);
    return nullptr;
  }
  return &fitted_.back();
}

const Candidate* Selector::smallest_around(EffectSet set) const {
  const Candidate* smallest = nullptr;
  for (const Candidate& c : fitted_) {
    if (!contains(c.row.components, set)) continue;
    const bool smaller = smallest == nullptr || size_of(c.row.components) < size_of(smallest->row.components);
    const bool better =
        !smaller && size_of(c.row.components) == size_of(smallest->row.components) && c.row.loss < smallest->row.loss;
    if (smaller || better) smallest = &c;
  }
  return smallest;
}

void Selector::weigh(Candidate& c) {
  fit_weighted(c, variance_);
  c.in_sample = group_scores(*c.problem, c.weighted, groups_);
  least_bic_ = std::min(least_bic_, c.row.bic);
}

bool Selector::is_full(EffectSet set) const {
  return std::none_of(sets_.begin(), sets_.end(),
                      [set](EffectSet other) { return other != set && contains(other, set); });
}

// coh doubles the sets. Where it does not pay in the largest, it is in none. A mirror peak that the loss asked for sees
// settles it: where grooves are missing from these sets, their inverse-variance fits may not.
void Selector::settle_coh() {
  const auto with = std::find_if(sets_.begin(), sets_.end(), [](EffectSet s) { return s.has(Effect::coh); });
  if (with == sets_.end()) return;
  const EffectSet larger = *with;
  const EffectSet smaller = without(larger, Effect::coh);
  if (std::find(sets_.begin(), sets_.end(), smaller) == sets_.end()) return;
  Candidate* const a = add(larger);
  Candidate* const b = add(smaller);
  if (a == nullptr || b == nullptr) return;
  const NoiseModel noise = noise_of(*a);
  fit_weighted(*a, noise.variance);
  fit_weighted(*b, noise.variance);
  if (a->row.aicc < b->row.aicc || b->row.loss > hopeless * std::max(a->row.loss, round_off(*a))) return;
  std::erase_if(sets_, [](EffectSet s) { return s.has(Effect::coh); });
}

// The sets that no other contains: grooves and light from below the surface exclude each other. The likeliest tells the
// noise.
void Selector::fit_full_sets() {
  NoiseModel best;
  std::vector<Candidate*> full;
  for (const EffectSet set : std::vector<EffectSet>(sets_)) {
    Candidate* const c = is_full(set) ? add(set) : nullptr;
    if (c == nullptr) continue;
    full.push_back(c);
    if (NoiseModel own = noise_of(*c); own.deviance < best.deviance) best = std::move(own);
  }
  if (full.empty()) return;
  selection_.noise = best.noise;
  selection_.u_scale = best.u_scale;
  variance_ = std::move(best.variance);
  for (Candidate& c : fitted_) weigh(c);
  if (groups_.count() < least_groups) return;
  std::stable_sort(full.begin(), full.end(),
                   [](const Candidate* a, const Candidate* b) { return a->row.chi2 < b->row.chi2; });
  for (Candidate* c : full) {
    if (!is_hopeless(*c)) cross_validate(*c);
  }
}

void Selector::fit_the_others() {
  for (const EffectSet set : std::vector<EffectSet>(sets_)) {
    const bool beaten = std::any_of(fitted_.begin(), fitted_.end(), [&](const Candidate& c) {
      return contains(c.row.components, set) && is_hopeless(c);
    });
    const std::size_t before = fitted_.size();
    if (beaten) continue;
    Candidate* const c = add(set);
    if (c != nullptr && fitted_.size() > before) weigh(*c);
  }
}

void Selector::cross_validate(Candidate& c) {
  if (c.left_out.size() > 0) return;
  c.left_out = left_out_scores(*c.problem, c.weighted, groups_);
  c.row.cross_validated = c.left_out.sum() / static_cast<double>(variance_.size());
  if (best_score_.size() == 0 || c.left_out.sum() < best_score_.sum()) best_score_ = c.left_out;
}

// Where a set scores worse with all readings in its fit than the best does with them left out, beyond two standard
// errors, it predicts worse than the best; where its chi² alone passes the least BIC, no set within it has a BIC as
// small.
bool Selector::is_hopeless(const Candidate& c) const {
  if (c.row.loss > hopeless * std::max(least_loss_, round_off(c))) return true;
  if (best_score_.size() == 0) return false;
  if (c.in_sample.sum() > hopeless * best_score_.sum()) return true;
  const Eigen::VectorXd d = c.in_sample - best_score_;
  return d.sum() > 2.0 * paired_error(d) && c.row.chi2 > least_bic_;
}

// Whether the effects that a set has beyond each set within it are worth their parameters at all.
bool Selector::pays(const Candidate& c) const {
  return std::none_of(fitted_.begin(), fitted_.end(), [&](const Candidate& other) {
    return &other != &c && contains(c.row.components, other.row.components) && other.row.aicc <= c.row.aicc;
  });
}

// Paired over the groups. The scores' difference is the sum of the groups' parts, each of them a draw.
void Selector::add_differences(const Candidate& best) {
  for (Candidate& c : fitted_) {
    if (c.left_out.size() == 0) continue;
    const Eigen::VectorXd d = (c.left_out - best.left_out) / static_cast<double>(variance_.size());
    c.row.difference = d.sum();
    c.row.difference_error = paired_error(d);
  }
}

const Candidate& Selector::best_score() const {
  const Candidate* best = nullptr;
  for (const Candidate& c : fitted_) {
    if (!c.row.cross_validated) continue;
    if (best == nullptr || *c.row.cross_validated < *best->row.cross_validated) best = &c;
  }
  return *best;
}

const Candidate& Selector::best_bic() const {
  return *std::min_element(fitted_.begin(), fitted_.end(),
                           [](const Candidate& a, const Candidate& b) { return a.row.bic < b.row.bic; });
}

// By effects, grooves counting for two: they have an albedo and a slope. What is on a bound in this scan need not be so
// in the next, so the parameters that are free come second.
bool simpler(const SelectionRow& a, const SelectionRow& b) {
  const auto key = [](const SelectionRow& r) {
    const std::size_t effects = size_of(r.components) + (r.components.has(Effect::rough) ? 1 : 0);
    return std::tuple(effects, r.free_parameters, *r.cross_validated);
  };
  return key(a) < key(b);
}

// A set that all others refuse nothing of is among those predicted: the one of the least AICc.
const Candidate& Selector::smallest_as_good(const Candidate& best) const {
  std::vector<StandingEffects> all;
  for (const Candidate& c : fitted_) {
    if (c.row.difference) all.emplace_back(c);
  }
  std::vector<const Candidate*> sound;
  for (const Candidate& c : fitted_) {
    const bool refused =
        std::any_of(all.begin(), all.end(), [&](const StandingEffects& other) { return other.refuse(c); });
    if (c.row.difference && !refused) sound.push_back(&c);
  }
  const bool any =
      std::any_of(sound.begin(), sound.end(), [&](const Candidate* c) { return as_good(c->row, best.row); });
  const Candidate* chosen = nullptr;
  for (const Candidate* c : sound) {
    if (any && !as_good(c->row, best.row)) continue;
    if (chosen == nullptr || simpler(c->row, chosen->row)) chosen = c;
  }
  return *chosen;
}

std::string Selector::reason(const Candidate& chosen, const Candidate& best) const {
  const std::string what = "components auto: " + text_of(chosen.row.components);
  if (groups_.count() < least_groups) {
    return what +
           ", which has the least BIC; with fewer than four incidence angles none can be left out to be predicted";
  }
  const std::string left_out =
      " the readings of " + std::to_string(groups_.count()) + " groups of incidence angles left out in turn";
  if (&chosen == &best)
    return what + ", which predicts best" + left_out + "; no smaller set does as well within one standard error";
  return what + ", the smallest set that predicts" + left_out + " as well within one standard error as the best, " +
         text_of(best.row.components);
}

Choice Selector::run() {
  settle_coh();
  fit_full_sets();
  if (!fitted_.empty()) fit_the_others();
  if (fitted_.empty()) throw usage_error("components auto: the parameters that are fixed leave no effect to fit");
  std::vector<SelectionRow*> rows;
  for (Candidate& c : fitted_) rows.push_back(&c.row);
  add_weights(rows);
  const bool angles = groups_.count() >= least_groups;
  for (Candidate& c : fitted_) {
    if (angles && pays(c) && !is_hopeless(c)) cross_validate(c);
  }
  const Candidate& best = angles ? best_score() : best_bic();
  if (angles) add_differences(best);
  const Candidate& chosen = angles ? smallest_as_good(best) : best;
  Selection& selection = selection_;
  selection.groups = angles ? groups_.count() : 0;
  selection.reason = reason(chosen, best);
  for (const EffectSet set : sets_) {
    if (std::none_of(fitted_.begin(), fitted_.end(), [&](const Candidate& c) { return c.row.components == set; })) {
      selection.not_fitted.push_back(set);
    }
  }
  for (const Candidate& c : fitted_) {
    selection.rows.push_back(c.row);
    selection.rows.back().chosen = &c == &chosen;
  }
  std::stable_sort(selection.rows.begin(), selection.rows.end(), [](const SelectionRow& a, const SelectionRow& b) {
    const auto key = [](const SelectionRow& r) {
      return std::tuple(!r.chosen, !r.cross_validated, r.cross_validated.value_or(0.0), r.bic);
    };
    return key(a) < key(b);
  });
  return {std::move(selection_), std::move(fitted_)};
}

}  // namespace

Choice choose_components(const Scan& scan, const FitSettings& settings) { return Selector(scan, settings).run(); }

}  // namespace goniofit
