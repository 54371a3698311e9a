#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Opens the files of 3d/ in ParaView: times, places and sums are compared with run.h5, and a picture with the one in
# this folder. make check-three-d installs ParaView and calls this script.
# usage: tests/three_d/check.sh BIN WORK [RECIPE [SET...]]   programs; folder for the run; recipe (the synthetic valley)
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
bin=$(realpath "${1:?usage: tests/three_d/check.sh BIN WORK [RECIPE]}")
work=$(realpath -m "${2:?usage: tests/three_d/check.sh BIN WORK [RECIPE]}")
recipe=$(realpath "${3:-$here/../../pipelines/synthetic-valley/recipe.toml}")
compare=yes
[[ $# -lt 3 ]] || compare=no   # of another scene there is no picture to compare with
sets=()
for key in points surface terrain; do sets+=(--set "postprocess.three_d.$key=true"); done
for set in "${@:4}"; do sets+=(--set "$set"); done

mkdir -p "$work"
"$bin/talus-preprocess" "$recipe" --out "$work" "${sets[@]}" >"$work/log.txt" 2>&1 || { cat "$work/log.txt"; exit 1; }
[[ -f $work/run.h5 && -z ${TALUS_RUN_AGAIN:-} ]] ||
  "$bin/talus-solve" "$recipe" --out "$work" --on cpu "${sets[@]}" >"$work/log.txt" 2>&1 ||
  { cat "$work/log.txt"; exit 1; }
"$bin/talus-postprocess" "$recipe" --out "$work" "${sets[@]}" >"$work/log.txt" 2>&1 || { cat "$work/log.txt"; exit 1; }
grep -E ' MB' "$work/log.txt" || true

pvpython "$here/check_paraview.py" "$work"
xvfb-run -a pvpython "$here/draw_paraview.py" "$work"
[[ $compare == no ]] || /usr/bin/python3 "$here/same_picture.py" "$work/paraview.png" "$here/paraview.png"
echo "3d/ opens in ParaView; picture: $work/paraview.png"
