#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Sections, gauges and the line of an inflow from vector files: read by talus-preprocess, asked for by talus-solve.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

# places_scene: the bowl in UTM, lines and points in a GeoPackage of two layers, in degrees.
places_scene() {
  need_tool ogr2ogr
  scene
  local model
  for model in before after survey; do gdal_translate -q -a_srs EPSG:32611 $model.asc $model.tif; done
  sed -i 's/\.asc"/.tif"/' recipe.toml
  cat >sections.csv <<'CSV'
name,state,WKT
below,built,"LINESTRING(500080 5000020,500080 5000180)"
far side,built,"LINESTRING(500120 5000020,500120 5000180)"
plan,planned,"POLYGON((500120 5000020,500120 5000180,500130 5000180,500120 5000020))"
CSV
  printf 'label,WKT\nbridge,POINT(500075 5000100)\n' >gauges.csv
  local degrees=(-f GPKG -s_srs EPSG:32611 -t_srs EPSG:4326)
  ogr2ogr -q "${degrees[@]}" -nlt GEOMETRY -nln sections places.gpkg sections.csv
  ogr2ogr -q -update -append "${degrees[@]}" -nln gauges places.gpkg gauges.csv
  cat >>recipe.toml <<'TOML'

[[preprocess.place]]
name = "sections"
file = "places.gpkg|layername=sections|subset=state = 'built'"

[[preprocess.place]]
name = "gauges"
file = "places.gpkg|layername=gauges"
attribute = "label"

[[solve.section]]
place = "sections"

[[solve.gauge]]
place = "gauges"
TOML
}

test_lines_and_points_of_a_geopackage_are_those_of_the_recipe() {
  places_scene
  expect_exit 0 preprocess --check
  expect_words "brought from EPSG:4326 to EPSG:32611"
  expect_words 'place "sections": 2 lines of'
  expect_words '"far side" is called far-side here'
  [[ ! -e out/domain.vdb ]] || fail "--check wrote the domain"
  expect_exit 0 preprocess
  expect_exit 0 solve --check
  expect_exit 0 solve
  expect_words "section below: "
  expect_words "section far-side: "
  expect_exit 0 postprocess
  grep -q 'section below' out/report.html || fail "the report does not know the section"
  cp out/sections.csv sections-by-file.csv && cp out/gauges.csv gauges-by-file.csv
  grep -Eq '^line_m = \[\[500(080|079[.]9)' out/solve.used.toml ||
    fail "the used recipe lacks the coordinates: $(<out/solve.used.toml)"
  grep -q 'places.gpkg.*[0-9a-f]\{64\}' out/preprocess.used.toml || fail "the file has no checksum"
  sed -i '/^\[\[preprocess.place\]\]/,$d' recipe.toml
  cat >>recipe.toml <<'TOML'
[[solve.section]]
name = "below"
line_m = [[500080.0, 5000020.0], [500080.0, 5000180.0]]

[[solve.section]]
name = "far-side"
line_m = [[500120.0, 5000020.0], [500120.0, 5000180.0]]

[[solve.gauge]]
name = "bridge"
at_m = [500075.0, 5000100.0]
TOML
  expect_exit 0 preprocess
  expect_exit 0 solve
  expect_exit 0 postprocess
  # There and back through degrees a place moves by less than a micrometre.
  local table
  for table in sections gauges; do
    [[ $(head -1 out/$table.csv) == $(head -1 $table-by-file.csv) ]] || fail "other columns of $table.csv"
    paste -d, out/$table.csv $table-by-file.csv | awk -F, 'NR > 1 { for (c = 1; c <= NF / 2; ++c) {
        d = $c - $(c + NF / 2); if (d > 1e-3 || d < -1e-3) { print; exit 1 } } }' ||
      fail "$table.csv differs"
  done
}

test_an_inflow_enters_through_a_line_of_a_file() {
  inflow_scene
  expect_exit 0 preprocess
  expect_exit 0 solve
  expect_words "inflow inlet-1: 180 m3" "section below: "
}

test_what_is_wrong_is_told_by_file_and_feature() {
  places_scene
  sed -i "s/subset=.*/subset=state <> 'x'\"/" recipe.toml
  expect_exit 3 preprocess
  expect_words "places.gpkg, feature 3: it is a POLYGON (a line or a point is wanted)"
  sed -i "s/subset=.*/subset=state = 'none'\"/" recipe.toml
  expect_exit 3 preprocess
  expect_words "no feature in layer \"sections\" whose attributes meet state = 'none'"
  sed -i "s/subset=.*/subset=state = 'built'\"/; s/layername=gauges/layername=gauge/" recipe.toml
  expect_exit 3 preprocess
  expect_words 'no layer "gauge" in it (it has sections, gauges)'
  sed -i 's/layername=gauge"/layername=gauges"/; s/^place = "sections"/place = "section"/' recipe.toml
  expect_exit 0 preprocess
  expect_exit 2 solve --check
  expect_words '[[solve.section]] number 1: place = "section" (domain.vdb has the places sections, gauges)'
  sed -i '/^\[\[solve.section\]\]/,/^place/d' recipe.toml
  expect_exit 0 solve --check
  expect_words '[[preprocess.place]] "sections" is not asked for'
}

# inflow_scene: nothing is released, and what enters does so through a line of a file, where sections are taken too.
inflow_scene() {
  scene
  sed -i -e '/^after_dem/d; s/^before_dem.*/base_dem = "before.asc"\nno_release = true/' recipe.toml
  sed -i '/^\[postprocess.survey\]/,$d' recipe.toml
  printf 'id,WKT\n7,"LINESTRING(500040 5000080,500040 5000120)"\n' >inlet.csv
  printf 'name,WKT\nbelow,"LINESTRING(500060 5000020,500060 5000180)"\n' >sections.csv
  cat >>recipe.toml <<'TOML'
[[preprocess.place]]
name = "inlet"
file = "inlet.csv"

[[preprocess.place]]
name = "sections"
file = "sections.csv"

[[solve.section]]
place = "sections"

[[solve.inflow]]
place = "inlet"
hydrograph = [[0.0, 60.0], [3.0, 60.0]]
speed_m_s = 4.0
TOML
}

test_members_of_an_ensemble_and_of_a_budget_know_the_places() {
  inflow_scene
  cp recipe.toml alone.toml
  cat >>recipe.toml <<'TOML'

[ensemble]
members = 2
keep = ["1"]

[[ensemble.vary]]
key = "solve.inflow[0].scale"
low = 0.5
high = 1.5
TOML
  expect_exit 0 preprocess
  expect_exit 0 solve
  expect_words "2 members counted, 0 failed"
  cp alone.toml recipe.toml
  printf '\n[ensemble]\ndesign = "budget"\n[ensemble.budget]\nleave_out = ["cells", "modulus"]\n%s\n%s\n%s\n' \
    '[[ensemble.budget.run]]' 'name = "half"' 'set = ["solve.inflow[0].scale=0.5"]' >>recipe.toml
  expect_exit 0 "$bin/talus-preprocess" recipe.toml --out budget
  expect_exit 0 "$bin/talus-solve" recipe.toml --out budget --on cpu
  expect_words " members counted, 0 failed"
}

test_a_run_at_places_goes_on_from_its_checkpoint() {
  inflow_scene
  sed -i 's/^end_time_s.*/end_time_s = 60.0\ncheckpoint_interval_s = 2.0/' recipe.toml
  expect_exit 0 preprocess
  interrupt INT out/checkpoint.h5 "$bin/talus-solve" recipe.toml --out out --on cpu
  expect_exit 0 solve --restart
  expect_exit 0 solve --set solve.end_time_s=3.0
}

test_talus_makes_the_domain_again_when_the_file_changes() {
  inflow_scene
  expect_exit 0 "$bin/talus" run recipe.toml --out out --on cpu
  expect_exit 0 "$bin/talus" run recipe.toml --out out --on cpu
  grep -q '^preprocess: domain.vdb is up to date' stderr || fail "it is not up to date: $(<stderr)"
  sed -i 's/500060/500080/g' sections.csv
  expect_exit 0 "$bin/talus" run recipe.toml --out out --on cpu
  ! grep -q '^preprocess: domain.vdb is up to date' stderr || fail "the changed file was not seen: $(<stderr)"
  ! grep -q '^solve: .*up to date' stderr || fail "the changed file was not seen: $(<stderr)"
}

test_the_file_is_an_input() {
  places_scene
  expect_exit 0 preprocess
  [[ $(grep -c '^# input: .*/places.gpkg  sha256 ' out/preprocess.used.toml) -eq 1 ]] ||
    fail "the file is not listed once: $(grep '^# input' out/preprocess.used.toml)"
  cp out/domain.vdb first.vdb
  local first second
  first=$(sed -n 's/^# id: //p' out/preprocess.used.toml)
  ogr2ogr -q -f GPKG -update -append -nln gauges -s_srs EPSG:32611 -t_srs EPSG:4326 places.gpkg gauges.csv \
    -sql "SELECT 'other' AS label, geometry FROM gauges" -dialect sqlite
  expect_exit 0 preprocess
  second=$(sed -n 's/^# id: //p' out/preprocess.used.toml)
  [[ -n $first && $first != "$second" ]] || fail "a changed file makes the same domain: $first"
}

run_test "$@"
