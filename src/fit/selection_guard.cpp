#include "fit/selection_guard.h"

#include <algorithm>
#include <utility>

#include "fit/model.h"
#include "fit/uncertainty.h"

namespace goniofit {

namespace {

constexpr double significant = 5.0;
constexpr double significant_chi2 = significant * significant;

// Whether a set describes all that another does: flat grooves are udf.
bool describes(EffectSet own, EffectSet rest) {
  if (own.has(Effect::rough)) rest.erase(Effect::udf);
  return contains(own, rest);
}

// Those of the fit as asked: the weights that the inverse-variance fit left in the problem are taken out meanwhile.
Uncertainties uncertainties_as_asked(const Candidate& candidate) {
  Problem& problem = *candidate.problem;
  const auto n = static_cast<Eigen::Index>(problem.samples());
  std::vector<Eigen::VectorXd> emphasis;
  for (const ProblemChannel& c : problem.channels) emphasis.push_back(c.emphasis);
  problem.emphasise(std::vector<Eigen::VectorXd>(problem.channels.size(), Eigen::VectorXd::Ones(n)));
  Uncertainties u = uncertainties(problem, candidate.asked, linearise(problem, candidate.asked));
  problem.emphasise(std::move(emphasis));
  return u;
}

}  // namespace

StandingEffects::StandingEffects(const Candidate& candidate) : candidate_(candidate) {
  const Uncertainties u = uncertainties_as_asked(candidate);
  const std::vector<BasisCoefficient>& all = candidate.problem->basis->coefficients();
  for (std::size_t c = 0; c < u.coefficients.size(); ++c) {
    EffectSet& own = stands_.emplace_back();
    for (const Effect e : all_effects) {
      if (e == Effect::coh || !candidate.row.components.has(e)) continue;
      const auto at = std::find_if(all.begin(), all.end(),
                                   [e](const BasisCoefficient& k) { return k.name == name_of(coefficient_of(e)); });
      const auto j = static_cast<std::size_t>(at - all.begin());
      const double k = candidate.asked.coefficients[c][static_cast<Eigen::Index>(j)];
      if (k > 0.0 && k >= significant * u.coefficients[c][j].u) own.insert(e);
    }
  }
}

bool StandingEffects::stands_anywhere(Effect effect) const {
  return std::any_of(stands_.begin(), stands_.end(), [effect](EffectSet s) { return s.has(effect); });
}

bool StandingEffects::refuse(const Candidate& other) const {
  const EffectSet own = candidate_.row.components;
  const EffectSet rest = other.row.components;
  const double gain = other.row.chi2 - candidate_.row.chi2;
  if (candidate_.row.aicc >= other.row.aicc) return false;
  // A lobe that may lie anywhere finds something to describe in noise alone.
  if (gain < significant_chi2 && describes(own, rest)) return false;
  return std::any_of(all_effects.begin(), all_effects.end(), [&](Effect e) {
    if (!own.has(e) || rest.has(e)) return false;
    return e == Effect::coh ? gain >= significant_chi2 : stands_anywhere(e);
  });
}

}  // namespace goniofit
