#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs the slides of pipelines/ at several resolutions and writes one CSV: points, steps, time, score.
# usage: scenes.sh BIN OUT ON MOST
set -euo pipefail
bin=$1 out=$2 on=$3 most=$4
pipelines=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
mkdir -p "$out"
table=$out/scenes.csv
columns=(scene spacing_m layer_height_m place points steps wall_s us_per_step seconds_per_point_and_step simulated_s
  footprint_csi deposit_csi thickness_rmse_m runout_m)
(IFS=,; echo "${columns[*]}") >"$table"

# value FILE KEY: a number or text of a score.json, commas in it as semicolons; empty where there is none.
value() { sed -nE "s/^ *\"$2\": *\"?([^\"]*[^\",])\"?,?$/\1/p" "$1" | head -n 1 | tr , ';'; }

# run SCENE SPACING LAYER
run() {
  local scene=$1 folder=$out/$1-$2-$3 recipe
  mkdir -p "$folder"
  recipe=$pipelines/$scene/.bench-$2-$3.toml   # beside its own, so that the paths in it lead where they did
  sed "s/^spacing_m *=.*/spacing_m = $2/; s/^layer_height_m *=.*/layer_height_m = $3/" \
    "$pipelines/$scene/recipe.toml" >"$recipe"
  trap 'rm -f "$recipe"' RETURN
  local points
  points=$("$bin/talus-preprocess" "$recipe" --out "$folder" 2>&1 >/dev/null |
    sed -n 's/^.*material points: \([0-9,]*\).*/\1/p' | tr -d ,)
  if awk -v p="$points" -v m="$most" 'BEGIN { exit !(p > m) }'; then
    echo "  $scene $2 $3: $points points, more than MOST=$most, left out" >&2
    return
  fi
  "$bin/talus-solve" "$recipe" --out "$folder" --on "$on" -q >/dev/null
  "$bin/talus-postprocess" "$recipe" --out "$folder" -q >/dev/null
  local s=$folder/score.json steps wall
  steps=$(value "$s" steps) wall=$(value "$s" wall_time_s)
  awk -v OFS=, -v n="$points" -v k="$steps" -v w="$wall" -v a="$scene" -v h="$2" -v z="$3" \
    -v on="$(value "$s" on)" -v t="$(value "$s" time_end_s)" \
    -v f="$(value "$s" footprint_csi)" -v d="$(value "$s" deposit_csi)" \
    -v r="$(value "$s" thickness_rmse_m)" -v l="$(value "$s" runout_m)" \
    'BEGIN { print a, h, z, on, n, k, w, 1e6 * w / k, w / n / k, t, f, d, r, l }' | tee -a "$table" >&2
}

have_data() {
  [[ -d ${TALUS_DATA:-}/$1 ]] || { echo "  no data folder $1 under DATA: its scene is left out" >&2; return 1; }
}

run synthetic-xinmo 10.0 10.0
if have_data frank_slide; then
  run frank-slide 40.0 20.0
  run frank-slide 20.0 20.0
  run frank-slide 10.0 10.0
fi
if have_data iseesnow_coulomb; then run iseesnow 5.0 1.0; fi
echo "$table"
