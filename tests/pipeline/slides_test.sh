#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Many slides over one model, from recipe to maps: a slide beside the same run alone, parts, edges, what is refused.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

# model: model.asc, a ridge of 90 x 60 cells of 10 m that falls off on both sides, and areas.geojson with four outlines.
model() {
  awk 'BEGIN {
    printf "ncols 90\nnrows 60\nxllcorner 500000\nyllcorner 5000000\ncellsize 10\nNODATA_value -9999\n"
    for (j = 59; j >= 0; --j) for (i = 0; i < 90; ++i) {
      x = 10 * i + 5 - 450; if (x < 0) x = -x
      printf "%.4f%s", 400 - (x < 250 ? 0.55 * x : 137.5 + 0.05 * (x - 250)) + 0.02 * j, i == 89 ? "\n" : " "
    }
  }' >model.asc
  /usr/bin/python3 - <<'PYTHON' || fail "areas.geojson"
import json
areas = [("north", 330, 420, 3.0, 16.0), ("south", 330, 150, 2.0, 20.0), ("east", 540, 300, 4.0, 14.0),
         ("next", 545, 340, 3.0, 14.0)]
features = [{"type": "Feature", "properties": {"name": n, "depth": d, "phi": p}, "geometry": {"type": "Polygon",
    "coordinates": [[[500000 + x + dx, 5000000 + y + dy] for dx, dy in ((0, 0), (35, 0), (35, 45), (0, 45), (0, 0))]]}}
    for n, x, y, d, p in areas]
json.dump({"type": "FeatureCollection", "features": features}, open("areas.geojson", "w"))
PYTHON
}

# slides [LINE...]: recipe.toml of the four, further lines of [slides] given.
slides() {
  model
  cat >recipe.toml <<'TOML'
[scene]
name = "ridge"
title = "Ridge"

[preprocess]
base_dem = "model.asc"

[preprocess.grid]
layer_height_m = 2.0

[solve]
end_time_s = 8.0

[solve.material]
friction_angle_deg = 30.0

[solve.base]
friction_angle_deg = 15.0

[slides]
outlines = "areas.geojson"
name_from = "name"
TOML
  printf '%s\n' "$@" >>recipe.toml
  cat >>recipe.toml <<'TOML'

[[slides.set]]
key = "preprocess.release[0].thickness_m"
attribute = "depth"

[[slides.set]]
key = "solve.base.friction_angle_deg"
attribute = "phi"
TOML
}

test_a_slide_is_the_run_alone_and_maps_are_of_all_slides() {
  slides 'margin_m = 180.0' '[ensemble]' 'keep = ["all"]'
  expect_exit 0 preprocess
  expect_words 'slides: 4 over'
  expect_exit 0 solve
  expect_exit 0 postprocess
  expect_stdout_paths
  # "east" by itself: its outline, its window, its friction.
  sed -i '/^\[slides\]/,$d' recipe.toml
  sed -i 's/^friction_angle_deg = 15.0/friction_angle_deg = 14.0/' recipe.toml
  /usr/bin/python3 - <<'PYTHON' || fail "no window of east"
import h5py
t = h5py.File("out/members.h5")
a, w = t["slides"].attrs, t["slides/windows"][2]
west, south, cell = a["west_m"] + w[0] * a["cell_m"], a["south_m"] + w[1] * a["cell_m"], a["cell_m"]
text = open("recipe.toml").read().replace("[preprocess.grid]\n", "[[preprocess.release]]\n"
    "polygons = \"areas.geojson|subset=name = 'east'\"\nthickness_m = 4.0\n\n[preprocess.grid]\n"
    f"extent_m = [{west}, {south}, {west + w[2] * cell}, {south + w[3] * cell}]\n")
open("recipe.toml", "w").write(text)
PYTHON
  expect_exit 0 "$bin/talus-preprocess" recipe.toml --out alone
  expect_exit 0 "$bin/talus-solve" recipe.toml --out alone --on cpu
  /usr/bin/python3 - <<'PYTHON' || fail "slides differ from runs alone, or maps from the slides"
import sys, csv
import h5py, numpy as np
from osgeo import gdal
gdal.UseExceptions()
alone, kept = h5py.File("alone/run.h5"), h5py.File("out/members/00002/run.h5")
for name in ("deposit_thickness", "peak_thickness", "peak_speed", "peak_pressure", "arrival_time"):
    if not np.array_equal(alone["maps/" + name][()], kept["maps/" + name][()], equal_nan=True):
        sys.exit(f"{name} of a slide is not that of its run alone")
table = h5py.File("out/members.h5")
a = table["slides"].attrs
rows, columns = int(a["rows"]), int(a["columns"])
for name, quantum in (("peak_thickness", 1e-3), ("peak_speed", 1e-2), ("peak_pressure", 1e-2)):
    largest, count = np.zeros((rows, columns)), np.zeros((rows, columns), int)
    for k, (c, r, w, h) in enumerate(table["slides/windows"][()]):
        values = h5py.File(f"out/members/{k:05}/run.h5")["maps/" + name][()].reshape(h, w)
        values = np.nan_to_num(values)
        part = (slice(r, r + h), slice(c, c + w))
        largest[part] = np.maximum(largest[part], values)
        count[part] += values >= 0.5
    read = gdal.Open(f"out/slides/largest_{name}.tif").ReadAsArray()[::-1].astype(float)
    read[read == -9999] = 0
    # Half a quantum of the counts, and single precision in the file.
    if not np.all(np.abs(read - largest) <= 0.5 * quantum + 1e-6 * largest):
        sys.exit(f"largest {name}: off by {np.max(np.abs(read - largest))}")
    if largest.max() <= 0: sys.exit("nothing moved")
    if name == "peak_thickness":
        number = gdal.Open("out/slides/number_peak_thickness_above_0.5_m.tif").ReadAsArray()[::-1]
        share = gdal.Open("out/slides/share_peak_thickness_above_0.5_m.tif").ReadAsArray()[::-1].astype(float)
        number[number == -9999] = 0
        share[share == -9999] = 0
        if not np.array_equal(number, count): sys.exit("the number of slides is another")
        if count.max() < 2: sys.exit("no two slides come to one place")
        if not np.allclose(share, count / 4, atol=1e-7): sys.exit("the share of slides is another")
found = list(csv.DictReader(open("out/slides.csv")))
if [row["name"] for row in found] != ["north", "south", "east", "next"]: sys.exit(f"names: {found}")
if [float(row["preprocess.release[0].thickness_m"]) for row in found] != [3, 2, 4, 3]: sys.exit("inputs of the table")
for row in found:
    if row["state"] != "counted" or not float(row["largest_speed_m_s"]) > 0: sys.exit(f"row {row}")
    for what in ("thickness_m", "deposit_m", "speed_m_s", "pressure_kPa"):
        if not 0 < float(row[f"p99_{what}"]) <= float(row[f"largest_{what}"]): sys.exit(f"{what} of row {row}")
PYTHON
  /usr/bin/python3 - <<'PYTHON' || fail "slides.nc is not slides.csv"
import csv, sys
import netCDF4
import numpy as np
found = list(csv.DictReader(open("out/slides.csv")))
nc = netCDF4.Dataset("out/slides.nc")["slides"]
if list(nc["name"][:]) != ["north", "south", "east", "next"]: sys.exit("names in slides.nc")
if not np.allclose(nc["run_out_m"][:], [float(row["run_out_m"]) for row in found]): sys.exit("run_out_m differs")
PYTHON
  [[ $(ogrinfo -so out/slides/slides.gpkg flow | grep 'Feature Count') == 'Feature Count: 4' ]] ||
    fail "there are not four outlines"
  [[ -s out/slides.html && -s out/slides/ridge-slides.qgs ]] || fail "no page or no project: $(ls out out/slides)"
}

test_page_of_slides_opens_in_a_browser() {
  need_browser
  slides 'margin_m = 180.0'
  expect_exit 0 preprocess
  expect_exit 0 solve
  expect_exit 0 postprocess
  expect_exit 0 /usr/bin/python3 "$TALUS_SOURCE/tests/pipeline/ensemble_browser.py" out/slides.html
}

test_parts_of_slides_add_up_to_the_whole() {
  slides 'margin_m = 180.0'
  expect_exit 0 preprocess
  expect_exit 0 solve --plan
  [[ ! -e out/counts.h5 ]] || fail "a plan computes"
  expect_exit 0 solve
  mv out/counts.h5 whole.h5
  expect_exit 0 solve --members 0:1
  expect_exit 0 solve --members 1:4
  expect_exit 0 postprocess
  mv out/slides parts
  mv whole.h5 out/counts.h5
  rm out/counts.*-*.h5
  expect_exit 0 postprocess
  local map
  for map in out/slides/*.tif; do
    /usr/bin/python3 - "$map" "parts/${map##*/}" <<'PYTHON' || fail "$map is another from parts"
import sys
import numpy as np
from osgeo import gdal
a, b = (gdal.Open(name).ReadAsArray() for name in sys.argv[1:])
sys.exit(not np.array_equal(a, b))
PYTHON
  done
}

test_killed_slides_go_on() {
  slides 'margin_m = 180.0'
  expect_exit 0 preprocess
  expect_exit 0 solve
  mv out/counts.h5 whole.h5
  interrupt KILL 'out/unfinished.0-4.h5' "$bin/talus-solve" recipe.toml --out out --on cpu --threads 1
  [[ ! -e out/counts.h5 ]] || fail "slides that were killed look finished"
  expect_exit 3 solve
  expect_words 'finished members of this very ensemble'
  expect_exit 0 solve --restart
  expect_words 'going on from out/unfinished.0-4.h5'
  [[ ! -e out/unfinished.0-4.h5 ]] || fail "finished slides lie about"
  local object
  for object in /maps /members/state /members/flow /members/deposit /members/results/run_out_m; do
    expect_exit 0 h5diff whole.h5 out/counts.h5 $object
  done
}

test_a_slide_at_the_edge_of_its_domain_is_named_or_fails() {
  slides 'margin_m = 30.0' '[ensemble]' 'failed_share = 1.0'
  expect_exit 0 preprocess
  expect_exit 0 solve
  expect_words 'came to the edge of their domain' 'Give a larger margin_m'
  expect_exit 0 postprocess
  expect_words 'came to the edge of their domain'
  awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == "edge_cells") at = i }
    NR > 1 && $at > 0 { ++n } END { exit !n }' out/slides.csv || fail "no row says so: $(cat out/slides.csv)"
  sed -i 's/^margin_m.*/margin_m = 30.0\nat_edge = "fail"/' recipe.toml
  expect_exit 0 preprocess
  expect_exit 0 solve
  expect_words 'it came to the edge of its domain'
  rm -r out
  sed -i 's/^failed_share.*/failed_share = 0.0/' recipe.toml
  expect_exit 0 preprocess
  expect_exit 4 solve
}

test_what_cannot_be_is_refused_with_its_place() {
  slides 'margin_m = 100.0'
  sed -i 's/"depth": 2.0/"depth": null/' areas.geojson
  expect_exit 3 preprocess
  expect_words 'feature 1: attribute depth is NULL'
  [[ ! -e out/members.h5 && ! -e out/domain.vdb ]] || fail "something was written"
  sed -i 's/"depth": null/"depth": 2.0/' areas.geojson
  printf '\n[ensemble]\nmembers = 3\n[ensemble.elevation_error]\nfrom_survey = true\n' >>recipe.toml
  expect_exit 2 preprocess
  expect_words '[slides] beside [ensemble] with members of its own'
}

# 20,000 x 20,000 cells as numbers would be 3.2 GB; two slides lie in opposite corners of it.
test_a_model_that_is_larger_than_memory_is_read_by_parts() {
  slides 'margin_m = 200.0'
  /usr/bin/python3 - <<'PYTHON' || fail "no large model"
import json
import numpy as np
from osgeo import gdal
gdal.UseExceptions()
n = 20000
d = gdal.GetDriverByName("GTiff").Create("model.tif", n, n, 1, gdal.GDT_Float32, ["TILED=YES", "SPARSE_OK=TRUE"])
d.SetGeoTransform([500000, 10, 0, 5000000 + 10 * n, 0, -10])
features = []
for name, column, line in (("north west", 300, 300), ("south east", 19600, 19600)):
    heights = 800 - 4.0 * np.arange(200)[None, :] + np.zeros((200, 1))
    d.GetRasterBand(1).WriteArray(heights.astype(np.float32), column - 100, line - 100)
    x, y = 500000 + 10 * column, 5000000 + 10 * (n - line)
    ring = [[x + dx, y + dy] for dx, dy in ((0, 0), (50, 0), (50, 50), (0, 50), (0, 0))]
    features.append({"type": "Feature", "properties": {"name": name, "depth": 3, "phi": 15},
                     "geometry": {"type": "Polygon", "coordinates": [ring]}})
d = None
json.dump({"type": "FeatureCollection", "features": features}, open("areas.geojson", "w"))
PYTHON
  sed -i 's/model.asc/model.tif/' recipe.toml
  /usr/bin/python3 - "$bin" <<'PYTHON' || fail "a stage fails, or takes too much memory"
import resource, subprocess, sys
for stage in (["preprocess"], ["solve", "--on", "cpu"], ["postprocess"]):
    command = [f"{sys.argv[1]}/talus-{stage[0]}", "recipe.toml", "--out", "out"] + stage[1:]
    if subprocess.run(command).returncode: sys.exit(f"{stage[0]} fails")
    largest = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1000
    if largest > 1200: sys.exit(f"{stage[0]} takes {largest:.0f} MB")  # a map of the model as numbers is 3200
    print(f"{stage[0]}: {largest:.0f} MB", file=sys.stderr)
PYTHON
  /usr/bin/python3 - <<'PYTHON' || fail "maps of the large model"
import os, sys
import numpy as np
from osgeo import gdal
gdal.UseExceptions()
d = gdal.Open("out/slides/largest_peak_thickness.tif")
band = d.GetRasterBand(1)
if min(d.RasterXSize, d.RasterYSize) < 19000: sys.exit("it does not hold both slides")
if os.path.getsize("out/slides/largest_peak_thickness.tif") > 3e6: sys.exit("empty tiles are written")
coarse = band.GetOverview(band.GetOverviewCount() - 1)
fine = max(band.ReadAsArray(0, 0, 400, 400).max(), 0)
if not fine > 1: sys.exit("the first slide is not there")
if not band.GetOverviewCount() >= 4: sys.exit("no overviews")
values = coarse.ReadAsArray()
quarter = values[:values.shape[0] // 4, :values.shape[1] // 4]
if quarter.max() != fine: sys.exit(f"an overview has {quarter.max()}, the map {fine}")
PYTHON
}

test_check_says_what_will_be_and_writes_nothing() {
  slides
  expect_exit 0 preprocess --check
  expect_words 'slides: 4 over' 'below a line at 11 degrees'
  [[ ! -e out/members.h5 ]] || fail "a check writes"
}

run_test "$@"
