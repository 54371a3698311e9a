#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# --depends and --used: what a stage would read, as rules for make, and what it would take from its recipe.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

# depends STAGE RULES [ARGUMENT...]: talus-STAGE --depends prints exactly the first rule RULES and an empty one for each
# of its prerequisites, and writes nothing.
depends() {
  local stage=$1 rule=$2 line
  shift 2
  touch before-the-call
  expect_exit 0 "$bin/talus-$stage" recipe.toml --depends "$@"
  [[ ! -s stderr ]] || fail "talus-$stage --depends talks on stderr"
  {
    printf '%s\n' "$rule" | sed 's/$/ \\/; $s/ \\$//'
    while IFS= read -r line; do
      [[ $line != '  '* ]] || printf '\n%s:\n' "${line#  }"
    done <<<"$rule"
  } >expected
  diff -u expected stdout >difference || fail "talus-$stage --depends prints: $(<difference)"
  local own=(! -name stdout ! -name stderr ! -name expected ! -name difference ! -name .)
  [[ -z $(find . -newer before-the-call "${own[@]}") ]] ||
    fail "talus-$stage --depends wrote something: $(find . -newer before-the-call)"
}

test_every_file_that_a_recipe_names_is_listed() {
  export TALUS_DATA="$TALUS_SCRATCH/Daten"
  cat >recipe.toml <<'TOML'
[scene]
title = "no/file.tif"

[preprocess]
base_dem = "${TALUS_DATA}/base.tif"

[[preprocess.release]]   # "nor/this.tif"
name = "A"
thickness_raster = '${TALUS_DATA}/a #1.tif'

[[preprocess.release]]
name = "B"
polygons = "b.gpkg"
thickness_m = 2.0

[[preprocess.erodible]]
name = "bed"
thickness_raster = "bed.tif"

[[preprocess.obstacle]]
name = "wall"
polygons = "Mauern & Wände.gpkg"
height_m = 5.0

[preprocess.bed]
friction_angle_deg = "phi.tif"

[[solve.obstacle]]
name = "wall"

[[solve.obstacle]]
name = "dam"
level_set = "dam.vdb"

[postprocess]
thalweg = "way.gpkg"

[postprocess.survey]
thickness = "survey.tif"
peak_thickness = "../peak.tif"
sigma = "${TALUS_DATA}/sigma.tif"
TOML
  local here=$TALUS_SCRATCH
  depends preprocess "out/domain.vdb out/obstacles.vdb:
  $here/Daten/base.tif
  $here/bed.tif
  $here/Daten/a\\ \\#1.tif
  $here/b.gpkg
  $here/phi.tif
  $here/Mauern\\ &\\ Wände.gpkg" --out out
  depends solve "$here/out/run.h5:
  $here/out/domain.vdb
  $here/out/obstacles.vdb
  $here/dam.vdb"
  depends solve "out/run.h5:
  out/domain.vdb
  out/obstacles.vdb
  $here/dam.vdb
  $here/old.h5" --out out --restart "$here/old.h5"
  depends postprocess "$here/out/score.json:
  $here/out/run.h5
  $here/survey.tif
  $here/Daten/sigma.tif
  $(dirname "$here")/peak.tif
  $here/way.gpkg"
}

test_survey_of_preprocess_is_listed() {
  scene
  sed -i 's/^thickness = .*/from_preprocess = true/' recipe.toml
  local here=$TALUS_SCRATCH
  depends preprocess "out/survey/survey.json:
  $here/before.asc
  $here/after.asc" --out out --difference
  depends postprocess "out/score.json:
  out/run.h5
  out/survey/slide_difference.tif
  out/survey/difference_sigma.tif" --out out
  expect_exit 0 preprocess   # one model was made from the other: there is no error to have a raster of
  depends postprocess "out/score.json:
  out/run.h5
  out/survey/slide_difference.tif
  out/preprocess.used.toml
  out/survey/survey.json" --out out
}

test_files_given_elsewhere_take_the_place_of_those_of_the_stage_before() {
  scene
  sed -i -e 's/^\[solve\]/[solve]\ndomain = "other.vdb"/' \
    -e 's/^\[postprocess.survey\]/[postprocess]\nrun = "other.h5"\n\n&/' recipe.toml
  depends solve "out/run.h5:
  $TALUS_SCRATCH/other.vdb" --out out
  depends postprocess "out/score.json:
  $TALUS_SCRATCH/other.h5
  $TALUS_SCRATCH/survey.asc" --out out
}

test_what_gdal_reads_beside_a_file_is_listed() {
  need_tool gdalbuildvrt
  need_tool ogr2ogr
  scene
  gdal_translate -q -of GTiff -a_srs EPSG:32611 before.asc west.tif
  gdalbuildvrt -q mosaic.vrt west.tif
  cat >ring.json <<'JSON'
{"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {}, "geometry": {"type": "Polygon",
  "coordinates": [[[500030, 5000080], [500070, 5000080], [500070, 5000120], [500030, 5000120], [500030, 5000080]]]}}]}
JSON
  ogr2ogr -q -a_srs EPSG:32611 ring.shp ring.json
  touch after.prj
  sed -i -e 's|^before_dem.*|before_dem = "mosaic.vrt"|' \
    -e 's|^\[preprocess.grid\]|[preprocess.source]\npolygon = "ring.shp"\n\n&|' recipe.toml
  expect_exit 0 "$bin/talus-preprocess" recipe.toml --depends
  local name
  for name in mosaic.vrt west.tif after.asc after.prj ring.shp ring.shx ring.dbf ring.prj; do
    grep -qxF -- "$TALUS_SCRATCH/$name:" stdout || fail "$name is not listed"
  done
}

# make reads the rules: it finds no fault in them, and sees what is newer.
test_make_reads_the_rules() {
  mkdir 'a b' && cd 'a b'
  cat >recipe.toml <<'TOML'
[preprocess]
before_dem = 'b $x #1 50% [2] c:d=e|f*g.tif'
sliding_surface = "Gleitfläche.tif"
TOML
  local name='b $x #1 50% [2] c:d=e|f*g.tif'
  touch "$name" Gleitfläche.tif
  sleep 0.05
  touch domain.vdb
  "$bin/talus-preprocess" recipe.toml --out . --depends >rules.d
  printf 'domain.vdb:\n\techo made >>made; touch domain.vdb\ninclude rules.d\n' >Makefile
  expect_exit 0 make
  [[ ! -f made ]] || fail "make ran although nothing is newer"
  sleep 0.05
  touch "$name"
  expect_exit 0 make
  [[ $(wc -l <made) -eq 1 ]] || fail "make did not see the newer file"
  expect_exit 0 make
  [[ $(wc -l <made) -eq 1 ]] || fail "make ran again"
}

test_faulty_recipes_are_refused() {
  scene
  sed -i 's/^layer_height_m/layer_hight_m/' recipe.toml
  expect_exit 2 "$bin/talus-preprocess" recipe.toml --depends
  expect_words 'Did you mean "layer_height_m"?'
  sed -i 's/^layer_hight_m/layer_height_m/; s|"before.asc"|"${NO_SUCH_FOLDER}/before.asc"|' recipe.toml
  expect_exit 2 "$bin/talus-preprocess" recipe.toml --used
  expect_words 'the environment variable NO_SUCH_FOLDER is not set'
  [[ ! -s stdout && ! -e out ]] || fail "something was printed or written"
}

# What --used prints is a recipe that says the same, and it changes with what it says alone.
test_used_is_the_stage_s_part_of_the_recipe() {
  scene
  local stage
  for stage in preprocess solve postprocess; do
    expect_exit 0 "$bin/talus-$stage" recipe.toml --used
    grep -qxF 'title = "Bowl"' stdout || fail "talus-$stage --used does not print [scene]"
    grep -qE "^\[$stage[].]" stdout || fail "talus-$stage --used does not print [$stage]"
    cp stdout $stage.toml
    expect_exit 0 "$bin/talus-$stage" $stage.toml --used
    cmp stdout $stage.toml || fail "what talus-$stage --used prints says something else"
  done
  sed -i 's/^end_time_s.*/end_time_s = 4/; s/^\[solve\]/# remark\n[solve]/' recipe.toml
  for stage in preprocess postprocess; do
    expect_exit 0 "$bin/talus-$stage" recipe.toml --used
    cmp stdout $stage.toml || fail "[solve] changed what talus-$stage --used prints"
  done
  expect_exit 0 "$bin/talus-solve" recipe.toml --used
  ! cmp -s stdout solve.toml || fail "talus-solve --used does not show the change"
  [[ ! -e out ]] || fail "--used made the output folder"
}

run_test "$@"
