// W(g, x) of He et al. 1991, nanoseconds an evaluation at random places of one range of g, down to W = 1e-290: the
// plain sum, the saddle point (wrong below peaks of 100, at the same price) and the fast tier.

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "terms/he_torrance.h"

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

}  // namespace
}  // namespace goniofit
