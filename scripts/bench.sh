#!/usr/bin/env bash
# Builds and runs the benchmarks, in build-bench/: interleaved repetitions, of which the median, least and largest are
# printed; then two fits at once beside two processes, a very large fit, `goniofit tradeoff`, whose table, JSON and
# front go to out/bench/, and two scenes rendered as planned, with all effects and as published. What follows goes to Google Benchmark, which then is all that runs:
#   scripts/bench.sh --benchmark_filter=fit
source "$(dirname "$0")/lib.sh"

ensure_packages "${build_packages[@]}" libbenchmark-dev
configure build-bench -DGONIOFIT_TESTS=OFF -DGONIOFIT_BENCH=ON
build build-bench goniofit_bench goniofit_fit_scaling goniofit_program
build-bench/tests/bench/goniofit_bench --benchmark_repetitions=15 --benchmark_enable_random_interleaving=true \
  --benchmark_min_time=0.05 --benchmark_display_aggregates_only=true "$@"
(($#)) && exit
build-bench/tests/bench/goniofit_fit_scaling threads
build-bench/tests/bench/goniofit_fit_scaling large
mkdir -p out/bench
build-bench/src/cli/goniofit tradeoff -o out/bench/tradeoff.json --plot out/bench/front.svg | tee out/bench/tradeoff.txt
for scene in five_spheres five_materials; do
  build-bench/src/cli/goniofit render "data/scenes/$scene.toml" --compare -o "out/bench/$scene.exr" | tee "out/bench/$scene.txt"
done
