#!/usr/bin/env bash
# Fuzzes every reader, or those named, in build-fuzz/: scripts/fuzz.sh [SECONDS each, 60] [READER ...]
# Inputs that reach new code are kept in build-fuzz/corpus/. What breaks a reader is written to out/fuzz/ and makes the script
# fail; once the bug is fixed that file belongs in tests/fuzz/corpus/READER/, which the normal test suite replays.
source "$(dirname "$0")/lib.sh"

seconds=${1:-60}
readers=("${@:2}")
((${#readers[@]})) || readers=(scan directions optical_constants material recipe exr_table scene mesh exr_image)

ensure_packages "${build_packages[@]}" clang libclang-rt-14-dev
# The warnings that count are those of the compiler in CI.
configure build-fuzz -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=RelWithDebInfo -DGONIOFIT_FUZZ=ON \
  -DGONIOFIT_TESTS=OFF -DGONIOFIT_WERROR=OFF
build build-fuzz "${readers[@]/#/goniofit_fuzz_}"

mkdir -p out/fuzz
status=0
for reader in "${readers[@]}"; do
  say "fuzzing $reader for $seconds s"
  mkdir -p "build-fuzz/corpus/$reader"
  "build-fuzz/tests/fuzz/goniofit_fuzz_$reader" -max_total_time="$seconds" -timeout=20 -rss_limit_mb=4096 -max_len=65536 \
    -print_final_stats=1 -verbosity=0 -artifact_prefix="out/fuzz/$reader-" \
    "build-fuzz/corpus/$reader" "tests/fuzz/corpus/$reader" || status=1
done
exit "$status"
