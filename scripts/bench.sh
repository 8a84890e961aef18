#!/usr/bin/env bash
# Builds and runs the benchmarks, in build-bench/. What follows goes to Google Benchmark:
#   scripts/bench.sh --benchmark_filter=fit
source "$(dirname "$0")/lib.sh"

ensure_packages "${build_packages[@]}" libbenchmark-dev
configure build-bench -DGONIOFIT_TESTS=OFF -DGONIOFIT_BENCH=ON
build build-bench goniofit_bench
exec build-bench/tests/bench/goniofit_bench "$@"
