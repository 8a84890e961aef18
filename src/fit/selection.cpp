#include "fit/selection.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <list>
#include <tuple>
#include <utility>

#include "fit/cross_validation.h"
#include "fit/model.h"
#include "fit/noise_model.h"
#include "fit/selection_candidate.h"
#include "fit/uncertainty.h"
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
constexpr double significant = 5.0;
// A set that leaves twice as much as the largest sets is none to choose, by the loss asked for or by the score of the
// readings where they are fitted against the best score where they are left out. Nor are the sets that it contains,
// which leave more.
constexpr double hopeless = 2.0;
constexpr double significant_chi2 = significant * significant;

// Whether dropping an effect loses what stands at five of its uncertainties in the fit as asked.
class Significance {
 public:
  explicit Significance(const Candidate& larger) : larger_(larger) {
    Problem& problem = *larger.problem;
    const auto n = static_cast<Eigen::Index>(problem.samples());
    std::vector<Eigen::VectorXd> emphasis;
    for (const ProblemChannel& c : problem.channels) emphasis.push_back(c.emphasis);
    problem.emphasise(std::vector<Eigen::VectorXd>(problem.channels.size(), Eigen::VectorXd::Ones(n)));
    u_ = uncertainties(problem, larger.asked, linearise(problem, larger.asked));
    problem.emphasise(std::move(emphasis));
  }
  [[nodiscard]] bool lost_in(const Candidate& smaller) const {
    const EffectSet own = larger_.row.components;
    const EffectSet rest = smaller.row.components;
    if (&smaller == &larger_ || !contains(own, rest)) return false;
    return std::any_of(all_effects.begin(), all_effects.end(), [&](Effect e) {
      if (!own.has(e) || rest.has(e)) return false;
      // coh has no coefficient of its own
      return e == Effect::coh ? smaller.row.chi2 - larger_.row.chi2 >= significant_chi2 : stands(e);
    });
  }

 private:
  [[nodiscard]] bool stands(Effect e) const {
    const std::vector<BasisCoefficient>& all = larger_.problem->basis->coefficients();
    const auto at = std::find_if(all.begin(), all.end(),
                                 [e](const BasisCoefficient& k) { return k.name == name_of(coefficient_of(e)); });
    const auto j = static_cast<std::size_t>(at - all.begin());
    for (std::size_t c = 0; c < u_.coefficients.size(); ++c) {
      if (larger_.asked.coefficients[c][static_cast<Eigen::Index>(j)] >= significant * u_.coefficients[c][j].u) {
        return true;
      }
    }
    return false;
  }
  const Candidate& larger_;
  Uncertainties u_;
};

class Selector {
 public:
  Selector(const Scan& scan, const FitSettings& settings)
      : scan_(scan), settings_(settings), sets_(sensible_components(scan, settings)) {
    // Supersets first: what they cannot describe, their parts cannot.
    std::stable_sort(sets_.begin(), sets_.end(), [](EffectSet a, EffectSet b) { return size_of(a) > size_of(b); });
  }
  [[nodiscard]] Selection run();

 private:
  Candidate* add(EffectSet set);
  [[nodiscard]] bool is_full(EffectSet set) const;
  void settle_coh();
  void fit_full_sets();
  void fit_the_others();
  void cross_validate(Candidate& c);
  [[nodiscard]] bool is_hopeless(const Candidate& c) const;
  [[nodiscard]] bool pays(const Candidate& c) const;
  void add_weights(double SelectionRow::*criterion, double SelectionRow::*weight);
  void add_differences(const Candidate& best);
  [[nodiscard]] const Candidate& best_score() const;
  [[nodiscard]] const Candidate& best_bic() const;
  [[nodiscard]] const Candidate& smallest_as_good(const Candidate& best) const;
  [[nodiscard]] std::string reason(const Candidate& chosen, const Candidate& best) const;

  const Scan& scan_;
  const FitSettings& settings_;
  std::vector<EffectSet> sets_;
  std::list<Candidate> fitted_;
  Noise noise_;
  Eigen::VectorXd variance_;
  AngleGroups groups_;
  double least_loss_ = std::numeric_limits<double>::infinity();  ///< as asked
  double best_score_ = std::numeric_limits<double>::infinity();  ///< of left-out readings
};

// Null where the set contradicts the settings, as bounds of sigma do without coh: then it is none of the sets. What
// contradicts a set that no other contains is the user's to know.
Candidate* Selector::add(EffectSet set) {
  for (Candidate& c : fitted_) {
    if (c.row.components == set) return &c;
  }
  try {
    fitted_.push_back(fit_candidate(scan_, settings_, set));
    least_loss_ = std::min(least_loss_, fitted_.back().row.loss);
    if (groups_.count() == 0) groups_ = angle_groups(*fitted_.back().problem);
  } catch (const Error&) {
    if (is_full(set)) throw;
    std::erase(sets_, set);
    return nullptr;
  }
  return &fitted_.back();
}

bool Selector::is_full(EffectSet set) const {
  return std::none_of(sets_.begin(), sets_.end(),
                      [set](EffectSet other) { return other != set && contains(other, set); });
}

struct NoiseModel {
  Noise noise;
  Eigen::VectorXd variance;
  double deviance = std::numeric_limits<double>::infinity();  ///< -2 ln likelihood, less a constant
};

// A fit by the bright readings alone leaves the dim ones with more than their noise, hence the rounds.
NoiseModel noise_of(Candidate& candidate) {
  NoiseModel own;
  for (int round = 0;; ++round) {
    const Prediction p = predict(candidate);
    own.noise = estimate_noise(p.f, p.residual);
    own.variance = (own.noise.additive * own.noise.additive + (own.noise.relative * p.f.array()).square()).matrix();
    if (round == 2) {
      own.deviance = (p.residual.array().square() / own.variance.array() + own.variance.array().log()).sum();
      return own;
    }
    fit_weighted(candidate, own.variance);
  }
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
  if (a->row.aicc < b->row.aicc || b->row.loss > hopeless * a->row.loss) return;
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
  noise_ = best.noise;
  variance_ = std::move(best.variance);
  for (Candidate& c : fitted_) fit_weighted(c, variance_);
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
    if (c != nullptr && fitted_.size() > before) fit_weighted(*c, variance_);
  }
}

void Selector::cross_validate(Candidate& c) {
  if (c.left_out.size() > 0) return;
  c.left_out = left_out_scores(*c.problem, c.weighted, groups_);
  c.row.cross_validated = c.left_out.sum() / static_cast<double>(variance_.size());
  best_score_ = std::min(best_score_, c.left_out.sum());
}

bool Selector::is_hopeless(const Candidate& c) const {
  return c.row.loss > hopeless * least_loss_ ||
         group_scores(*c.problem, c.weighted, groups_).sum() > hopeless * best_score_;
}

// Whether the effects that a set has beyond each set within it are worth their parameters at all.
bool Selector::pays(const Candidate& c) const {
  return std::none_of(fitted_.begin(), fitted_.end(), [&](const Candidate& other) {
    return &other != &c && contains(c.row.components, other.row.components) && other.row.aicc <= c.row.aicc;
  });
}

void Selector::add_weights(double SelectionRow::*criterion, double SelectionRow::*weight) {
  double least = std::numeric_limits<double>::infinity();
  for (const Candidate& c : fitted_) least = std::min(least, c.row.*criterion);
  double sum = 0.0;
  for (Candidate& c : fitted_) sum += c.row.*weight = std::exp(0.5 * (least - c.row.*criterion));
  for (Candidate& c : fitted_) c.row.*weight /= sum;
}

// Paired over the groups. The scores' difference is the sum of the groups' parts, each of them a draw.
void Selector::add_differences(const Candidate& best) {
  const auto n = static_cast<double>(variance_.size());
  const auto groups = static_cast<double>(groups_.count());
  for (Candidate& c : fitted_) {
    if (c.left_out.size() == 0) continue;
    const Eigen::ArrayXd d = (c.left_out - best.left_out) / n;
    c.row.difference = d.sum();
    c.row.difference_error = std::sqrt(groups / (groups - 1.0) * (d - d.mean()).square().sum());
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

// Not to be told from the best by what the scan says: the left-out readings, or what a set costs by the BIC.
bool as_good(const SelectionRow& row, const SelectionRow& best) {
  return row.difference && (*row.difference <= *row.difference_error || row.bic <= best.bic);
}

const Candidate& Selector::smallest_as_good(const Candidate& best) const {
  std::vector<const Candidate*> equals;
  for (const Candidate& c : fitted_) {
    if (as_good(c.row, best.row)) equals.push_back(&c);
  }
  std::vector<Significance> significances;
  for (const Candidate* c : equals) significances.emplace_back(*c);
  const Candidate* chosen = nullptr;
  for (const Candidate* c : equals) {
    const bool loses = std::any_of(significances.begin(), significances.end(),
                                   [c](const Significance& larger) { return larger.lost_in(*c); });
    if (!loses && (chosen == nullptr || simpler(c->row, chosen->row))) chosen = c;
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

Selection Selector::run() {
  settle_coh();
  fit_full_sets();
  if (!fitted_.empty()) fit_the_others();
  if (fitted_.empty()) throw usage_error("components auto: the parameters that are fixed leave no effect to fit");
  add_weights(&SelectionRow::aicc, &SelectionRow::aicc_weight);
  add_weights(&SelectionRow::bic, &SelectionRow::bic_weight);
  const bool angles = groups_.count() >= least_groups;
  for (Candidate& c : fitted_) {
    if (angles && pays(c) && !is_hopeless(c)) cross_validate(c);
  }
  const Candidate& best = angles ? best_score() : best_bic();
  if (angles) add_differences(best);
  const Candidate& chosen = angles ? smallest_as_good(best) : best;
  Selection selection;
  selection.noise = noise_;
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
  return selection;
}

}  // namespace

EffectSet Selection::chosen() const { return rows.front().components; }

Selection select_components(const Scan& scan, const FitSettings& settings) { return Selector(scan, settings).run(); }

}  // namespace goniofit
