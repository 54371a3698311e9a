#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Files of another recipe, or of another preparation: a stage refuses them, names both, and says what to do. What a file
# does not depend on does not count.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

# refused_for FILE TABLE COMMAND...: it is refused, because another [TABLE] made FILE, and both marks are named.
refused_for() {
  local mark='[0-9a-f]{16}' text
  expect_exit 3 "${@:3}"
  text="^talus-[a-z]+: $1: another recipe made it \\(the checksum of its \\[$2\\] is $mark, that of "
  text+="recipe.toml is $mark\\)\\. Run talus-"
  grep -qE "$text" stderr || fail "it does not name both recipes"
}

test_a_stale_domain_is_refused() {
  scene
  expect_exit 0 preprocess
  sed -i 's/^layer_height_m = 2.0/layer_height_m = 1.0/' recipe.toml
  refused_for out/domain.vdb preprocess solve
  refused_for out/domain.vdb preprocess solve --check
  expect_no_file out domain.vdb preprocess.used.toml survey
  expect_exit 0 preprocess
  expect_exit 0 solve
}

test_a_stale_run_is_refused() {
  scene
  expect_exit 0 preprocess
  expect_exit 0 solve
  sed -i 's/^end_time_s = 3.0/end_time_s = 2.0/' recipe.toml
  refused_for out/run.h5 solve postprocess
  sed -i 's/^end_time_s = 2.0/end_time_s = 3.0/; s/^layer_height_m = 2.0/layer_height_m = 1.0/' recipe.toml
  refused_for out/run.h5 preprocess postprocess
  sed -i 's/^layer_height_m = 1.0/layer_height_m = 2.0/' recipe.toml
  expect_exit 0 postprocess
}

test_what_a_file_does_not_depend_on_does_not_count() {
  scene
  expect_exit 0 preprocess
  sed -i 's/^end_time_s = 3.0/end_time_s = 1.0/' recipe.toml
  expect_exit 0 solve
  cat >>recipe.toml <<'TOML'

[postprocess]
deposit_threshold_m = 0.2
TOML
  sed -i 's/^\[solve\]/# another word\n[solve]/; s/^end_time_s = 1.0/end_time_s   =  1/' recipe.toml
  sed -i 's/^title = .*/title = "Another title"/' recipe.toml
  expect_exit 0 postprocess
  expect_words 'the run is called "Bowl" (bowl), the recipe "Another title" (bowl)'
}

# Who names the file insists on it; the results say so.
test_a_file_that_the_recipe_names_is_taken_and_the_results_say_so() {
  scene
  expect_exit 0 preprocess
  sed -i 's/^layer_height_m = 2.0/layer_height_m = 1.0/' recipe.toml
  sed -i 's|^\[solve\]|[solve]\ndomain = "out/domain.vdb"|; s/^end_time_s = 3.0/end_time_s = 1.0/' recipe.toml
  expect_exit 0 solve
  expect_words 'accepted, "another-recipe": ' "another recipe made it"
  expect_exit 0 postprocess
  grep -q '"name": "another-recipe"' out/score.json || fail "score.json does not say what was insisted on"
}

test_a_survey_of_another_preparation_is_refused() {
  scene
  sed -i 's/^thickness = .*/from_preprocess = true/' recipe.toml
  expect_exit 0 preprocess
  expect_exit 0 solve
  expect_exit 0 postprocess
  sed -i '7s/^72.2/72.1/' after.asc   # other data, the same recipe
  expect_exit 0 preprocess
  expect_exit 3 postprocess
  expect_words "out/survey/survey.json: prepared with the domain " "out/run.h5 was computed on the domain "
  rm out/survey/survey.json
  expect_exit 3 postprocess
  expect_words "out/survey/survey.json: no such file (talus-preprocess writes it last"
}

test_level_sets_of_another_preparation_are_refused() {
  scene
  cat >wall.geojson <<'JSON'
{"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {}, "geometry": {"type": "Polygon",
  "coordinates": [[[500120, 5000070], [500140, 5000070], [500140, 5000130], [500120, 5000130], [500120, 5000070]]]}}]}
JSON
  printf '[[preprocess.obstacle]]\nname = "wall"\npolygons = "wall.geojson"\nheight_m = 6.0\n' >>recipe.toml
  printf '[[solve.obstacle]]\nname = "wall"\n' >>recipe.toml
  sed -i 's/^end_time_s.*/end_time_s = 0.5/' recipe.toml
  expect_exit 0 preprocess
  expect_exit 0 solve
  sed 's/^height_m = 6.0/height_m = 9.0/' recipe.toml >other.toml
  expect_exit 0 "$bin/talus-preprocess" other.toml --out other
  cp other/obstacles.vdb out/
  expect_exit 3 solve
  expect_words "out/obstacles.vdb: not the file that was written with out/domain.vdb"
}

test_every_file_of_a_run_carries_its_id() {
  need_tool gdalinfo
  need_tool h5dump
  scene
  sed -i 's/^end_time_s.*/end_time_s = 1.0/' recipe.toml
  expect_exit 0 preprocess
  expect_exit 0 solve
  expect_exit 0 postprocess
  local id file
  id=$(sed -n 's/^# id: //p' out/solve.used.toml)
  [[ $id =~ ^[0-9a-f]{16}$ ]] || fail "solve.used.toml has no id: '$id'"
  h5dump -g /provenance out/run.h5 | grep -q "\"$id\"" || fail "run.h5 does not carry $id"
  for file in out/maps/*.tif; do
    gdalinfo "$file" | grep -q "RUN_ID=$id" || fail "$file does not carry $id"
  done
  grep -q "\"run_id\": \"$id\"" out/score.json || fail "score.json does not carry $id"
  h5dump -a /run_id out/maps/results.nc | grep -q "\"$id\"" || fail "results.nc does not carry $id"
  id=$(sed -n 's/^# id: //p' out/preprocess.used.toml)
  grep -qa "$id" out/domain.vdb || fail "domain.vdb does not carry $id"
  grep -q "\"id\": \"$id\"" out/survey/survey.json || fail "survey.json does not carry $id"
  for file in out/survey/*.tif; do
    gdalinfo "$file" | grep -q "DOMAIN_ID=$id" || fail "$file does not carry $id"
  done
}

run_test "$@"
