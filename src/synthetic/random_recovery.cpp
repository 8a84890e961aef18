// verify_random: does the fit find the global minimum of materials nobody chose?

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "fit/polish.h"
#include "synthetic/parallel.h"
#include "synthetic/random.h"
#include "synthetic/recovery.h"
#include "synthetic/simulate.h"
#include "synthetic/verify.h"

namespace goniofit {
namespace {

constexpr std::size_t materials_with_polish_starts = 50;
constexpr double slope_low = 0.01, slope_high = 0.6;
constexpr double chance_of_zero = 0.15;
constexpr Noise noise{0.02, 0.0};

double random_coefficient(RandomStream& random, double high) {
  const bool absent = random.uniform() < chance_of_zero;
  const double value = random.uniform(0.0, high);
  return absent ? 0.0 : value;
}

void set_random_coefficients(Material& material, RandomStream& random) {
  for (MaterialChannel& channel : material.channels) {
    for (const Effect effect : all_effects) {
      if (!material.components.has(effect)) continue;
      channel.coefficient(coefficient_of(effect)) = random_coefficient(random, effect == Effect::fs ? 2.0 : 1.0);
    }
  }
}

Material random_material(std::uint64_t key, std::size_t index) {
  RandomStream random(subkey(key, "material"));
  const bool metal = random.uniform() < 0.5;
  Material material;
  material.name = fmt::format("random {} {}", metal ? "metal" : "dielectric", index);
  material.components = metal ? EffectSet{Effect::dd, Effect::udf} : EffectSet{Effect::dd, Effect::uds, Effect::fs};
  material.surface.slope = random.log_uniform(slope_low, slope_high);
  const double dielectric_n = random.uniform(1.3, 2.0);
  for (const auto& [name, wavelength_um] : {std::pair{"R", 0.65}, {"G", 0.55}, {"B", 0.45}}) {
    MaterialChannel channel{
        .name = name, .wavelength_um = wavelength_um, .n = dielectric_n, .kappa = 0.0, .f0 = {}, .k = {}, .peer_k = {}};
    if (metal) {  // around aluminium's
      channel.n = random.uniform(0.6, 1.5);
      channel.kappa = random.uniform(5.4, 7.8);
    }
    material.channels.push_back(std::move(channel));
  }
  set_random_coefficients(material, random);
  return material;
}

/// The same material with its slope and coefficients forgotten: a start that knows nothing.
Material random_start(Material material, std::uint64_t key) {
  RandomStream random(subkey(key, "start"));
  material.surface.slope = random.log_uniform(slope_low, slope_high);
  set_random_coefficients(material, random);
  return material;
}

struct Outcome {
  double ratio = 1.0;
  std::size_t starts = 0, start_failures = 0;
  std::string failure;  ///< empty where the fit found the minimum
};

std::string describe(const Material& material, Sampling sampling, const FitResult& result, double ratio) {
  std::string text =
      fmt::format("{}, {}: loss {:.6g} times that from the truth; slope {:.6g}, found ", material.name,
                  sampling == Sampling::hemisphere ? "hemisphere" : "incidence-plane", ratio, *material.surface.slope);
  text += result.material.surface.slope ? fmt::format("{:.6g};", *result.material.surface.slope) : "none;";
  for (const MaterialChannel& channel : material.channels) {
    text += fmt::format(" {}:", channel.name);
    for (const Coefficient c : all_coefficients) {
      if (const auto k = channel.coefficient(c)) text += fmt::format(" {} {:.4g}", name_of(c), *k);
    }
  }
  return text;
}

Outcome recover(std::uint64_t key, std::size_t index, std::size_t starts) {
  const Material truth = random_material(key, index);
  const Sampling sampling = index % 2 == 0 ? Sampling::hemisphere : Sampling::incidence_plane;
  const Scan scan = simulate(truth, sampling, noise, subkey(key, "noise"));
  FitSettings settings;
  settings.components = truth.components;

  const FitResult result = fit(scan, settings);
  const double from_truth = polish_from(scan, settings, truth).loss;
  Outcome outcome;
  outcome.ratio = loss_ratio(scan, result.loss, from_truth);
  if (outcome.ratio > wrong_minimum_ratio) outcome.failure = describe(truth, sampling, result, outcome.ratio);

  std::vector<double> losses;
  for (std::size_t s = 0; s < starts; ++s) {
    losses.push_back(polish_from(scan, settings, random_start(truth, subkey(key, s))).loss);
  }
  double best = std::min(result.loss, from_truth);
  for (const double loss : losses) best = std::min(best, loss);
  outcome.starts = starts;
  outcome.start_failures = static_cast<std::size_t>(std::count_if(
      losses.begin(), losses.end(), [&](double loss) { return loss_ratio(scan, loss, best) > wrong_minimum_ratio; }));
  return outcome;
}

}  // namespace

RandomRecoveryReport verify_random(std::size_t materials, std::uint64_t seed, std::size_t starts_per_material,
                                   const Progress& progress) {
  std::vector<Outcome> outcomes(materials);
  const auto task = [&](std::size_t i) {
    outcomes[i] = recover(subkey(seed, i), i, i < materials_with_polish_starts ? starts_per_material : 0);
  };
  parallel_for(materials, task, progress);
  RandomRecoveryReport report;
  report.materials = materials;
  for (Outcome& outcome : outcomes) {
    report.worst_ratio = std::max(report.worst_ratio, outcome.ratio);
    report.polish_starts += outcome.starts;
    report.polish_failures += outcome.start_failures;
    if (outcome.failure.empty()) continue;
    ++report.wrong_minima;
    report.failures.push_back(std::move(outcome.failure));
  }
  return report;
}

}  // namespace goniofit
