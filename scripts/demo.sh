#!/usr/bin/env bash
# The main job on a shipped scan: builds what is needed, fits, and leaves everything that a fit can write in out/demo/.
source "$(dirname "$0")/lib.sh"

build_program
out=out/demo
sample=garnet_red_paint_13
mkdir -p "$out"

command=("$goniofit" fit "data/$sample.csv" --recipe "fits/$sample.toml" --output "$out/$sample.json"
  --table "$out/$sample.csv" --exr "$out/$sample.exr" --plot "$out/$sample.svg" --plot "$out/$sample.png"
  --report "$out/$sample.html")
say "${command[*]}"
"${command[@]}"

echo
echo "written to $out/:"
describe() { printf '  %-26s %6s  %s\n' "$1" "$(du -h --apparent-size "$out/$1" | cut -f1)" "$2"; }
describe "$sample.html" "the fit as a page for a browser: plots, maps, lobes, tables"
describe "$sample.json" "the fitted material, for goniofit eval, export, simulate"
describe "$sample.csv" "its parameters with uncertainties, one row a channel"
describe "$sample.exr" "the fitted BRDF as a table, one part an incidence angle"
describe "$sample.svg" "measured readings and fitted curves in the plane of incidence"
describe "$sample.png" "the same as pixels"
