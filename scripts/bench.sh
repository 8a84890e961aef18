#!/usr/bin/env bash
# Builds and runs the benchmarks, in build-bench/: interleaved repetitions, of which the median, least and largest are
# printed. What follows goes to Google Benchmark:
#   scripts/bench.sh --benchmark_filter=fit
# The memory of a very large fit, and what two fits at once take from each other, are a program's of their own:
#   build-bench/tests/bench/goniofit_fit_scaling large
#   build-bench/tests/bench/goniofit_fit_scaling threads
source "$(dirname "$0")/lib.sh"

ensure_packages "${build_packages[@]}" libbenchmark-dev
configure build-bench -DGONIOFIT_TESTS=OFF -DGONIOFIT_BENCH=ON
build build-bench goniofit_bench goniofit_fit_scaling
exec build-bench/tests/bench/goniofit_bench --benchmark_repetitions=15 --benchmark_enable_random_interleaving=true \
  --benchmark_min_time=0.05 --benchmark_display_aggregates_only=true "$@"
