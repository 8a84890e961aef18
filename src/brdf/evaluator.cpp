#include "brdf/evaluator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "basis/optics.h"
#include "brdf/effects.h"
#include "brdf/rough_shape.h"
#include "brdf/surface_shape.h"
#include "peers/peers.h"

namespace goniofit {

namespace {

ChannelOptics optics_of(const MaterialChannel& channel) {
  if (channel.f0) return ChannelOptics::of_reflectance(*channel.f0);
  return ChannelOptics::of_index(channel.n.value_or(1.0), channel.kappa.value_or(0.0));
}

// What validate() found to be there where it is read; anything elsewhere.
SurfaceParameters<double> parameters_of(const Surface& s) {
  return {.log_slope = std::log(s.slope.value_or(1.0)),
          .log_slope_y = std::log(s.slope_y.value_or(1.0)),
          .tail = s.tail.value_or(2.0),
          .log_sigma = std::log(s.sigma_um.value_or(1.0))};
}

double surface_shape(const Material& m, const MaterialChannel& channel, const Pair& p, Effect effect) noexcept {
  const ShapeSettings settings = ShapeSettings::of(m.terms, m.forms, m.surface.anisotropic());
  const SurfaceParameters<double> s = parameters_of(m.surface);
  const double wavelength_um = channel.wavelength_um.value_or(1.0);
  const SurfaceTerms<double> t = surface_terms(settings, s, p);
  if (effect == Effect::coh) return coh_shape(s, t, wavelength_um, m.solid_angle_sr, p);
  return effect == Effect::dd ? dd_shape(settings, s, t, wavelength_um, p) : fs_shape(settings, s, t, p);
}

// Coefficient times shape factor.
double lit_shape(const Material& m, const MaterialChannel& channel, const Pair& p, Effect effect, double k) noexcept {
  switch (effect) {
    case Effect::udf:
    case Effect::uds:
      return k / pi;
    case Effect::coh:
      return in_mirror_cone(p, m.solid_angle_sr) ? k * surface_shape(m, channel, p, effect) : 0.0;
    case Effect::fs:
      return p.forward ? k * surface_shape(m, channel, p, effect) : 0.0;
    case Effect::dd:
      return k * surface_shape(m, channel, p, effect);
    case Effect::rough: {
      const RoughFactors<double> r = rough_factors(m.forms.rough, radians(*m.surface.facet_slope_deg), p);
      return k / pi * (r.direct + k * r.interreflection);
    }
  }
  return 0.0;
}

}  // namespace

Evaluator::Evaluator(Material material) : material_(std::move(material)) {
  validate(material_, material_.name.empty() ? "material" : material_.name);
  if (material_.model == surface_model) return;
  peer_ = make_peer(material_.model, material_.solid_angle_sr);
  for (const ShapeParameter& p : peer_->shape_parameters()) {
    const auto found = material_.parameters.find(p.name);
    const bool known = found != material_.parameters.end() && found->second;  // else nothing reads it
    peer_shape_.push_back(std::log((known ? *found->second : p.lower) - p.origin));
  }
}

double Evaluator::value(const Pair& pair, std::size_t channel, Effect effect) const noexcept {
  if (!(pair.cos_i > 0.0) || !(pair.cos_r > 0.0) || !material_.components.has(effect)) return 0.0;
  const MaterialChannel& c = material_.channels[channel];
  const Coefficient coefficient = coefficient_of(effect);
  const double k = c.coefficient(coefficient).value_or(0.0);
  if (k == 0.0) return 0.0;
  const double factor = optics_factor(optics_factor_of(coefficient), material_.terms.fresnel, optics_of(c), pair);
  if (factor == 0.0) return 0.0;  // n = 1: nothing reflects, though a lobe beyond the doubles is infinite here
  return std::min(factor * lit_shape(material_, c, pair, effect, k), saturation);
}

double Evaluator::peer_value(const Pair& pair, const MaterialChannel& channel) const noexcept {
  std::array<double, most_columns> factors{};
  peer_->shape_factors(pair, peer_shape_, channel.wavelength_um.value_or(1.0), factors);
  double sum = 0.0;
  for (std::size_t j = 0; j < peer_->columns().size(); ++j) {
    const BasisColumn& column = peer_->columns()[j];
    const BasisCoefficient& coefficient = peer_->coefficients()[column.coefficient];
    const double k = coefficient.constant() ? coefficient.lower : channel.coefficient(coefficient.name).value_or(0.0);
    if (k == 0.0) continue;
    const double optics = optics_factor(column.optics, material_.terms.fresnel, optics_of(channel), pair);
    sum += (column.power == 2 ? k * k : k) * optics * factors[j];
  }
  return std::min(sum, saturation);
}

double Evaluator::value(const Pair& pair, std::size_t channel) const noexcept {
  if (peer_) {
    if (!(pair.cos_i > 0.0) || !(pair.cos_r > 0.0)) return 0.0;
    return peer_value(pair, material_.channels[channel]);
  }
  double sum = 0.0;
  for (const Effect effect : all_effects) sum += value(pair, channel, effect);
  return std::min(sum, saturation);
}

bool Evaluator::cut_at_zero(const Pair& pair) const noexcept {
  if (!(pair.cos_i > 0.0) || !(pair.cos_r > 0.0) || !material_.components.has(Effect::rough)) return false;
  return material_.forms.rough == RoughForm::functional && material_.surface.facet_slope_deg &&
         functional_is_cut(radians(*material_.surface.facet_slope_deg), pair);
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
