#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# What was used is a recipe: every *.used.toml passes --check, gives the same results under the same id, and two runs of
# any recipe can be compared.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

# used_of STAGE: its used recipe passes --check, its results are up to date by it, and where the stage runs from it, it
# states the same tables.
used_of() {
  local stage=$1
  cp out/$stage.used.toml used.toml
  expect_exit 0 "$bin/talus-$stage" used.toml --out out --check
  expect_exit 0 "$bin/talus-$stage" used.toml --out out --if-outdated
  expect_words "is up to date"
  expect_exit 0 "$bin/talus-$stage" used.toml --out out
  diff <(grep -v '^#' used.toml) <(grep -v '^#' out/$stage.used.toml) >&2 || fail "$stage.used.toml gives another"
}

# used_is_a_recipe RECIPE: all stages run from it, and from what they say that they used.
used_is_a_recipe() {
  local stage
  rm -rf out
  for stage in preprocess solve postprocess; do expect_exit 0 "$bin/talus-$stage" "$1" --out out; done
  for stage in postprocess solve preprocess; do used_of $stage; done   # what is made again outdates those after it
}

# with_survey LINES...: the scene scored against what these lines name.
with_survey() {
  scene
  sed -i '/^\[postprocess.survey/,$d' recipe.toml
  printf '%s\n' "[postprocess.survey]" "$@" >>recipe.toml
}

test_each_way_to_name_a_survey() {
  local way
  for way in 'from_preprocess = true' 'thickness = "survey.asc"' 'difference = "change.asc"' \
    $'after_dem = "after.asc"\nbefore_dem = "before.asc"' $'thickness = "survey.asc"\nsigma_m = 0.3' \
    $'difference = "change.asc"\nsigma = "sigma.asc"'; do
    with_survey "$way"
    grid change.asc "2 * (i >= 7 && i < 11 && j >= 8 && j < 12)"
    grid sigma.asc 0.2
    used_is_a_recipe recipe.toml
    rm -rf other
    cp -a out other
    expect_exit 0 "$bin/talus" compare out other
    expect_exit 0 "$bin/talus" compare other out
  done
}

test_what_talus_new_writes() {
  local known valley=$TALUS_SOURCE/data_samples/valley
  for known in no yes; do
    rm -rf new.toml run other
    expect_exit 0 "$bin/talus" new "$valley/before_dem.tif" "$valley/after_dem.tif" --recipe new.toml
    sed -i 's/^end_time_s.*/end_time_s = 2.0/' new.toml
    [[ $known == no ]] || printf '\n[preprocess.difference]\nsigma_m = 0.1\n' >>new.toml
    expect_exit 0 "$bin/talus" run new.toml --out run --on cpu
    cp -a run other
    expect_exit 0 "$bin/talus" compare run other
    expect_exit 0 "$bin/talus-postprocess" run/postprocess.used.toml --out run --check
  done
}

test_each_template() {
  scene
  local stage program
  for stage in preprocess solve postprocess; do
    program=$bin/talus-$stage
    "$program" --template >template || fail "no template"
    { sed -n '/^\[scene\]/,/^$/p' recipe.toml && grep -v '^#' template; } >of_$stage.toml
  done
  sed -i 's/^before_dem = ""/before_dem = "before.asc"/; s/^after_dem = ""/after_dem = "after.asc"/' of_preprocess.toml
  sed -i 's/^end_time_s.*/end_time_s = 1.0/' of_solve.toml
  for stage in preprocess solve postprocess; do
    expect_exit 0 "$bin/talus-$stage" of_$stage.toml --out out
    used_of $stage
  done
}

# What needs no file that is not in the repository; elevation models are made by data_samples.
test_pipelines_of_the_repository() {
  local name recipe looked=0
  for recipe in "$TALUS_SOURCE"/pipelines/*/recipe.toml; do
    name=$(basename "$(dirname "$recipe")")
    if grep -q '^\[slides\]' "$recipe"; then continue; fi   # [preprocess] of slides names what each slide sets
    rm -rf out
    "$bin/talus-preprocess" "$recipe" --out out --check >stdout 2>stderr || continue   # its data is not here
    expect_exit 0 "$bin/talus-preprocess" "$recipe" --out out
    cp out/preprocess.used.toml used.toml
    expect_exit 0 "$bin/talus-preprocess" used.toml --out out --check
    expect_exit 0 "$bin/talus-preprocess" used.toml --out out --if-outdated
    expect_words "is up to date"
    looked=$((looked + 1))
  done
  [[ $looked -ge 3 ]] || fail "only $looked pipelines run from the repository alone"
}

tables() { sed '1,/^$/d' "$1"; }
id() { sed -n 's/^# id: //p' "$1"; }

# used_again: of the results in out, every used recipe passes --check, and all of them in turn make the same anew.
used_again() {
  local stage
  for stage in preprocess solve postprocess; do
    expect_exit 0 "$bin/talus-$stage" out/$stage.used.toml --out out --check
  done
  for stage in preprocess solve postprocess; do
    expect_exit 0 "$bin/talus-$stage" out/$stage.used.toml --out again -q
    diff <(tables out/$stage.used.toml) <(tables again/$stage.used.toml) >&2 || fail "$stage: other values are used"
  done
  [[ -n $(id out/preprocess.used.toml) && $(id out/preprocess.used.toml) == "$(id again/preprocess.used.toml)" ]] ||
    fail "another domain: $(id out/preprocess.used.toml) and $(id again/preprocess.used.toml)"
}

# made_of KEYS...: the bowl's results, of a short run that is scored against what preprocess finds, with further lines.
made_of() {
  scene
  sed -i 's/^end_time_s.*/end_time_s = 1.0/; s/^thickness = .*/from_preprocess = true/' recipe.toml
  printf '%s\n' "$@" >>recipe.toml
  local stage
  for stage in preprocess solve postprocess; do expect_exit 0 $stage -q; done
}

test_of_an_ensemble() {
  made_of '[ensemble]' 'members = 2' '[[ensemble.vary]]' 'key = "solve.base.friction_angle_deg"' 'low = 12.0' \
    'high = 18.0'
  used_again
}

test_of_a_budget() {
  made_of '[preprocess.difference]' 'sigma_m = 0.2' '[ensemble]' 'design = "budget"' '[ensemble.budget]' \
    'survey_draws = 1'
  used_again
}

test_of_slides() {
  scene
  ogr2ogr -q -f GeoJSON areas.geojson /vsistdin/ <<'JSON' || fail "areas.geojson"
{"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {"depth": 3.0}, "geometry":
  {"type": "Polygon", "coordinates": [[[500030, 5000080], [500070, 5000080], [500070, 5000120], [500030, 5000120],
  [500030, 5000080]]]}}]}
JSON
  sed -i 's/^end_time_s.*/end_time_s = 1.0/; /^after_dem/d; s/^before_dem/base_dem/' recipe.toml
  sed -i '/postprocess.survey/,$d' recipe.toml
  printf '%s\n' '[slides]' 'outlines = "areas.geojson"' '[[slides.set]]' 'key = "preprocess.release[0].thickness_m"' \
    'attribute = "depth"' >>recipe.toml
  local stage
  for stage in preprocess solve postprocess; do expect_exit 0 $stage -q; done
  used_again
}

run_test "$@"
