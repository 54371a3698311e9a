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
compare=yes
[[ $# -lt 3 ]] || compare=no   # of another scene there is no picture to compare with
sets=()
for key in points volumes surface terrain; do sets+=(--set "postprocess.three_d.$key=true"); done
for set in "${@:4}"; do sets+=(--set "$set"); done

mkdir -p "$work"
"$bin/talus-preprocess" "$recipe" --out "$work" "${sets[@]}" >"$work/log.txt" 2>&1 || { cat "$work/log.txt"; exit 1; }
[[ -f $work/run.h5 && -z ${TALUS_RUN_AGAIN:-} ]] ||
  "$bin/talus-solve" "$recipe" --out "$work" --on cpu "${sets[@]}" >"$work/log.txt" 2>&1 ||
  { cat "$work/log.txt"; exit 1; }
"$bin/talus-postprocess" "$recipe" --out "$work" "${sets[@]}" >"$work/log.txt" 2>&1 || { cat "$work/log.txt"; exit 1; }
grep -E ' MB' "$work/log.txt" || true

echo '== OpenVDB'
/usr/bin/python3 "$here/check_volumes.py" "$work"
echo '== ParaView'
pvpython "$here/check_paraview.py" "$work"
xvfb-run -a pvpython "$here/draw_paraview.py" "$work"
echo '== Blender'
rm -f "$work/blender.png"
blender -b -noaudio --python-exit-code 1 -P "$here/check_blender.py" -- "$work" >"$work/blender.txt" 2>&1 ||
  { cat "$work/blender.txt"; exit 1; }
grep '^Blender .* flow' "$work/blender.txt"
if [[ $compare == yes ]]; then
  for program in paraview blender; do
    /usr/bin/python3 "$here/same_picture.py" "$work/$program.png" "$here/$program.png"
  done
fi
echo "3d/ opens in all of them; pictures: $work/paraview.png $work/blender.png"
