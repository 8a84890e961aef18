// The batch evaluator, nanoseconds an evaluation of one channel from unit vectors, beside the model as one writes it
// down, and one vector exponential.

#include "brdf/batch_evaluator.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "brdf/evaluator.h"
#include "geometry/angles.h"
#include "plain_li_torrance.h"
#include "support/materials.h"
#include "vector_exp.h"

namespace goniofit {
namespace {

constexpr std::size_t count = 4096;

double least(const std::vector<double>& v) { return *std::min_element(v.begin(), v.end()); }
double largest(const std::vector<double>& v) { return *std::max_element(v.begin(), v.end()); }

// Uniform over the hemisphere but for the last five degrees.
struct Directions {
  DirectionBatch batch;
  FloatDirectionBatch floats;
  PairBatch pairs;
  std::vector<std::pair<Direction, Direction>> each;

  Directions() {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const double lowest = cos_deg(85.0);
    const auto draw = [&] {
      const double z = lowest + (1.0 - lowest) * unit(random);
      const double phi = 2.0 * pi * unit(random);
      const double r = std::sqrt(1.0 - z * z);
      return Direction{r * std::cos(phi), r * std::sin(phi), z};
    };
    for (std::size_t i = 0; i < count; ++i) {
      const Direction l = draw();
      const Direction v = draw();
      batch.push_back(l, v);
      floats.push_back(l, v);
      pairs.push_back(make_pair(l, v));
      each.emplace_back(l, v);
    }
  }
  [[nodiscard]] static const Directions& get() {
    static const Directions directions;
    return directions;
  }
};

void report(benchmark::State& state) {
  state.counters["each"] = benchmark::Counter(
      static_cast<double>(count) * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

template <class Real, class Batch>
void evaluate(benchmark::State& state, const Material& m, const CompileSettings& settings, const Batch& batch) {
  if (settings.instructions > best_instruction_set()) return state.SkipWithError("not on this processor");
  const BatchEvaluator<Real> evaluator(m, settings);
  std::vector<Real> out(count);
  for (auto _ : state) {
    evaluator.values(batch, out);
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
  }
  report(state);
}

Material one_channel(Material m) {
  m.channels.resize(1);
  return m;
}
Material paint() { return one_channel(test::garnet_red_paint_13()); }
Material all_five() {
  Material m = paint();
  m.components = {Effect::coh, Effect::dd, Effect::udf, Effect::uds, Effect::fs};
  m.channels[0].coefficient(Coefficient::k_udf) = 0.05;
  return m;
}
// He and Torrance have dd and a diffuse part.
Material he_torrance(Material m, DistributionTier distribution = DistributionTier::he_torrance) {
  m = one_channel(std::move(m));
  m.components = {Effect::dd, Effect::udf};
  m.channels[0].coefficient(Coefficient::k_udf) = 0.1;
  m.terms = test::he_torrance_terms();
  m.terms.distribution = distribution;
  return m;
}
Material cook_torrance() {
  Material m;
  m.name = m.model = "cook-torrance";
  MaterialChannel c;
  c.name = "R";
  c.n = 1.7;
  c.kappa = 0.0;
  c.peer_k = {{"k_d", 0.1}, {"k_s", 0.59}};
  m.parameters["m"] = 0.17;
  m.channels = {c};
  return m;
}

template <class Function>
void add(const std::string& name, const Function& function) {
  benchmark::RegisterBenchmark(("evaluator/" + name).c_str(), function)
      ->ComputeStatistics("min", least)
      ->ComputeStatistics("max", largest);
}

void add_compiled(const std::string& name, const Material& m, const CompileSettings& settings = {}) {
  add(name, [=](benchmark::State& s) { evaluate<double>(s, m, settings, Directions::get().batch); });
}

bool add_all() {
  add("plain", [](benchmark::State& state) {
    const auto& each = Directions::get().each;
    const bench::PlainMaterial m{0.70 / 8.2, 0.0672, 0.59, 0.10, 1.1};
    std::vector<double> out(count);
    for (auto _ : state) {
      for (std::size_t i = 0; i < count; ++i) out[i] = bench::plain_li_torrance(m, each[i].first, each[i].second);
      benchmark::DoNotOptimize(out.data());
      benchmark::ClobberMemory();
    }
    report(state);
  });
  add("vector_exp", [](benchmark::State& state) {
    std::vector<double> out(count);
    for (auto _ : state) {
      bench::vector_exp(Directions::get().batch.l_x.data(), out.data(), count);
      benchmark::DoNotOptimize(out.data());
      benchmark::ClobberMemory();
    }
    report(state);
  });
  for (const InstructionSet set : all_instruction_sets) {
    add_compiled("li_torrance/" + std::string(name_of(set)), paint(), {.instructions = set});
  }
  add("li_torrance/prepared_geometry",
      [](benchmark::State& s) { evaluate<double>(s, paint(), {}, Directions::get().pairs); });
  add("li_torrance/float", [](benchmark::State& s) { evaluate<float>(s, paint(), {}, Directions::get().floats); });
  add_compiled("li_torrance/1e-4", paint(), {.tolerance = 1e-4});
  add_compiled("li_torrance/all_five_effects", all_five());
  Material alone = paint();
  alone.components = {Effect::dd};
  add_compiled("li_torrance/dd_alone", alone);
  alone.terms.shadowing = ShadowingTier::none;
  alone.terms.effective_roughness = EffectiveRoughnessTier::none;
  add_compiled("li_torrance/dd_alone_without_S_and_sigma_e", alone);
  add_compiled("cook_torrance", cook_torrance());
  const std::vector<std::pair<std::string, Material>> samples{{"13", test::garnet_red_paint_13()},
                                                              {"73", test::laser_paper_73()},
                                                              {"41", test::ground_glass_41()},
                                                              {"45", test::smooth_aluminium_45()}};
  for (const auto& [name, m] : samples) {
    add_compiled("he_torrance/" + name, he_torrance(m));
    add_compiled("he_torrance/" + name + "/1e-4", he_torrance(m), {.tolerance = 1e-4});
    const Material series = he_torrance(m, DistributionTier::he_torrance_series);
    add("he_torrance_series/" + name, [series](benchmark::State& state) {
      const Evaluator scalar(series);
      double sum = 0.0;
      std::size_t i = 0;
      for (auto _ : state) {
        for (std::size_t k = 0; k < 256; ++k) sum += scalar.value(Directions::get().pairs[i++ % count], 0);
      }
      benchmark::DoNotOptimize(sum);
      state.counters["each"] =
          benchmark::Counter(256e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
    });
  }
  return true;
}
const bool added = add_all();

}  // namespace
}  // namespace goniofit
