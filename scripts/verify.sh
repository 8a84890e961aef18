#!/usr/bin/env bash
# The long statistical runs: every recipe's recovery trials, then materials nobody chose. Minutes, on all cores.
#   scripts/verify.sh [--trials N] [--random N] [--starts N]     200, 1000 and 20 unless told otherwise
# Exit status 1 where a bound is missed.
source "$(dirname "$0")/lib.sh"

trials=200 random=1000 starts=20
while (($#)); do
  case $1 in
    --trials) trials=$2 ;;
    --random) random=$2 ;;
    --starts) starts=$2 ;;
    *)
      sed -n '2,/^source/{/^source/d;s/^# \{0,1\}//;p}' "$0" >&2
      exit 2
      ;;
  esac
  shift 2
done

build_program
exec "$goniofit" verify fits/*.toml --trials "$trials" --random "$random" --starts "$starts"
