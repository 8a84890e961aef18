#!/bin/sh
# Fuzzes every reader: scripts/fuzz.sh [SECONDS a reader, 60] [READER ...]. New inputs that reach new code stay in the build
# directory; what breaks a reader is written to out/fuzz/ and makes the script fail. A fixed bug's input belongs in
# tests/fuzz/corpus/READER/, which the normal test suite replays.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
build=${GONIOFIT_FUZZ_BUILD:-$root/build-fuzz}
seconds=${1:-60}
[ $# -eq 0 ] || shift
[ $# -gt 0 ] || set -- scan directions optical_constants material recipe exr_table

cmake -S "$root" -B "$build" -G Ninja -DCMAKE_CXX_COMPILER="${CXX:-clang++}" -DCMAKE_BUILD_TYPE=RelWithDebInfo \
  -DGONIOFIT_FUZZ=ON -DGONIOFIT_TESTS=OFF -DGONIOFIT_WERROR=OFF >/dev/null
for reader in "$@"; do
  cmake --build "$build" --target "goniofit_fuzz_$reader"
done

found="$root/out/fuzz"
mkdir -p "$found"
status=0
for reader in "$@"; do
  grown="$build/corpus/$reader"
  mkdir -p "$grown"
  echo "fuzzing $reader for $seconds s"
  "$build/tests/fuzz/goniofit_fuzz_$reader" -max_total_time="$seconds" -timeout=20 -rss_limit_mb=4096 -max_len=65536 \
    -print_final_stats=1 -verbosity=0 -artifact_prefix="$found/$reader-" "$grown" "$root/tests/fuzz/corpus/$reader" || status=1
done
exit $status
