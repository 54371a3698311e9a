#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# The recipes of the samples that are as hard as the world, on coarser cells and for their first seconds, through the
# three programs: what their maps and histories must hold whatever the model.
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

# coarse_scene NAME CELL SECONDS: terrain of that cell [m] and the scene's recipe, here; then all three stages.
coarse_scene() {
  expect_exit 0 "$bin/talus-make-terrain" "$1" --cell "$2" --out "$TALUS_SCRATCH/terrain"
  sed -e "s,../../data_samples/$1,$TALUS_SCRATCH/terrain,; s/^end_time_s.*/end_time_s = $3/" \
    "$TALUS_SOURCE/pipelines/$1/recipe.toml" >recipe.toml
  [[ $(grep -c "$TALUS_SCRATCH/terrain" recipe.toml) -eq 2 ]] || fail "the recipe of $1 names other files"
  expect_exit 0 "$bin/talus-preprocess" recipe.toml --out out
  expect_exit 0 "$bin/talus-solve" recipe.toml --out out --on cpu
  ! grep -i warning stderr || fail "the solver warns of the recipe of $1"
  expect_exit 0 "$bin/talus-postprocess" recipe.toml --out out
}

# expect_sane NAME CELL: volume closed; no speed beyond that of a fall from the highest released surface; the map holds
# what was released, and it has moved; its points are no denser than chance and their weight make them.
expect_sane() {
  PYTHONPATH=$TALUS_SOURCE/tests/pipeline /usr/bin/python3 -B - out "$1" "$2" >stdout 2>stderr <<'PYTHON' ||
import csv, sys
import numpy as np
import packing
from osgeo import gdal
gdal.UseExceptions()
out, name, cell = sys.argv[1], sys.argv[2], float(sys.argv[3])
def grid(path):
    return gdal.Open(path).ReadAsArray().astype(float)
with open(f"{out}/history.csv") as file:
    rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
bed, release = grid("terrain/dem.tif"), grid("terrain/release_thickness.tif")
deposit, speed = grid(f"{out}/maps/deposit_thickness.tif"), grid(f"{out}/maps/peak_speed.tif")
deposit, speed = (np.where(map > -9998, map, 0) for map in (deposit, speed))
released = release.sum() * cell * cell
faults = []
def check(what, holds, value):
    print(f"{what}: {value:.6g}")
    if not holds:
        faults.append(what)
left = rows[-1]["outflow_m3"]
end, on_map = rows[-1]["volume_m3"], deposit.sum() * cell * cell
# The rasters are in single precision.
check("volume lost", abs(end + left - released) < 1e-7 * released, end + left - released)
check("volume on the map", abs(on_map + left - released) < 1e-6 * released, on_map)
top = (bed + release)[release > 0].max()
fall = np.sqrt(2 * 9.81 * np.maximum(top - bed, 0))
fastest = max(row["speed_max_m_s"] for row in rows)
check("largest speed over that of the deepest fall", fastest < fall.max(), fastest / fall.max())
here = (speed > 0) & (top - bed > 20)
check("mean speed over that of the fall to where it was", (speed <= fall)[here].all(), (speed[here] / fall[here]).max())
check("it moved", speed.max() > 8, speed.max())
faults += packing.faults(out)
print(faults)
sys.exit(bool(faults))
PYTHON
    fail "the run of $1 is not sane"
}

hard_sample_runs() {
  /usr/bin/python3 -c 'from osgeo import gdal' 2>/dev/null || need_tool python3-gdal
  coarse_scene "$@"
  expect_sane "$1" "$2"
}

test_rough_slope_runs() { hard_sample_runs rough-slope 8 8; }
test_bent_gully_runs() { hard_sample_runs bent-gully 8 25; }
test_cliff_bench_runs() { hard_sample_runs cliff-bench 5 10; }
test_thinning_slide_runs() { hard_sample_runs thinning-slide 10 45; }

# What enters by the hydrograph of the recipe is what the run holds and the section below its line has counted.
test_gully_inflow_runs() {
  cp -r "$TALUS_SOURCE/pipelines/gully-inflow" "$TALUS_SCRATCH/scene"
  sed -i -e "s,../../data_samples,$TALUS_SOURCE/data_samples,; s/^end_time_s.*/end_time_s = 40/" scene/recipe.toml
  expect_exit 0 "$bin/talus-preprocess" scene/recipe.toml --out out
  expect_words 'nothing is released: all that moves enters over time'
  expect_exit 0 "$bin/talus-solve" scene/recipe.toml --out out --on cpu
  expect_words 'the run ends at 40 s, before 1103 m3 of its hydrograph have entered'
  expect_exit 0 "$bin/talus-postprocess" scene/recipe.toml --out out
  /usr/bin/python3 -B - out <<'PYTHON' || fail "what entered is not what is there"
import csv, sys
with open(f"{sys.argv[1]}/history.csv") as file:
    rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
last = rows[-1]
# The integral of hydrograph.csv until 40 s.
entered = 300 + 1470 + 400 + 300 + 8 * 110 - 0.5 * 8 * 8 * 85 / 23
# The file has nine digits.
print(entered, last["inflow_m3"], last["volume_m3"], last["section_below-the-line_passed_m3"])
assert rows[0]["volume_m3"] == 0
assert abs(last["inflow_m3"] / entered - 1) < 1e-8
assert abs(last["volume_m3"] + last["outflow_m3"] - last["inflow_m3"]) < 2e-8 * entered
# Between line and section, 10 m apart, is what enters in two to three seconds.
assert 0 <= last["inflow_m3"] - last["section_below-the-line_passed_m3"] < 250
PYTHON
}

test_terrains_without_axes_of_their_own_cannot_be_turned() {
  expect_exit 2 "$bin/talus-make-terrain" valley --turn 30 --out "$TALUS_SCRATCH/terrain"
  expect_words 'cannot be mirrored or turned' 'rough-slope'
  expect_no_file "$TALUS_SCRATCH/terrain"
}

run_test "$@"
