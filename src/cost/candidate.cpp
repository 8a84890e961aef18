#include "cost/candidate.h"

#include <cmath>
#include <memory>
#include <utility>

#include "brdf/evaluator.h"
#include "cost/reference.h"
#include "geometry/angles.h"
#include "synthetic/random.h"

namespace goniofit {

namespace {

template <class Real>
BasicDirectionBatch<Real> rounded(const DirectionBatch& d) {
  const auto all = [](const std::vector<double>& x) { return std::vector<Real>(x.begin(), x.end()); };
  return {all(d.l_x), all(d.l_y), all(d.l_z), all(d.v_x), all(d.v_y), all(d.v_z)};
}

Pair pair_at(const DirectionBatch& d, std::size_t i) {
  return make_pair(Direction{d.l_x[i], d.l_y[i], d.l_z[i]}, Direction{d.v_x[i], d.v_y[i], d.v_z[i]});
}

template <class Real>
std::vector<double> batch_values(const Material& m, const CompileSettings& compile, const DirectionBatch& d) {
  const BatchEvaluator<Real> kernel(m, compile);
  std::vector<Real> out(kernel.channels() * d.size());
  kernel.values(rounded<Real>(d), std::span<Real>(out));
  return {out.begin(), out.end()};
}

std::vector<double> scalar_values(const Material& m, const DirectionBatch& d) {
  const Evaluator evaluator(m);
  std::vector<double> out;
  out.reserve(evaluator.channels() * d.size());
  for (std::size_t c = 0; c < evaluator.channels(); ++c) {
    for (std::size_t i = 0; i < d.size(); ++i) out.push_back(evaluator.value(pair_at(d, i), c));
  }
  return out;
}

std::vector<double> values_at(const EvaluationCandidate& c, const Material& m, const DirectionBatch& d) {
  switch (c.arithmetic) {
    case Arithmetic::batch_float:
      return batch_values<float>(m, c.compile, d);
    case Arithmetic::scalar:
      return scalar_values(m, d);
    case Arithmetic::batch_double:
      break;
  }
  return batch_values<double>(m, c.compile, d);
}

// coh is k F S exp(-g)/(cos_i dOmega) within its cone.
void add_coh(ModelValues& values, const EvaluationCandidate& c, const ErrorSamples& samples) {
  Material coh = c.material;
  coh.components = {Effect::coh};
  const std::vector<double> height = values_at(c, coh, samples.mirrors);
  const std::size_t n = samples.mirrors.size();
  for (std::size_t k = 0; k < height.size(); ++k) {
    values.mirror_energy[k] = height[k] * samples.mirrors.l_z[k % n] * coh.solid_angle_sr;
  }
}

// A peer's mirror part, c/(cos_i dOmega) likewise, by the values of two solid angles: half of it is their difference.
// For all else its cone is made so small that only the mirror direction itself is in it.
ModelValues peer_values(const EvaluationCandidate& c, const ErrorSamples& samples) {
  constexpr double no_cone_sr = 1e-24;
  ModelValues values{.channels = c.material.channels.size(), .f = {}, .mirror = {}, .mirror_energy = {}};
  Material m = c.material;
  const auto mirror_at = [&](double solid_angle_sr) {
    m.solid_angle_sr = solid_angle_sr;
    return values_at(c, m, samples.mirrors);
  };
  const double solid_angle = c.material.solid_angle_sr;
  const std::vector<double> once = mirror_at(solid_angle);
  const std::vector<double> twice = mirror_at(2.0 * solid_angle);
  const std::size_t n = samples.mirrors.size();
  for (std::size_t k = 0; k < once.size(); ++k) {
    const double part = 2.0 * (once[k] - twice[k]);
    values.mirror.push_back(once[k] - part);
    values.mirror_energy.push_back(part * samples.mirrors.l_z[k % n] * solid_angle);
  }
  m.solid_angle_sr = no_cone_sr;
  values.f = values_at(c, m, samples.directions);
  return values;
}

template <class Real>
TimedTask batch_task(const EvaluationCandidate& c, const DirectionBatch& pairs) {
  const auto kernel = std::make_shared<const BatchEvaluator<Real>>(c.material, c.compile);
  const auto input = std::make_shared<const BasicDirectionBatch<Real>>(rounded<Real>(pairs));
  const auto out = std::make_shared<std::vector<Real>>(kernel->channels() * pairs.size());
  return {[=] {
            kernel->values(*input, std::span<Real>(*out));
            keep(out->data());
          },
          static_cast<double>(out->size())};
}

TimedTask scalar_task(const EvaluationCandidate& c, const DirectionBatch& pairs) {
  const auto evaluator = std::make_shared<const Evaluator>(c.material);
  const auto out = std::make_shared<std::vector<double>>(evaluator->channels() * pairs.size());
  return {[=, &pairs] {
            for (std::size_t i = 0; i < pairs.size(); ++i) {
              const Pair p = pair_at(pairs, i);
              for (std::size_t k = 0; k < evaluator->channels(); ++k)
                (*out)[k * pairs.size() + i] = evaluator->value(p, k);
            }
            keep(out->data());
          },
          static_cast<double>(out->size())};
}

}  // namespace

std::string_view name_of(Arithmetic a) noexcept {
  return a == Arithmetic::batch_float ? "float" : a == Arithmetic::scalar ? "double, one by one" : "double";
}

ModelValues model_values(const EvaluationCandidate& c, const ErrorSamples& samples) {
  if (c.material.model != surface_model) return peer_values(c, samples);
  const std::size_t channels = c.material.channels.size();
  const std::size_t mirrors = samples.mirrors.size();
  ModelValues values{.channels = channels,
                     .f = std::vector<double>(channels * samples.directions.size()),
                     .mirror = std::vector<double>(channels * mirrors),
                     .mirror_energy = std::vector<double>(channels * mirrors)};
  const EffectSet acting = acting_effects(c.material);
  Material rest = c.material;
  rest.components = acting;
  rest.components.erase(Effect::coh);
  if (!rest.components.empty()) {
    values.f = values_at(c, rest, samples.directions);
    values.mirror = values_at(c, rest, samples.mirrors);
  }
  if (acting.has(Effect::coh)) add_coh(values, c, samples);
  return values;
}

DirectionBatch random_pairs(std::size_t count, std::uint64_t seed) {
  RandomStream random(subkey(seed, "pairs"));
  const double least_cos = cos_deg(85.0);
  const auto direction = [&] {
    const double z = random.uniform(least_cos, 1.0);
    const double r = std::sqrt((1.0 - z) * (1.0 + z));
    const double phi = random.uniform(-pi, pi);
    return Direction{r * std::cos(phi), r * std::sin(phi), z};
  };
  DirectionBatch pairs;
  for (std::size_t i = 0; i < count; ++i) {
    const Direction l = direction();
    pairs.push_back(l, direction());
  }
  return pairs;
}

TimedTask evaluation_task(const EvaluationCandidate& c, const DirectionBatch& pairs) {
  switch (c.arithmetic) {
    case Arithmetic::batch_float:
      return batch_task<float>(c, pairs);
    case Arithmetic::scalar:
      return scalar_task(c, pairs);
    case Arithmetic::batch_double:
      break;
  }
  return batch_task<double>(c, pairs);
}

Material first_channel_of(Material m) {
  m.channels.resize(1);
  m.fit.reset();
  return m;
}

}  // namespace goniofit
