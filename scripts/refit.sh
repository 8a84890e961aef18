#!/usr/bin/env bash
# Makes the shipped scans and fits anew: data/*.csv from the truths under fits/, then fits/*.json, their plots and
# fits/materials.csv from the scans. Run it after a change that moves them, look at `git diff`, and say in the commit why they moved.
source "$(dirname "$0")/lib.sh"

build_program

# NAME SAMPLING SEED, in the order of the table. The seeds are the samples' numbers.
remake() {
  local name=$1 sampling=$2 seed=$3
  "$goniofit" simulate "fits/$name.truth.json" --sampling "$sampling" --noise 0.02 --seed "$seed" --output "data/$name.csv"
  "$goniofit" fit --recipe "fits/$name.toml" --output "fits/$name.json" --plot "fits/$name.svg" --quiet >/dev/null
  materials+=("fits/$name.json")
}

materials=()
remake garnet_red_paint_13 hemisphere 13
remake laser_paper_73 hemisphere 73
remake ground_glass_41 hemisphere 41
remake aluminium_coated_45 incidence-plane 45
"$goniofit" export "${materials[@]}" --format csv --output fits/materials.csv
