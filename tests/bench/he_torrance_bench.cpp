// W(g, x) of He et al. 1991, nanoseconds an evaluation at random places of one range of g, down to W = 1e-290: the
// plain sum, the saddle point (wrong below peaks of 100, at the same price) and the fast tier. Then the same, and the
// blocks, at what pairs of random directions ask of the paper's materials.

#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "geometry/angles.h"
#include "geometry/pair.h"
#include "terms/effective_roughness.h"
#include "terms/he_torrance.h"
#include "terms/he_torrance_block.h"

namespace goniofit {
namespace {

struct Places {
  std::vector<double> log_g, x;
};

// Uniform in ln g and, over the nine decades where it matters, in ln x.
Places places(double low, double high) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Places p;
  while (p.x.size() < 4096) {
    const double log_g = low + (high - low) * unit(random);
    const double x = std::exp(std::fmax(log_g, 2.0 * log_g) - 3.0 + 13.0 * unit(random));
    if (log_he_torrance_series(log_g, x) < -667.0) continue;
    p.log_g.push_back(log_g);
    p.x.push_back(x);
  }
  return p;
}

template <class F>
void run(benchmark::State& state, const F& f) {
  const double low = 0.01 * static_cast<double>(state.range(0)), high = 0.01 * static_cast<double>(state.range(1));
  const Places p = places(low, high);
  benchmark::DoNotOptimize(f(0.0, 1.0));  // the tables are made outside of the timing
  for (auto _ : state) {
    double sum = 0.0;
    for (std::size_t i = 0; i < p.x.size(); ++i) sum += f(p.log_g[i], p.x[i]);
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(p.x.size()));
  state.counters["per_W"] = benchmark::Counter(
      static_cast<double>(p.x.size()), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void series(benchmark::State& state) {
  run(state, [](double log_g, double x) { return log_he_torrance_series(log_g, x); });
}
void saddle(benchmark::State& state) {
  run(state, [](double log_g, double x) {
    return he_torrance::log_w_at_saddle(log_g, x, he_torrance::saddle_exponent(log_g, x)).value;
  });
}
void fast(benchmark::State& state) {
  run(state, [](double log_g, double x) { return he_torrance_log_w(log_g, x); });
}
void fast_derivatives(benchmark::State& state) {
  run(state, [](double log_g, double x) {
    const HeTorranceW w = he_torrance_log_w_derivatives(log_g, x);
    return w.value + w.by_log_g + w.by_x;
  });
}
void tables(benchmark::State& state) {
  for (auto _ : state) {
    const he_torrance::Tables t;
    benchmark::DoNotOptimize(&t);
  }
}

// 100 ln g: g of 1e-12 ... 0.135, ... 1, ... 36.6, ... 125, ... 1e4.
void ranges(benchmark::internal::Benchmark* b) {
  b->ArgNames({"100ln_g", "to"})
      ->Args({-2763, -200})
      ->Args({-200, 0})
      ->Args({0, 360})
      ->Args({360, 483})
      ->Args({483, 921});
}
BENCHMARK(series)->Name("he_torrance/series")->Apply(ranges);
BENCHMARK(saddle)->Name("he_torrance/saddle")->Apply(ranges);
BENCHMARK(fast)->Name("he_torrance/fast")->Apply(ranges);
BENCHMARK(fast_derivatives)->Name("he_torrance/fast_derivatives")->Apply(ranges);
BENCHMARK(tables)->Name("he_torrance/tables")->Unit(benchmark::kMillisecond);

struct Sample {
  double sigma_um, tau_um;
};
// Garnet red paint, laser paper, ground glass, smooth aluminium of Li and Torrance, and one rougher.
constexpr std::array<Sample, 5> samples{{{0.70, 8.2}, {0.39, 5.4}, {0.86, 4.99}, {0.23, 9.9}, {0.90, 5.2}}};

// Pairs of directions within 85 degrees of the normal, uniform in solid angle.
Places places_of(const Sample& sample, double wavelength_um) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const double k = 2.0 * pi / wavelength_um;
  const double least = std::cos(85.0 * pi / 180.0);
  Places p;
  while (p.x.size() < 16384) {
    const double c_i = least + (1.0 - least) * unit(random);
    const double c_r = least + (1.0 - least) * unit(random);
    const double s_i = std::sqrt(1.0 - c_i * c_i);
    const double s_r = std::sqrt(1.0 - c_r * c_r);
    const double slope = sample.sigma_um / sample.tau_um;
    const double hidden = he_hidden_depth(slope, c_i, s_i) + he_hidden_depth(slope, c_r, s_r);
    const double effective = sample.sigma_um / std::sqrt(1.0 + lambert_w0_of_square(hidden / std::sqrt(8.0 * pi)));
    const double lateral2 = s_i * s_i + s_r * s_r + 2.0 * s_i * s_r * std::cos(2.0 * pi * unit(random));
    p.log_g.push_back(2.0 * std::log(k * effective * (c_i + c_r)));
    p.x.push_back(0.25 * k * k * lateral2 * sample.tau_um * sample.tau_um);
  }
  return p;
}

template <class Real, class F>
void run_material(benchmark::State& state, const F& f) {
  const Places p =
      places_of(samples[static_cast<std::size_t>(state.range(0))], 1e-3 * static_cast<double>(state.range(1)));
  const std::vector<Real> log_g(p.log_g.begin(), p.log_g.end());
  const std::vector<Real> x(p.x.begin(), p.x.end());
  std::vector<Real> w(p.x.size());
  f(log_g, x, w);
  for (auto _ : state) {
    f(log_g, x, w);
    benchmark::DoNotOptimize(w.data());
    benchmark::ClobberMemory();
  }
  state.counters["per_W"] = benchmark::Counter(
      static_cast<double>(p.x.size()), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void material_series(benchmark::State& state) {
  run_material<double>(state, [](const auto& log_g, const auto& x, auto& w) {
    for (std::size_t i = 0; i < w.size(); ++i) w[i] = log_he_torrance_series(log_g[i], x[i]);
  });
}
void material_scalar(benchmark::State& state) {
  run_material<double>(state, [](const auto& log_g, const auto& x, auto& w) {
    for (std::size_t i = 0; i < w.size(); ++i) w[i] = he_torrance_log_w(log_g[i], x[i]);
  });
}
void material_block(benchmark::State& state, HeTorranceAccuracy accuracy, InstructionSet instructions) {
  if (instructions > best_instruction_set()) return state.SkipWithError("not on this processor");
  run_material<double>(state, [=](const auto& log_g, const auto& x, auto& w) {
    log_he_torrance_block(log_g.data(), x.data(), w.size(), w.data(), accuracy, instructions);
  });
}
void material_block_float(benchmark::State& state, InstructionSet instructions) {
  if (instructions > best_instruction_set()) return state.SkipWithError("not on this processor");
  run_material<float>(state, [=](const auto& log_g, const auto& x, auto& w) {
    log_he_torrance_block(log_g.data(), x.data(), w.size(), w.data(), instructions);
  });
}

void materials(benchmark::internal::Benchmark* b) {
  b->ArgNames({"sample", "nm"});
  for (std::int64_t s = 0; s < static_cast<std::int64_t>(samples.size()); ++s) {
    for (const std::int64_t nm : {450, 550, 650}) b->Args({s, nm});
  }
}
BENCHMARK(material_series)->Name("he_torrance_material/series")->Apply(materials);
BENCHMARK(material_scalar)->Name("he_torrance_material/scalar")->Apply(materials);

using enum InstructionSet;
BENCHMARK_CAPTURE(material_block, fine_avx512, HeTorranceAccuracy::fine, avx512)->Apply(materials);
BENCHMARK_CAPTURE(material_block, fine_avx2, HeTorranceAccuracy::fine, avx2)->Apply(materials);
BENCHMARK_CAPTURE(material_block, fine_sse2, HeTorranceAccuracy::fine, sse2)->Apply(materials);
BENCHMARK_CAPTURE(material_block, coarse_avx512, HeTorranceAccuracy::coarse, avx512)->Apply(materials);
BENCHMARK_CAPTURE(material_block, coarse_avx2, HeTorranceAccuracy::coarse, avx2)->Apply(materials);
BENCHMARK_CAPTURE(material_block, coarse_sse2, HeTorranceAccuracy::coarse, sse2)->Apply(materials);
BENCHMARK_CAPTURE(material_block_float, avx512, avx512)->Apply(materials);
BENCHMARK_CAPTURE(material_block_float, avx2, avx2)->Apply(materials);
BENCHMARK_CAPTURE(material_block_float, sse2, sse2)->Apply(materials);

}  // namespace
}  // namespace goniofit
