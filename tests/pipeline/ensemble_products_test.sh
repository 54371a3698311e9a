#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# The results of an ensemble from outside: read by tools that are not ours, its page in a real browser, and what
# talus run and make do when members or counts change.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

# valley [MEMBERS] [DESIGN]: the valley of data_samples on cells of 20 m, its members differing in two frictions and in
# the released thickness.
valley() {
  local samples=$TALUS_SOURCE/data_samples/valley
  cat >recipe.toml <<TOML
[scene]
name = "valley"
title = "Valley of members"

[preprocess]
before_dem = "$samples/before_dem.tif"
after_dem = "$samples/after_dem.tif"

[preprocess.source]
threshold_m = 0.5

[preprocess.grid]
spacing_m = 20.0
layer_height_m = 10.0

[solve]
end_time_s = 40.0
stop_kinetic_fraction = 0.001

[solve.material]
friction_angle_deg = 35.0

[solve.base]
law = "coulomb"
friction_angle_deg = 22.0

[postprocess.survey]
name = "surveyed change"
before_dem = "$samples/before_dem.tif"
after_dem = "$samples/after_dem.tif"

[ensemble]
members = ${1:-24}
design = "${2:-latin-hypercube}"

[ensemble.thresholds]
arrival_s = [10.0, 20.0]

[[ensemble.vary]]
key = "solve.base.friction_angle_deg"
low = 14.0
high = 30.0

[[ensemble.vary]]
key = "preprocess.thickness_factor"
low = 0.7
high = 1.3

[[ensemble.vary]]
key = "solve.material.friction_angle_deg"
low = 30.0
high = 40.0
TOML
}

# run [...]: the three stages of the valley.
run() {
  valley "$@"
  expect_exit 0 preprocess
  expect_exit 0 solve
  expect_exit 0 postprocess
}

test_is_made() {
  run
  expect_stdout_paths
}

test_page_opens_and_answers_in_a_browser() {
  need_browser
  made
  expect_exit 0 /usr/bin/python3 "$TALUS_SOURCE/tests/pipeline/ensemble_browser.py" out/ensemble.html
  local size
  size=$(stat -c %s out/ensemble.html)
  [[ $size -lt 4000000 ]] || fail "a page of 24 members has $size bytes"
}

test_maps_are_read_by_gdal_with_threshold_and_members() {
  need_tool gdalinfo
  made
  expect_exit 0 gdalinfo -stats out/probability/peak_thickness_above_1_m.tif
  local words
  for words in 'LAYOUT=COG' 'THRESHOLD=1' 'THRESHOLD_UNIT=m' 'MEMBERS_COUNTED=24' 'MEMBERS_FAILED=0' \
    'DESIGN=latin-hypercube' 'STATISTICS_MAXIMUM=1'; do
    grep -qF "$words" stdout || fail "gdalinfo does not say $words"
  done
  awk -F, 'NR == 1 { for (c = 1; c <= NF; ++c) at[$c] = c; next }
    { if (!($at["run_out_m"] > 0 && $at["footprint_csi"] > 0 && $at["footprint_csi"] < 1)) exit 1
      if (!($at["p99_speed_m_s"] > 0 && $at["p99_speed_m_s"] <= $at["largest_speed_m_s"])) exit 1
      n += 1 }
    END { exit n != 24 }' out/members.csv || fail "members.csv: $(head -3 out/members.csv)"
  expect_exit 0 /usr/bin/python3 "$TALUS_SOURCE/tests/postprocess/maps/check_cf.py" out/probability.nc
}

# Opened in QGIS itself by make check-qgis.
test_project_names_layers_that_gdal_opens() {
  /usr/bin/python3 -c 'import osgeo' 2>/dev/null || need_tool python3-gdal
  made
  /usr/bin/python3 - "$PWD/out/probability" <<'PYTHON' || fail "the project names layers that are not there"
import pathlib
import sys
from osgeo import gdal
from xml.etree import ElementTree
gdal.UseExceptions()
folder = pathlib.Path(sys.argv[1])
layers = ElementTree.parse(folder / "valley-ensemble.qgs").findall("projectlayers/maplayer")
assert len(layers) > 60, f"{len(layers)} layers"
for layer in layers:
    source, _, rest = layer.find("datasource").text.partition("|")
    opened = gdal.OpenEx(str(folder / source))
    if rest:
        assert opened.GetLayerByName(rest.removeprefix("layername=")).GetFeatureCount() > 0, rest
    else:
        assert opened.RasterCount > 0, source
PYTHON
}

# Friction at the bed rules run-out in this valley, and more of it means less run-out.
test_sensitivity_finds_the_friction_that_rules_run_out() {
  made
  awk -F, '$1 == "run_out_m" && $2 == "solve.base.friction_angle_deg" && $3 == "spearman_rank_correlation" {
    found = 1; exit !($4 < -0.5 && $5 < $4 && $6 > $4) } END { exit !found }' out/sensitivity.csv ||
    fail "$(grep run_out_m out/sensitivity.csv)"
}

test_sobol_indices_come_with_a_design_for_them() {
  run 30 sensitivity
  local counted
  counted=$(grep -c ',counted,' out/members.csv)
  [[ $counted -eq 30 ]] || fail "$counted members are counted"
  awk -F, '$1 == "run_out_m" && $3 == "sobol_total" { total[$2] = $4 } $3 == "spearman_rank_correlation" { exit 1 }
    END { exit !(total["solve.base.friction_angle_deg"] > total["solve.material.friction_angle_deg"]) }' \
    out/sensitivity.csv || fail "$(grep run_out_m out/sensitivity.csv)"
}

test_counts_of_parts_give_the_same_files() {
  run 8
  mkdir whole
  cp out/members.csv out/sensitivity.csv out/probability/*.tif whole/
  rm -r out/counts.h5 out/probability out/probability.nc
  expect_exit 0 solve --members 0:3
  expect_exit 0 solve --members 3:8
  expect_exit 0 postprocess
  cut -d, -f1-7 out/members.csv | cmp - <(cut -d, -f1-7 whole/members.csv) || fail "the members differ"
  /usr/bin/python3 - <<'PYTHON' || fail "the maps of the parts are not those of the whole"
import glob
import os
import numpy
from osgeo import gdal
gdal.UseExceptions()
files = glob.glob("whole/*.tif")
assert len(files) > 50, files
for name in files:
    a, b = (gdal.Open(f).ReadAsArray() for f in (name, "out/probability/" + os.path.basename(name)))
    assert numpy.array_equal(a, b), f"{name}: {abs(a - b).max()}"
PYTHON
}

test_members_that_wait_are_told_and_the_maps_say_of_how_many_they_are() {
  valley 8
  expect_exit 0 preprocess
  expect_exit 0 solve --members 0:5
  expect_exit 0 postprocess
  expect_words '3 of 8 members have not been run: 5 to 7'
  expect_exit 0 gdalinfo out/probability/peak_thickness_mean.tif
  grep -qF 'MEMBERS_COUNTED=5' stdout || fail "the map does not say that it is of 5 members"
  [[ $(grep -c ',waiting,' out/members.csv) -eq 3 ]] || fail "$(cat out/members.csv)"
}

test_talus_run_makes_anew_what_is_stale_and_nothing_else() {
  valley 6
  expect_exit 0 "$bin/talus" run recipe.toml --out out --on cpu
  [[ -s out/probability.nc && ! -e out/run.h5 && ! -e out/score.json ]] || fail "$(ls out)"
  expect_exit 0 "$bin/talus" run recipe.toml --out out --on cpu
  expect_words 'preprocess: domain.vdb is up to date' 'solve: counts.h5 is up to date' \
    'postprocess: probability.nc is up to date'
  sed -i 's/^high = 30.0/high = 28.0/' recipe.toml
  expect_exit 0 "$bin/talus" run recipe.toml --out out --on cpu
  ! grep -q 'up to date' "$TALUS_SCRATCH/stderr" || fail "other members were drawn, and something stayed"
}

test_make_runs_an_ensemble_once() {
  mkdir -p pipelines/valley
  cp "$TALUS_SOURCE/pipelines/Makefile" pipelines/
  valley 6
  mv recipe.toml pipelines/valley/
  expect_exit 0 make -C pipelines valley BIN="$bin" OUT="$PWD/results" ON=cpu
  [[ -s results/valley/probability.nc && -s results/valley/counts.h5 ]] || fail "$(ls results/valley)"
  local made
  made=$(stat -c %y results/valley/counts.h5 results/valley/probability.nc)
  expect_exit 0 make -C pipelines valley BIN="$bin" OUT="$PWD/results" ON=cpu
  [[ $(stat -c %y results/valley/counts.h5 results/valley/probability.nc) == "$made" ]] || fail "they ran a second time"
}

run_test "$@"
