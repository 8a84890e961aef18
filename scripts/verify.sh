#!/usr/bin/env bash
# The long statistical runs: recovery trials of every shipped recipe and of the scenarios in fits/coverage, then
# materials nobody chose. An hour or so on two cores.
#   scripts/verify.sh [--trials N] [--random N] [--starts N] [--seed N] [--output DIR]
# 2000 trials each, 1000 random materials and 20 starts unless told otherwise. The seed is drawn anew and printed, so that
# a run can be repeated. DIR (build/verify) gets verify.json, verify.md with the bounds missed, and coverage.svg.
# Exit status 1 where a bound is missed.
source "$(dirname "$0")/lib.sh"

trials=2000 random=1000 starts=20 output=build/verify seed=$(od -An -N4 -tu4 /dev/urandom | tr -d ' ')
while (($#)); do
  case $1 in
    --trials) trials=$2 ;;
    --random) random=$2 ;;
    --starts) starts=$2 ;;
    --seed) seed=$2 ;;
    --output) output=$2 ;;
    *)
      sed -n '2,/^source/{/^source/d;s/^# \{0,1\}//;p}' "$0" >&2
      exit 2
      ;;
  esac
  shift 2
done

build_program
mkdir -p "$output"
say "seed $seed"
status=0
"$goniofit" verify fits/*.toml fits/coverage/*.toml --trials "$trials" --random "$random" --starts "$starts" \
  --seed "$seed" --plot "$output/coverage.svg" --markdown "$output/verify.md" --json >"$output/verify.json" || status=$?
((status <= 1)) || exit "$status"
cat "$output/verify.md"
say "seed $seed; tables and plot are in $output"
exit "$status"
