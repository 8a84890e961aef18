#include "brdf/evaluator.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "brdf/optics.h"
#include "brdf/shape_kernels.h"

namespace goniofit {

namespace {

double coefficient_or_zero(const MaterialChannel& channel, Coefficient c) noexcept {
  return channel.coefficient(c).value_or(0.0);
}

// The three effects that read the surface; slope is there because validate() asks for it.
double surface_shape(const Material& m, const MaterialChannel& channel, const Pair& p, Effect effect) noexcept {
  const double log_slope = std::log(*m.surface.slope);
  double result = 0.0;
  with_tiers(ShapeSettings::of(m.terms, m.fs_form), [&]<ShadowingTier shadowing, EffectiveRoughnessTier roughness>() {
    const SurfaceTerms<double> t = surface_terms<shadowing, roughness>(log_slope, 1.0 / *m.surface.slope, p);
    if (effect == Effect::coh) {
      result = coh_shape(t, log_slope, std::log(*m.surface.sigma_um), *channel.wavelength_um, m.solid_angle_sr, p);
    } else if (effect == Effect::dd) {
      result = dd_shape(t, p);
    } else {
      result = m.fs_form == FsForm::printed ? fs_shape<FsForm::printed>(t, p) : fs_shape<FsForm::reciprocal>(t, p);
    }
  });
  return result;
}

double shape(const Material& m, const MaterialChannel& channel, const Pair& p, Effect effect) noexcept {
  switch (effect) {
    case Effect::udf:
    case Effect::uds:
      return 1.0 / pi;
    case Effect::coh:
      return in_mirror_cone(p, m.solid_angle_sr) ? surface_shape(m, channel, p, effect) : 0.0;
    case Effect::fs:
      return p.forward ? surface_shape(m, channel, p, effect) : 0.0;
    case Effect::dd:
      return surface_shape(m, channel, p, effect);
  }
  return 0.0;
}

}  // namespace

Evaluator::Evaluator(Material material) : material_(std::move(material)) {
  validate(material_, material_.name.empty() ? "material" : material_.name);
}

double Evaluator::value(const Pair& pair, std::size_t channel, Effect effect) const noexcept {
  if (!(pair.cos_i > 0.0) || !(pair.cos_r > 0.0) || !material_.components.has(effect)) return 0.0;
  const MaterialChannel& c = material_.channels[channel];
  const Coefficient coefficient = coefficient_of(effect);
  const double k = coefficient_or_zero(c, coefficient);
  if (k == 0.0) return 0.0;
  const ChannelOptics optics = ChannelOptics::of(c);
  const double factor = optics_factor(optics_factor_of(coefficient), material_.terms.fresnel, optics, pair);
  return std::min(k * factor * shape(material_, c, pair, effect), saturation);
}

double Evaluator::value(const Pair& pair, std::size_t channel) const noexcept {
  double sum = 0.0;
  for (const Effect effect : all_effects) sum += value(pair, channel, effect);
  return std::min(sum, saturation);
}

std::vector<double> Evaluator::values(const PairBatch& pairs) const {
  std::vector<double> result;
  result.reserve(pairs.size() * channels());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Pair p = pairs[i];
    for (std::size_t c = 0; c < channels(); ++c) result.push_back(value(p, c));
  }
  return result;
}

}  // namespace goniofit
