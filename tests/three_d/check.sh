#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Opens what talus-postprocess writes into 3d/ with the programs that it is for: ParaView, OpenVDB's Python, Blender.
# Each looks at times, places and sums, and ParaView and Blender draw pictures that are compared with those that lie
# here. make check-three-d installs these programs and calls this.
# usage: tests/three_d/check.sh BIN WORK [RECIPE [SET...]]   programs; folder for the run; recipe (the synthetic valley)
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
bin=$(realpath "${1:?usage: tests/three_d/check.sh BIN WORK [RECIPE]}")
work=$(realpath -m "${2:?usage: tests/three_d/check.sh BIN WORK [RECIPE]}")
recipe=$(realpath "${3:-$here/../../pipelines/synthetic-valley/recipe.toml}")
pictures=compare
[[ $# -lt 3 ]] || pictures=draw   # of another scene there are none to compare with
sets=()
for key in points volumes surface terrain; do sets+=(--set "postprocess.three_d.$key=true"); done
for set in "${@:4}"; do sets+=(--set "$set"); done

mkdir -p "$work"
"$bin/talus-preprocess" "$recipe" --out "$work" "${sets[@]}" >"$work/log.txt" 2>&1 || { cat "$work/log.txt"; exit 1; }
[[ -f $work/run.h5 && -z ${TALUS_RUN_AGAIN:-} ]] ||
  "$bin/talus-solve" "$recipe" --out "$work" --on cpu "${sets[@]}" >"$work/log.txt" 2>&1 ||
  { cat "$work/log.txt"; exit 1; }
"$bin/talus-postprocess" "$recipe" --out "$work" "${sets[@]}" >"$work/log.txt" 2>&1 || { cat "$work/log.txt"; exit 1; }
grep -E '3d' "$work/log.txt" || true

echo '== OpenVDB'
/usr/bin/python3 "$here/check_volumes.py" "$work"
echo '== ParaView'
xvfb-run -a pvpython "$here/check_paraview.py" "$work" "$here" $pictures
echo '== Blender'
blender -b -noaudio --python-exit-code 1 -P "$here/check_blender.py" -- "$work" "$here" $pictures |
  grep -vE '^(Fra:|Blender |$)' || true
[[ -f $work/blender.png ]] || { echo "Blender drew no picture"; exit 1; }
echo "3d/ opens in all of them; pictures: $work/paraview.png $work/blender.png"
