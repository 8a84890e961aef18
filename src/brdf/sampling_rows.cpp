#include "brdf/sampling_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "brdf/lobe_width.h"
#include "geometry/pair.h"

namespace goniofit {

namespace {

constexpr std::size_t row_count = 48;

// Of a peer, whose widths have names and scales of their own: the widths tried reach from 0.003 to 0.6 in Beckmann's
// alpha.
constexpr double unknown_slope = 0.05;

double row_position(double cos_i) noexcept { return std::sqrt(cos_i) * static_cast<double>(row_count) - 0.5; }
double row_cosine(std::size_t row) noexcept {
  const double root = (static_cast<double>(row) + 0.5) / static_cast<double>(row_count);
  return root * root;
}

// cos theta_r times the mean over channels of f(pair, channel).
template <class F>
double mean_value(const Evaluator& evaluator, const Direction& l, const Direction& v, const F& f) noexcept {
  const Pair p = make_pair(l, v);
  double sum = 0.0;
  for (std::size_t c = 0; c < evaluator.channels(); ++c) sum += f(p, c);
  return sum * p.cos_r / static_cast<double>(evaluator.channels());
}

// That of one effect, as a function of l and v.
auto value_of(const Evaluator& evaluator, Effect effect) noexcept {
  return [&evaluator, effect](const Direction& l, const Direction& v) {
    return mean_value(evaluator, l, v, [&](const Pair& p, std::size_t c) { return evaluator.value(p, c, effect); });
  };
}

// That of the whole model: a peer has no effects.
double whole_value(const Evaluator& evaluator, const Direction& l, const Direction& v) noexcept {
  return mean_value(evaluator, l, v, [&](const Pair& p, std::size_t c) { return evaluator.value(p, c); });
}

bool is_peer(const Evaluator& evaluator) noexcept { return evaluator.material().model != surface_model; }

constexpr std::size_t cosine_points = 64;

// The part of a peer that the cosine samples: the median of its values over the hemisphere. Its lobes stand above.
double diffuse_level(const Evaluator& evaluator, double cos_i) noexcept {
  std::array<double, cosine_points> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto u = lobe_width::cube_point(i);
    const Direction v = CosineLobe::draw(u[0], u[1]);
    values[i] = whole_value(evaluator, lobe_width::light_at(cos_i, u[2]), v) / v.z;
  }
  constexpr std::size_t middle = cosine_points / 2;
  std::nth_element(values.begin(), values.begin() + middle, values.end());
  return values[middle];
}

lobe_width::Fit facet_fit(const Evaluator& evaluator, const NominalLobes& nominal, double cos_i) {
  const auto lobe = [&](const Direction&, double width) { return nominal.facets(width); };
  if (!is_peer(evaluator)) return lobe_width::best(cos_i, lobe, value_of(evaluator, Effect::dd));
  const double level = diffuse_level(evaluator, cos_i);
  return lobe_width::best(cos_i, lobe, [&](const Direction& l, const Direction& v) {
    return std::max(0.0, whole_value(evaluator, l, v) - level * v.z);
  });
}

lobe_width::Fit forward_fit(const Evaluator& evaluator, const NominalLobes& nominal, double cos_i) {
  const auto lobe = [&](const Direction& l, double width) { return nominal.forward(l, width); };
  return lobe_width::best(cos_i, lobe, value_of(evaluator, Effect::fs));
}

double cosine_albedo(const Evaluator& evaluator, Effect effect, double cos_i) noexcept {
  const auto value = value_of(evaluator, effect);
  double sum = 0.0;
  for (std::size_t i = 0; i < cosine_points; ++i) {
    const auto u = lobe_width::cube_point(i);
    const Direction v = CosineLobe::draw(u[0], u[1]);
    sum += value(lobe_width::light_at(cos_i, u[2]), v) / CosineLobe::density(v);
  }
  return sum / static_cast<double>(cosine_points);
}

// The cone is narrow: its middle stands for it.
double cone_albedo(const Evaluator& evaluator, const ConeLobe& cone, double cos_i) noexcept {
  const Direction l = lobe_width::light_at(cos_i, 0.0);
  return value_of(evaluator, Effect::coh)(l, mirrored(l)) * cone.solid_angle_sr;
}

// The kind of facets whose best lobes have the smaller relative second moments, over a few incidences.
FacetSlopes better_slopes(const Evaluator& evaluator, NominalLobes nominal) {
  const auto spread = [&](FacetSlopes slopes) {
    nominal.slopes = slopes;
    double sum = 0.0;
    for (const double cos_i : {0.1, 0.3, 0.6, 0.9}) {
      const lobe_width::Fit fit = facet_fit(evaluator, nominal, cos_i);
      if (fit.albedo > 0.0) sum += fit.second_moment / (fit.albedo * fit.albedo);
    }
    return sum;
  };
  using enum FacetSlopes;
  return spread(long_tailed) < spread(gaussian) ? long_tailed : gaussian;
}

// Albedos to shares. A material that reflects nothing, or beyond what doubles hold, is sampled as a diffuse one.
void normalise(EffectShares& share) noexcept {
  const double total = std::accumulate(share.begin(), share.end(), 0.0);
  if (!(total > 0.0) || !std::isfinite(total)) {
    share.fill(0.0);
    share[static_cast<std::size_t>(Effect::udf)] = 1.0;
    return;
  }
  for (double& s : share) s /= total;
}

// As dd above a udf.
SamplingRow measured_peer_row(const Evaluator& evaluator, const NominalLobes& nominal, double cos_i) {
  SamplingRow row;
  const lobe_width::Fit fit = facet_fit(evaluator, nominal, cos_i);
  row.log_facet_width = fit.log_width;
  row.share[static_cast<std::size_t>(Effect::dd)] = fit.albedo;
  row.share[static_cast<std::size_t>(Effect::udf)] = pi * diffuse_level(evaluator, cos_i);
  normalise(row.share);
  return row;
}

SamplingRow measured_row(const Evaluator& evaluator, const NominalLobes& nominal, double cos_i) {
  SamplingRow row;
  for (const Effect effect : all_effects) {
    if (!evaluator.material().components.has(effect)) continue;
    double& albedo = row.share[static_cast<std::size_t>(effect)];
    if (effect == Effect::coh) {
      albedo = cone_albedo(evaluator, nominal.cone, cos_i);
    } else if (effect == Effect::dd) {
      const lobe_width::Fit fit = facet_fit(evaluator, nominal, cos_i);
      row.log_facet_width = fit.log_width;
      albedo = fit.albedo;
    } else if (effect == Effect::fs) {
      const lobe_width::Fit fit = forward_fit(evaluator, nominal, cos_i);
      row.log_forward_width = fit.log_width;
      albedo = fit.albedo;
    } else {
      albedo = cosine_albedo(evaluator, effect, cos_i);
    }
  }
  normalise(row.share);
  return row;
}

}  // namespace

NominalLobes NominalLobes::of(const Evaluator& evaluator) {
  const Material& m = evaluator.material();
  NominalLobes lobes;
  lobes.cone = {m.solid_angle_sr};
  lobes.slope_x = m.surface.slope.value_or(unknown_slope);
  lobes.slope_y = m.surface.slope_y.value_or(lobes.slope_x);
  if (is_peer(evaluator) || m.components.has(Effect::dd)) lobes.slopes = better_slopes(evaluator, lobes);
  return lobes;
}

FacetLobe NominalLobes::facets(double width) const noexcept {
  return {slopes, 2.0 * slope_x * width, 2.0 * slope_y * width};
}

// exp(-tan²theta_f / (16 m²)), 1/m² of an anisotropic surface taken at the azimuth of l.
ForwardLobe NominalLobes::forward(const Direction& l, double width) const noexcept {
  const double sin2 = l.x * l.x + l.y * l.y;
  const double cos2_phi = sin2 > 0.0 ? l.x * l.x / sin2 : 1.0;
  return {4.0 * width / std::sqrt(cos2_phi / (slope_x * slope_x) + (1.0 - cos2_phi) / (slope_y * slope_y))};
}

SamplingRows::SamplingRows(const Evaluator& evaluator, const NominalLobes& nominal) {
  rows_.reserve(row_count);
  for (std::size_t row = 0; row < row_count; ++row) {
    const auto measured = is_peer(evaluator) ? measured_peer_row : measured_row;
    rows_.push_back(measured(evaluator, nominal, row_cosine(row)));
  }
}

SamplingRow SamplingRows::at(double cos_i) const noexcept {
  const double position = std::clamp(row_position(cos_i), 0.0, static_cast<double>(row_count - 1));
  const std::size_t below = std::min(static_cast<std::size_t>(position), row_count - 2);
  const double t = position - static_cast<double>(below);
  const SamplingRow& a = rows_[below];
  const SamplingRow& b = rows_[below + 1];
  const auto between = [t](double x, double y) { return x + t * (y - x); };  // std::lerp has branches
  SamplingRow row;
  for (std::size_t e = 0; e < row.share.size(); ++e) row.share[e] = between(a.share[e], b.share[e]);
  row.log_facet_width = between(a.log_facet_width, b.log_facet_width);
  row.log_forward_width = between(a.log_forward_width, b.log_forward_width);
  return row;
}

}  // namespace goniofit
