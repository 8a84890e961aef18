#include "brdf/sampler.h"

#include <cmath>

#include "brdf/lobe_width.h"

namespace goniofit {

namespace {

using lobe_width::defensive_share;

constexpr double share_of(const EffectShares& share, Effect e) noexcept { return share[static_cast<std::size_t>(e)]; }

struct Choice {
  Effect effect;
  double rest;  // uniform in [0, 1) again
};

// By the sum of shares that u falls into; rounding at the end falls to the last effect that has a share.
Choice choose(const EffectShares& share, double u) noexcept {
  Choice choice{Effect::udf, 0.0};
  for (const Effect e : all_effects) {
    const double s = share_of(share, e);
    if (s <= 0.0) continue;
    choice = {e, u / s};
    if (u < s) break;
    u -= s;
  }
  return choice;
}

}  // namespace

Sampler::Sampler(const Evaluator& evaluator) : nominal_(NominalLobes::of(evaluator)), rows_(evaluator, nominal_) {}

Sampler::Mixture Sampler::mixture(const Direction& l) const noexcept {
  const SamplingRow row = rows_.at(l.z);
  Mixture m{row.share, nominal_.cone, {}, {}};  // what has no share is not asked
  if (share_of(row.share, Effect::dd) > 0.0) m.facets = nominal_.facets(std::exp(row.log_facet_width));
  if (share_of(row.share, Effect::fs) > 0.0) m.forward = nominal_.forward(l, std::exp(row.log_forward_width));
  return m;
}

double Sampler::density(const Mixture& m, const Direction& l, const Direction& v) noexcept {
  if (v.z <= 0.0) return 0.0;
  const double cone = share_of(m.share, Effect::coh);
  const double facets = (1.0 - defensive_share) * share_of(m.share, Effect::dd);
  const double forward = (1.0 - defensive_share) * share_of(m.share, Effect::fs);
  double sum = (1.0 - cone - facets - forward) * CosineLobe::density(v);
  if (cone > 0.0) sum += cone * m.cone.density(l, v);
  if (facets > 0.0) sum += facets * m.facets.density(l, v);
  if (forward > 0.0) sum += forward * m.forward.density(l, v);
  return sum;
}

std::optional<DirectionSample> Sampler::sample(const Direction& l, const std::array<double, 3>& u) const noexcept {
  if (l.z <= 0.0) return std::nullopt;
  const Mixture m = mixture(l);
  const Choice choice = choose(m.share, u[0]);
  const bool lobed = choice.rest >= defensive_share;
  Direction v;
  if (choice.effect == Effect::coh) {
    v = m.cone.draw(l, u[1], u[2]);
  } else if (choice.effect == Effect::dd && lobed) {
    v = m.facets.draw(l, u[1], u[2]);
  } else if (choice.effect == Effect::fs && lobed) {
    v = m.forward.draw(l, u[1], u[2]);
  } else {
    v = CosineLobe::draw(u[1], u[2]);
  }
  const double pdf = density(m, l, v);
  if (!(pdf > 0.0)) return std::nullopt;
  return DirectionSample{v, pdf, choice.effect};
}

Effect Sampler::chosen(const Direction& l, double u) const noexcept {
  return l.z > 0.0 ? choose(rows_.at(l.z).share, u).effect : Effect::udf;
}

double Sampler::pdf(const Direction& l, const Direction& v) const noexcept {
  return l.z > 0.0 && v.z > 0.0 ? density(mixture(l), l, v) : 0.0;
}

}  // namespace goniofit
