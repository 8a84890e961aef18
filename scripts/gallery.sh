#!/usr/bin/env bash
# Makes the pictures of the gallery in fits/gallery/ from the program's own output: the figures of Li & Torrance 2005, Oren
# & Nayar 1994 and Schlick 1994 that need no photograph. Takes a minute or two.
#   scripts/gallery.sh                  all of them
#   scripts/gallery.sh plots spheres    only those parts, of plots, spheres, scenes and page
source "$(dirname "$0")/lib.sh"

out=fits/gallery
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# plot NAME WIDTH HEIGHT < script: a PNG by gnuplot, in the gallery's one style. Lines differ by dash as well as colour.
plot() {
  {
    cat <<GNUPLOT
set encoding utf8
set terminal pngcairo size $2,$3 font 'sans-serif,11' enhanced background '#FFFFFF'
set output '$out/$1.png'
set datafile separator ','
set key samplen 3 spacing 1.2 reverse Left
set tics nomirror out scale 0.6
set border 3 lc rgb '#555555'
set grid back lc rgb '#E4E4E4' lt 1
set style line 1 lc rgb '#0072B2' lw 2 dt 1
set style line 2 lc rgb '#D55E00' lw 2 dt (10,4)
set style line 3 lc rgb '#009E73' lw 2 dt (3,3)
set style line 4 lc rgb '#777777' lw 1.6 dt (10,3,2,3)
GNUPLOT
    cat
  } >"$work/$1.gp"
  gnuplot "$work/$1.gp"
}

# in_plane MATERIAL OUT THETA_I...: BRDF in the plane of incidence, blocks separated by blank lines.
in_plane() {
  local material=$1 result=$2 theta_i
  shift 2
  : >"$result"
  for theta_i in "$@"; do
    { echo "theta_i,theta_r"; seq -f "$theta_i,%.1f" -89 0.5 89; } >"$work/directions.csv"
    "$goniofit" eval "$material" "$work/directions.csv" | tail -n +2 >>"$result"
    printf '\n\n' >>"$result"
  done
}

# material NAME COMPONENTS TERMS SURFACE CHANNEL [ROUGH_FORM]: a material with one channel.
material() {
  cat >"$work/$1.json" <<JSON
{"format": "goniofit-material", "version": 1, "name": "$1", "components": [$2], "terms": $3, "surface": {$4},
 "forms": {"rough": "${6:-functional}"}, "channels": [{"name": "F", "wavelength_um": 0.55, $5}]}
JSON
}

li_torrance='{"fresnel": "schlick", "shadowing": "li-torrance", "effective_roughness": "li-torrance", "distribution": "rough-limit"}'
he_torrance='{"fresnel": "exact", "shadowing": "smith", "effective_roughness": "he", "distribution": "he-torrance"}'

# The terms of the model beside those of He et al. 1991.
li_torrance_terms() {
  local slope
  for slope in 0.05 0.2 0.5; do
    "$goniofit" curves shadowing --slope $slope --steps 900 -o "$work/shadowing_$slope.csv"
    "$goniofit" curves effective_roughness --slope $slope --steps 9000 -o "$work/roughness_$slope.csv"
  done
  plot li_torrance_04_shadowing 620 400 <<GNUPLOT
set xlabel 'zenith angle θ in degrees'
set ylabel 'shadowing S_1'
set xrange [30:90]; set yrange [0:1.05]; set key bottom left
slopes = '0.05 0.2 0.5'
plot for [i=1:3] '$work/shadowing_'.word(slopes,i).'.csv' skip 1 using 1:2 with lines ls 1 title i == 1 ? 'Smith (He et al.)' : '', \
     for [i=1:3] '' .'$work/shadowing_'.word(slopes,i).'.csv' skip 1 using 1:3 with lines ls 2 title i == 1 ? 'Li \\& Torrance (6)' : '', \
     '-' using 1:2:3 with labels left textcolor rgb '#444444' notitle
52,0.62,"σ/τ = 0.5"
74.5,0.84,"0.2"
86,0.92,"0.05"
e
GNUPLOT
  plot li_torrance_08_effective_roughness 620 400 <<GNUPLOT
set xlabel 'zenith angle θ of light and viewer in degrees'
set ylabel 'effective roughness σ_e / σ'
set xrange [30:90]; set yrange [0:1.05]; set key bottom left
slopes = '0.05 0.2 0.5'
plot for [i=1:3] '$work/roughness_'.word(slopes,i).'.csv' skip 1 using 1:2 with lines ls 1 title i == 1 ? 'exact (He et al.)' : '', \
     for [i=1:3] '$work/roughness_'.word(slopes,i).'.csv' skip 1 using 1:3 with lines ls 2 title i == 1 ? 'Li \\& Torrance (8)' : '', \
     '-' using 1:2:3 with labels left textcolor rgb '#444444' notitle
56,0.68,"σ/τ = 0.5"
66.5,0.93,"0.2"
85,0.97,"0.05"
e
GNUPLOT
}

# He et al.'s roughened aluminium, and what the published terms make of it once they are fitted to it.
li_torrance_against_he() {
  local angles=(20 40 60 75)
  material he '"dd", "udf"' "$he_torrance" '"slope": 0.17307692307692307, "sigma_um": 0.90, "tau_um": 5.2' '"n": 0.958, "kappa": 6.69, "k_dd": 0.47, "k_udf": 0.32'
  "$goniofit" simulate "$work/he.json" --sampling hemisphere -o "$work/he.csv"
  "$goniofit" fit "$work/he.csv" --components dd,udf --n 0.958 --kappa 6.69 -o "$work/li.json" --quiet >"$work/li.txt"
  in_plane "$work/he.json" "$work/he_curves.csv" "${angles[@]}"
  in_plane "$work/li.json" "$work/li_curves.csv" "${angles[@]}"
  plot li_torrance_09_against_he 620 400 <<GNUPLOT
set xlabel 'viewing angle θ_r in degrees, positive on the mirror side'
set ylabel 'BRDF in sr^{-1}'
set xrange [-90:90]; set xtics 30; set logscale y; set yrange [0.05:20]; set key top left
plot for [i=0:3] '$work/he_curves.csv' index i using 2:3 with lines ls 1 title i == 0 ? 'He–Torrance, σ 0.90 µm, τ 5.2 µm' : '', \
     for [i=0:3] '$work/li_curves.csv' index i using 2:3 with lines ls 2 title i == 0 ? 'Li–Torrance fitted to it' : '', \
     '-' using 1:2:3 with labels textcolor rgb '#444444' notitle
12,0.75,"θ_i 20°"
44,0.92,"40°"
60,2.2,"60°"
70,6.2,"75°"
e
GNUPLOT
}

# Grooves: the integral of Oren and Nayar, their fit to it, and what of it has met one facet only.
oren_nayar() {
  local form terms='{"fresnel": "none", "shadowing": "none", "effective_roughness": "none", "distribution": "rough-limit"}'
  for form in integral functional qualitative; do
    material $form '"rough"' "$terms" '"facet_slope_deg": 30' '"rho": 0.9' $form
    in_plane "$work/$form.json" "$work/$form.csv" 0 45 75
  done
  # f = rho/pi (L1 + rho L2): 4 f(1/2) - f(1) = L1/pi is what one facet sends back.
  material half '"rough"' "$terms" '"facet_slope_deg": 30' '"rho": 0.5' integral
  material whole '"rough"' "$terms" '"facet_slope_deg": 30' '"rho": 1.0' integral
  for form in half whole; do in_plane "$work/$form.json" "$work/$form.csv" 75; done
  paste -d, "$work/half.csv" "$work/whole.csv" | sed '/^,*$/d' >"$work/parts.csv"
  plot oren_nayar_05_against_integral 620 400 <<GNUPLOT
set xlabel 'viewing angle θ_r in degrees, negative on the side of the light'
set ylabel 'BRDF · π / ρ'
set xrange [-90:90]; set xtics 30; set yrange [0:2.2]; set key top right
plot for [i=0:2] '$work/integral.csv' index i using 2:(\$3*pi/0.9) with lines ls 1 title i == 0 ? 'integral over grooves (13)' : '', \
     for [i=0:2] '$work/functional.csv' index i using 2:(\$3*pi/0.9) with lines ls 2 title i == 0 ? 'functional form (14), (15)' : '', \
     for [i=0:2] '$work/qualitative.csv' index i using 2:(\$3*pi/0.9) with lines ls 3 title i == 0 ? 'qualitative form (17)' : '', \
     1 with lines ls 4 title 'Lambert', \
     '-' using 1:2:3 with labels left textcolor rgb '#444444' notitle
-62,1.75,"θ_i 75°"
-85,1.26,"45°"
-80,0.93,"0°"
e
GNUPLOT
  plot oren_nayar_06_interreflection 620 400 <<GNUPLOT
set xlabel 'viewing angle θ_r in degrees, negative on the side of the light'
set ylabel 'BRDF · π, ρ = 1, θ_i = 75°'
set xrange [-90:90]; set xtics 30; set yrange [0:2.2]; set key top right
plot '$work/parts.csv' using 2:(\$6*pi) with lines ls 1 title 'both', \
     '' using 2:((4*\$3-\$6)*pi) with lines ls 2 title 'light that met one facet', \
     '' using 2:((2*\$6-4*\$3)*pi) with lines ls 3 title 'light that met two'
GNUPLOT
}

# Schlick's stand-ins beside what they stand for.
schlick() {
  "$goniofit" curves fresnel --n 1.5 -o "$work/glass.csv"
  "$goniofit" curves fresnel --n 2.417 -o "$work/diamond.csv"
  "$goniofit" curves fresnel --n 0.958 --kappa 6.69 -o "$work/aluminium.csv"
  plot schlick_05_fresnel 620 400 <<GNUPLOT
set xlabel 'angle of incidence in degrees'
set ylabel 'reflectance F'
set xrange [0:90]; set yrange [0:1.02]; set key at 62,0.72
things = 'glass diamond aluminium'
plot for [i=1:3] '$work/'.word(things,i).'.csv' skip 1 using 1:2 with lines ls 1 title i == 1 ? 'Fresnel' : '', \
     for [i=1:3] '$work/'.word(things,i).'.csv' skip 1 using 1:3 with lines ls 2 title i == 1 ? 'Schlick (15)' : '', \
     '-' using 1:2:3 with labels left textcolor rgb '#444444' notitle
5,0.085,"glass, n 1.5"
5,0.215,"diamond, n 2.417"
5,0.87,"aluminium, 0.958 + 6.69i"
e
GNUPLOT
  "$goniofit" curves shadowing --slope 0.25 -o "$work/shadowing.csv"
  plot schlick_06_shadowing 620 400 <<GNUPLOT
set xlabel 'zenith angle in degrees'
set ylabel 'shadowing, σ/τ = 0.25'
set xrange [0:90]; set yrange [0:1.05]; set key bottom left
plot '$work/shadowing.csv' skip 1 using 1:2 with lines ls 1 title 'Smith', \
     '' skip 1 using 1:5 with lines ls 4 title 'Smith as printed in (18), without e^{h}', \
     '' skip 1 using 1:4 with lines ls 2 title 'Schlick (19)', \
     '' skip 1 using 1:3 with lines ls 3 title 'Li \\& Torrance (6)'
GNUPLOT
  local slope
  for slope in 0.1 0.2 0.35; do "$goniofit" curves slopes --slope $slope -o "$work/slopes_$slope.csv"; done
  plot schlick_07_slopes 620 400 <<GNUPLOT
set xlabel 'angle between H and N in degrees'
set ylabel 'slope distribution D · m^2'
set xrange [0:60]; set yrange [0:1.05]
slopes = '0.1 0.2 0.35'
plot for [i=1:3] '$work/slopes_'.word(slopes,i).'.csv' skip 1 using 1:(\$2*4*word(slopes,i)**2) with lines ls 1 title i == 1 ? 'Beckmann (20)' : '', \
     for [i=1:3] '$work/slopes_'.word(slopes,i).'.csv' skip 1 using 1:(\$3*4*word(slopes,i)**2) with lines ls 2 title i == 1 ? 'Schlick (21)' : '', \
     '-' using 1:2:3 with labels left textcolor rgb '#444444' notitle
0.7,0.25,"m = 0.2"
23.5,0.52,"0.4"
40,0.78,"0.7"
e
GNUPLOT
  local p
  for p in 0.1 0.3 1; do "$goniofit" curves azimuth --isotropy $p -o "$work/azimuth_$p.csv"; done
  plot schlick_08_azimuth 620 400 <<GNUPLOT
set xlabel 'azimuth of H from the grooves in degrees'
set ylabel 'azimuth factor A'
set xrange [0:180]; set xtics 30; set logscale y; set yrange [0.08:40]; set key top left
ps = '0.1 0.3 1'
plot for [i=1:3] '$work/azimuth_'.word(ps,i).'.csv' skip 1 using 1:2 with lines ls 1 title i == 1 ? 'normalised: the mean is 1' : '', \
     for [i=1:3] '$work/azimuth_'.word(ps,i).'.csv' skip 1 using 1:3 with lines ls 2 title i == 1 ? 'as printed' : '', \
     '-' using 1:2:3 with labels left textcolor rgb '#444444' notitle
95,10.5,"p = 0.1"
106,2.7,"0.3"
165,1.2,"1"
e
GNUPLOT
}

# The paint at 60°, effect by effect.
li_torrance_components() {
  local effects=(dd uds fs) effect
  local k='"n": 1.7, "k_dd": 0.59, "k_uds": 0.10, "k_fs": 1.1'
  for effect in "${effects[@]}"; do
    material "$effect" "\"$effect\"" "$li_torrance" '"slope": 0.0853658536585366' "$k"
    in_plane "$work/$effect.json" "$work/$effect.csv" 30 60 80
  done
  paste -d, "$work/dd.csv" "$work/uds.csv" "$work/fs.csv" | sed 's/^,*$//' >"$work/effects.csv"
  plot li_torrance_13_effects 900 340 <<GNUPLOT
set multiplot layout 1,3
set logscale y; set yrange [3e-4:100]; set format y '10^{%T}'; set xrange [-90:90]; set xtics 30; set key top left
set xlabel 'viewing angle θ_r in degrees'
angles = '30 60 80'
do for [i=0:2] {
  if (i == 0) { set ylabel 'BRDF in sr^{-1}' } else { unset ylabel; unset key }
  set title 'θ_i = '.word(angles, i + 1).'°'
  plot '$work/effects.csv' index i using 2:(\$3+\$6+\$9) with lines lc rgb '#000000' lw 1.2 title 'all', \
       '' index i using 2:3 with lines ls 1 title 'dd', '' index i using 2:6 with lines ls 2 title 'uds', \
       '' index i using 2:9 with lines ls 3 title 'fs'
}
unset multiplot
GNUPLOT
}

plots() {
  li_torrance_components
  li_torrance_terms
  li_torrance_against_he
  oren_nayar
  schlick
}

# spheres_of NAME ANGLES MATERIAL... [FLAG...]: side by side under a small lamp, ANGLES degrees away from the eye.
spheres_of() {
  local name=$1 angles=$2
  shift 2
  "$goniofit" render "$@" --light-angle "$angles" --size 180 --samples 32 --quiet -o "$out/$name.png" >/dev/null
}

# peers SAMPLE N: the sample's scan fitted with other models; that a model does not describe it (status 1) is the point.
peers() {
  local sample=$1 n=$2 model
  for model in lambert lafortune-1 ward cook-torrance; do
    local flags=(--model "$model")
    [[ $model == cook-torrance ]] && flags+=(--n "$n")
    "$goniofit" fit "data/$sample.csv" "${flags[@]}" -o "$work/$sample.$model.json" --quiet >"$work/$sample.$model.txt" || (($? == 1))
  done
}

spheres() {
  spheres_of li_torrance_03_roughness_mirror 30,90,130,155 fits/ground_glass_41.truth.json
  local sample number=14 n=1.7
  for sample in garnet_red_paint_13 laser_paper_73; do
    peers "$sample" "$n"
    local models=()
    for model in lambert lafortune-1 ward cook-torrance; do models+=("$work/$sample.$model.json"); done
    spheres_of "li_torrance_${number}_front_$sample" 45 "${models[@]}" "fits/$sample.json"
    spheres_of "li_torrance_${number}_behind_$sample" 120 "${models[@]}" "fits/$sample.json"
    number=16 n=1.5
  done
  local terms='{"fresnel": "none", "shadowing": "none", "effective_roughness": "none", "distribution": "rough-limit"}'
  local slope rough=()
  for slope in 0.5 10 20 40; do
    material "plaster_$slope" '"rough"' "$terms" "\"facet_slope_deg\": $slope" '"rho": 0.9'
    rough+=("$work/plaster_$slope.json")
  done
  spheres_of oren_nayar_14_spheres 10 "${rough[@]}"
}

# The first screen of a report, as a browser shows it.
page() {
  ensure_packages chromium
  "$goniofit" fit data/garnet_red_paint_13.csv --n 1.7 --report "$work/report.html" --quiet >"$work/report.txt"
  quietly chromium --headless --no-sandbox --disable-gpu --no-first-run --disable-background-networking \
    --user-data-dir="$work/browser" --window-size=1280,900 --virtual-time-budget=4000 \
    --screenshot="$PWD/$out/report.png" "file://$work/report.html"
}

# The scenes that ship, planned.
scenes() {
  local scene
  for scene in five_materials five_spheres mirror; do
    "$goniofit" render "data/scenes/$scene.toml" --samples 128 --quiet -o "$out/$scene.png" >"$work/$scene.txt"
  done
}

build_program
mkdir -p "$out"
(($#)) || set -- plots spheres scenes page
for part in "$@"; do
  say "gallery: $part"
  "$part"
done
