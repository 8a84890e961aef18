#include "render/material_shader.h"

#include <algorithm>

namespace goniofit {

namespace {

// The mean weight of the model's own samples at three incidences, of the brightest channel: Monte Carlo of the albedo.
// Exactness is no matter, that it is the same at every run is.
double mean_albedo(const Evaluator& evaluator, const Sampler& sampler) {
  constexpr std::size_t draws = 32;
  constexpr std::array incidences{10.0, 40.0, 65.0};
  std::vector<double> sums(evaluator.channels(), 0.0);
  for (const double theta : incidences) {
    const Direction l = direction_of(theta, 0.0);
    for (std::size_t i = 0; i < draws; ++i) {
      const double u = (static_cast<double>(i) + 0.5) / draws;
      const double rotated = u * 0.6180339887498949 * draws;
      const auto drawn = sampler.sample(l, {u, rotated - std::floor(rotated), std::fmod(7.0 * u, 1.0)});
      if (!drawn) continue;
      const Pair pair = make_pair(l, drawn->direction);
      for (std::size_t c = 0; c < sums.size(); ++c) sums[c] += evaluator.value(pair, c) * pair.cos_r / drawn->pdf;
    }
  }
  return *std::max_element(sums.begin(), sums.end()) / static_cast<double>(draws * incidences.size());
}

}  // namespace

std::optional<Material> without_mirror(const Material& material) {
  Material rest = material;
  rest.components.erase(Effect::coh);
  if (rest.model == surface_model && rest.components.empty()) return std::nullopt;
  return rest;
}

MaterialShader::MaterialShader(const Material& given, const RenderMaterial& used)
    : used_(used.material),
      has_mirror_(used.material.components.has(Effect::coh)),
      branches_(given.components.has(Effect::coh) && without_mirror(given)),
      follows_(used.follows) {
  if (const auto lobes = without_mirror(used.material)) {
    if (used.single_precision) {
      lobes_ = Lobes{BatchEvaluator<float>(*lobes, used.compile)};
    } else {
      lobes_ = Lobes{BatchEvaluator<double>(*lobes, used.compile)};
    }
  }
  if (const auto lobes = without_mirror(given)) {
    const Evaluator evaluator(*lobes);
    sampler_.emplace(evaluator);
    survival_ = std::clamp(mean_albedo(evaluator, *sampler_), 0.05, 0.95);
  }
}

void MaterialShader::values(const DirectionBatch& directions, Scratch& scratch, std::vector<double>& result) const {
  result.resize(directions.size() * channels());
  if (const auto* in_double = std::get_if<BatchEvaluator<double>>(&lobes_->evaluator)) {
    in_double->values(directions, result);
    return;
  }
  const auto narrowed = [](const std::vector<double>& from, std::vector<float>& to) {
    to.resize(from.size());
    for (std::size_t i = 0; i < from.size(); ++i) to[i] = static_cast<float>(from[i]);
  };
  narrowed(directions.l_x, scratch.directions.l_x);
  narrowed(directions.l_y, scratch.directions.l_y);
  narrowed(directions.l_z, scratch.directions.l_z);
  narrowed(directions.v_x, scratch.directions.v_x);
  narrowed(directions.v_y, scratch.directions.v_y);
  narrowed(directions.v_z, scratch.directions.v_z);
  scratch.values.resize(result.size());
  std::get<BatchEvaluator<float>>(lobes_->evaluator).values(scratch.directions, scratch.values);
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = static_cast<double>(scratch.values[i]);
}

std::optional<DirectionSample> MaterialShader::draw(const Direction& v, const std::array<double, 3>& u) const noexcept {
  return sampler_ ? sampler_->sample(v, u) : std::nullopt;
}

bool MaterialShader::draws_wide(const Direction& v, double u) const noexcept {
  if (!sampler_) return false;
  const Effect effect = sampler_->chosen(v, u);
  return effect != Effect::dd && effect != Effect::fs;
}

double MaterialShader::pdf(const Direction& l, const Direction& v) const noexcept {
  return sampler_ ? sampler_->pdf(v, l) : 0.0;
}

double MaterialShader::mirror_weight(const Direction& v, std::size_t channel) const noexcept {
  const Pair pair = make_pair(mirrored(v), v);
  return used_.value(pair, channel, Effect::coh) * pair.cos_i * used_.material().solid_angle_sr;
}

}  // namespace goniofit
