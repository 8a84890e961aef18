// The joint fit of a hemispherical scan, global search included, beside what one would write with Ceres by hand: one
// automatically differentiated block a reading, from a fixed start. scripts/bench.sh interleaves their repetitions.

#include <benchmark/benchmark.h>
#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "basis/optics.h"
#include "brdf/surface_shape.h"
#include "fit/fit.h"
#include "support/materials.h"
#include "synthetic/simulate.h"

namespace goniofit {
namespace {

// The paper's paper sample in `channels` bands; 3528 directions each.
Scan scan_of(std::size_t channels) {
  Material m = test::laser_paper_73();
  const std::vector<MaterialChannel> from = m.channels;
  m.channels.clear();
  for (std::size_t c = 0; c < channels; ++c) {
    MaterialChannel channel = from[c % from.size()];
    channel.name = std::to_string(400 + 10 * c) + "nm";
    channel.wavelength_um = 0.4 + 0.01 * static_cast<double>(c);
    m.channels.push_back(channel);
  }
  return simulate(m, Sampling::hemisphere, {0.02, 0.0}, 7);
}

FitSettings settings() {
  FitSettings s;
  s.components = EffectSet{Effect::dd, Effect::uds, Effect::fs};
  s.n = {1.5};
  return s;
}

double least(const std::vector<double>& v) { return *std::min_element(v.begin(), v.end()); }
double largest(const std::vector<double>& v) { return *std::max_element(v.begin(), v.end()); }

void joint_fit(benchmark::State& state) {
  const Scan scan = scan_of(static_cast<std::size_t>(state.range(0)));
  double loss = 0.0;
  for (auto _ : state) {
    loss = fit(scan, settings()).loss;
  }
  state.counters["loss"] = loss;
}
BENCHMARK(joint_fit)
    ->Arg(3)
    ->Arg(31)
    ->Unit(benchmark::kMillisecond)
    ->ComputeStatistics("min", least)
    ->ComputeStatistics("max", largest);

// One reading of three channels: parameters slope and (k_dd, k_uds, k_fs) of each channel.
struct ReadingCost {
  Pair pair;
  double weight;
  ChannelOptics optics;
  std::array<double, 3> measured;

  template <class T>
  bool operator()(const T* slope, const T* k, T* residual) const {
    using std::log;
    const T log_slope = log(slope[0]);
    const ShapeSettings published;
    const SurfaceParameters<T> surface{.log_slope = log_slope};
    const SurfaceTerms<T> t = surface_terms(published, surface, pair);
    const T dd = fresnel(FresnelTier::schlick, optics, pair) * dd_shape(published, surface, t, 1.0, pair);
    const double transmitted = transmission(FresnelTier::schlick, optics, pair);
    const T fs = transmitted * fs_shape(published, surface, t, pair);
    for (std::size_t c = 0; c < 3; ++c) {
      residual[c] = weight * (k[3 * c] * dd + k[3 * c + 1] * (transmitted / pi) + k[3 * c + 2] * fs - measured[c]);
    }
    return true;
  }
};

void plain_ceres_fit(benchmark::State& state) {
  const Scan scan = scan_of(3);
  double loss = 0.0;
  for (auto _ : state) {
    double slope = 0.1;
    std::array<double, 9> k{};
    k.fill(0.5);
    ceres::Problem problem;
    for (std::size_t i = 0; i < scan.size(); ++i) {
      const Pair p = make_pair(scan.angles(i));
      auto* const cost =
          new ReadingCost{p,
                          std::sqrt(p.cos_i),
                          ChannelOptics::of_index(1.5, 0.0),
                          {scan.channels[0].values[i], scan.channels[1].values[i], scan.channels[2].values[i]}};
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<ReadingCost, 3, 1, 9>(cost), nullptr, &slope, k.data());
    }
    problem.SetParameterLowerBound(&slope, 0, slope_min);
    problem.SetParameterUpperBound(&slope, 0, slope_max);
    for (int j = 0; j < 9; ++j) problem.SetParameterLowerBound(k.data(), j, 0.0);
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.logging_type = ceres::SILENT;
    options.function_tolerance = 1e-9;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    loss = 2.0 * summary.final_cost;
  }
  state.counters["loss"] = loss;
}
BENCHMARK(plain_ceres_fit)
    ->Unit(benchmark::kMillisecond)
    ->ComputeStatistics("min", least)
    ->ComputeStatistics("max", largest);

}  // namespace
}  // namespace goniofit
