#!/usr/bin/env bash
# Builds everything and runs all tests.
#   scripts/test.sh                 the release build, in build/
#   scripts/test.sh --sanitize      with AddressSanitizer and UndefinedBehaviorSanitizer, in build-sanitize/
#   scripts/test.sh --format        only checks that clang-format would change nothing
#   scripts/test.sh -- -R fit       what follows -- goes to ctest
source "$(dirname "$0")/lib.sh"

usage() { sed -n '2,/^source/{/^source/d;s/^# \{0,1\}//;p}' "$0"; }

check_format() {
  ensure_packages clang-format
  find src tests -name '*.h' -o -name '*.cpp' | sort | xargs clang-format --dry-run --Werror
  say "formatting is as .clang-format has it"
}

dir=build
options=(-DGONIOFIT_SANITIZE=OFF)
while (($#)); do
  case $1 in
    --sanitize)
      dir=build-sanitize
      # Instrumented code makes GCC 12 warn inside its own library; the warnings that count are the release build's.
      options=(-DGONIOFIT_SANITIZE=ON -DCMAKE_BUILD_TYPE=RelWithDebInfo -DGONIOFIT_WERROR=OFF
        -DCMAKE_CXX_FLAGS=-Wno-maybe-uninitialized)
      ;;
    --format)
      check_format
      exit
      ;;
    --)
      shift
      break
      ;;
    -h | --help)
      usage
      exit
      ;;
    *)
      usage >&2
      exit 2
      ;;
  esac
  shift
done

ensure_packages "${build_packages[@]}" "${test_packages[@]}"
configure "$dir" -DGONIOFIT_TESTS=ON "${options[@]}"
build "$dir"

# Only what did not pass is worth a line; the closing summary stays last.
say "testing"
ctest --test-dir "$dir" --parallel "$(nproc)" --output-on-failure "$@" |
  grep --line-buffered --invert-match --extended-regexp '^ +Start +[0-9]+:|   Passed +[0-9.]+ sec$'
