#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# What an authority asks, through the three programs: a gauge, a section, a building, a wall, intensities, a cone; its
# files read by tools that are not ours.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

hazard_scene() {
  scene
  printf 'id,WKT\n1,"POLYGON((500100 5000050,500104 5000050,500104 5000150,500100 5000150,500100 5000050))"\n' >wall.csv
  local school='500085 5000096,500093 5000096,500093 5000105,500085 5000105,500085 5000096'
  printf 'name,height,WKT\nschool,6,"POLYGON((%s))"\n' "$school" >buildings.csv
  sed -i 's/^end_time_s.*/end_time_s = 12.0/' recipe.toml
  local wall='[[preprocess.obstacle]]\nname = "wall"\npolygons = "wall.csv"\nheight_m = 15.0'
  sed -i "s/^\[preprocess.grid\]/$wall\n\n&/" recipe.toml
  cat >>recipe.toml <<'TOML'

[postprocess.intensity]
guideline = "swiss-debris-flow"

[postprocess.reach_cone]
angle_deg = 12.0

[postprocess.buildings]
polygons = "buildings.csv"

[[solve.obstacle]]
name = "wall"

[[solve.gauge]]
name = "bridge"
at_m = [500075.0, 5000100.0]

[[solve.section]]
name = "below"
line_m = [[500080.0, 5000020.0], [500080.0, 5000180.0]]
TOML
}

# column FILE NAME: the values of a column of a table.
column() {
  awk -F, -v name="$2" 'NR == 1 { for (c = 1; c <= NF; ++c) if ($c == name) at = c; if (!at) exit 1; next }
    { print $at }' "$1"
}

test_everything_that_is_asked_comes_out() {
  need_tool ogrinfo
  hazard_scene
  expect_exit 0 preprocess
  expect_exit 0 solve
  expect_words "section below: "
  expect_exit 0 postprocess
  local file
  for file in gauges.csv sections.csv buildings.csv history.nc maps/intensity.tif maps/intensity.qml \
    maps/reach_cone.tif maps/reach_cone.qml maps/reach.gpkg maps/buildings.gpkg; do
    [[ -s out/$file ]] || fail "no $file"
  done
  grep -q '^school,' out/buildings.csv || fail "no school: $(<out/buildings.csv)"
  column out/sections.csv passed_m3 | tail -1 | awk '{ exit !($1 > 100 && $1 < 6400) }' ||
    fail "of 6400 m3 some passed: $(tail -1 out/sections.csv)"
  # The integral of the discharge is what passed.
  awk -F, 'NR == 1 { for (c = 1; c <= NF; ++c) at[$c] = c; next }
    { sum += $at["discharge_m3_s"] * ($at["time_s"] - before); before = $at["time_s"]; passed = $at["passed_m3"] }
    END { d = sum - passed; exit !(d < 0.01 && d > -0.01) }' out/sections.csv || fail "the discharge is not what passed"
  awk -F, '$1 == "wall" { exit !($10 > 1e5 && $11 == "obstacle") }' out/buildings.csv ||
    fail "the wall's force was not counted: $(<out/buildings.csv)"
  ogrinfo -al out/maps/buildings.gpkg buildings | grep -q 'name (String) = school' || fail "no school on the map"
  ogrinfo -al out/maps/buildings.gpkg obstacles | grep -q 'name (String) = wall' || fail "no wall on the map"
  ogrinfo -al out/maps/reach.gpkg | grep -q 'angle_deg (Real) = 12' || fail "no cone of 12 degrees"
  gdalinfo -mm out/maps/intensity.tif | grep -q 'Min/Max=0.000,3.000' ||
    fail "intensities: $(gdalinfo -mm out/maps/intensity.tif)"
  grep -q '"reach_given_angle_deg": 12' out/score.json || fail "the score does not say the angle"
  grep -q '"p99_peak_speed_m_s"' out/score.json || fail "no percentile beside the largest speed"
  grep -q 'intensity.tif' out/maps/bowl.qgs || fail "the project does not show the intensities"
}

test_what_is_no_longer_asked_goes() {
  hazard_scene
  expect_exit 0 preprocess
  expect_exit 0 solve
  expect_exit 0 postprocess
  sed -i '/^\[postprocess.intensity\]/,/^polygons = "buildings.csv"/d' recipe.toml
  expect_exit 0 postprocess
  [[ ! -e out/maps/intensity.tif && ! -e out/maps/reach.gpkg ]] || fail "older maps lie beside new ones"
  grep -q wall out/buildings.csv || fail "the wall stands whatever is asked"
}

test_wrong_polygons_are_named() {
  hazard_scene
  expect_exit 0 preprocess
  expect_exit 0 solve
  sed -i 's/buildings.csv/houses.gpkg/' recipe.toml
  expect_exit 3 postprocess
  expect_words "houses.gpkg: no such file"
}

run_test "$@"
