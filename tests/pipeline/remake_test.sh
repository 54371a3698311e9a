#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# pipelines/Makefile: which stage runs again, and when. The programs are stand-ins that note their call and write their
# result; what a stage reads they ask of the real ones.
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

# A copy of the pipelines with one scene, so that recipes may be changed.
stage_pipelines() {
  mkdir -p pipelines/scene data/scene bin
  cp "$TALUS_SOURCE"/pipelines/{Makefile,run-scene,stages.mk} pipelines/
  touch data/scene/before.tif data/scene/sliding.tif data/scene/survey.tif
  cat >pipelines/scene/recipe.toml <<'TOML'
[scene]
name = "scene"
title = "A title with no/file.tif"
[preprocess]
before_dem = "${TALUS_DATA}/scene/before.tif"
sliding_surface = "../../data/scene/sliding.tif"
[solve]
end_time_s = 10.0
[solve.base]
law = "coulomb"
[postprocess.survey]
thickness = "${TALUS_DATA}/scene/survey.tif"
TOML
  stand_in preprocess domain.vdb
  stand_in solve run.h5
  stand_in postprocess score.json
}

stand_in() {
  cat >"bin/talus-$1" <<SCRIPT
#!/usr/bin/env bash
if [[ \$* == *--depends* || \$* == *--used* ]]; then exec "$bin/talus-$1" "\$@"; fi
echo -n "$1 " >>"$TALUS_SCRATCH/calls"
echo "\$*" >>"$TALUS_SCRATCH/arguments"
for name in $2; do
  mkdir -p "\$(dirname "\$3/\$name")"
  echo result >"\$3/\$name"
done
SCRIPT
  chmod +x "bin/talus-$1"
}

# runs STAGES... [-- ARGUMENTS...]: make runs exactly these stages, in this order.
runs() {
  local expected=""
  while [[ $# -gt 0 && $1 != -- ]]; do expected+="$1 "; shift; done
  rm -f calls arguments
  expect_exit 0 make -C pipelines scene DATA=data BIN=bin OUT=out "${@:2}"
  local called=""
  if [[ -f calls ]]; then called=$(<calls); fi
  [[ $called == "$expected" ]] || fail "ran '$called' instead of '$expected'"
  sleep 0.05   # file times are coarse
}

change() { sed -i "$1" pipelines/scene/recipe.toml; }

test_second_run_does_nothing() {
  stage_pipelines
  runs preprocess solve postprocess
  runs
  touch pipelines/scene/recipe.toml
  runs
}

test_each_part_of_the_recipe_reruns_its_stage_and_those_after() {
  stage_pipelines
  runs preprocess solve postprocess
  change 's/end_time_s = 10.0/end_time_s = 20.0/'
  runs solve postprocess
  change 's/coulomb/velocity-weakening/'
  runs solve postprocess
  change 's/thickness = /peak_thickness = /'
  runs postprocess
  change 's/\[preprocess\]/[preprocess]\nworking_crs = "EPSG:32149"/'
  runs preprocess solve postprocess
  change 's/A title/Another title/'
  runs preprocess solve postprocess
  change 's/^\[solve\]/# a remark\n\n[solve]/'
  runs
}

test_data_and_programs_rerun_their_stage_and_those_after() {
  stage_pipelines
  runs preprocess solve postprocess
  touch data/scene/survey.tif
  runs postprocess
  touch data/scene/sliding.tif
  runs preprocess solve postprocess
  touch bin/talus-solve
  runs solve postprocess
}

# A scene with a stability.toml, whose results its recipe reads.
stage_search() {
  stage_pipelines
  stand_in postprocess 'maps/sliding.tif score.json'
  cp pipelines/scene/recipe.toml pipelines/scene/stability.toml
  change 's,^sliding_surface.*,sliding_surface = "${TALUS_RESULTS}/stability/maps/sliding.tif",'
}

test_what_is_searched_first_runs_first_and_its_results_rerun_the_scene() {
  stage_search
  runs preprocess solve postprocess preprocess solve postprocess
  grep -q 'stability.toml .*out/scene/stability' arguments || fail "the search has no folder of its own: $(<arguments)"
  runs
  change 's/end_time_s = 10.0/end_time_s = 20.0/'
  runs solve postprocess
  sed -i 's/end_time_s = 10.0/end_time_s = 30.0/' pipelines/scene/stability.toml
  runs solve postprocess preprocess solve postprocess
}

test_place_is_handed_to_the_solver() {
  stage_pipelines
  runs preprocess solve postprocess -- ON=cpu
  grep -q 'out/scene --on cpu' arguments || fail "talus-solve was not called with --on cpu: $(<arguments)"
  runs solve postprocess -- ON=gpu
}

test_out_is_relative_to_where_the_user_stands() {
  stage_pipelines
  mkdir elsewhere
  cd elsewhere
  expect_exit 0 make -C ../pipelines scene DATA=../data BIN=../bin OUT=results
  [[ -f results/scene/score.json ]] || fail "no results in elsewhere/results"
}

test_two_makes_in_one_folder_are_refused() {
  stage_pipelines
  mkdir -p out/scene/.inputs
  exec {held}>out/scene/.inputs/lock
  flock "$held"
  expect_exit 2 make -C pipelines scene DATA=data BIN=bin OUT=out
  expect_words "$TALUS_SCRATCH/out/scene: another make -C pipelines is at work there"
  [[ ! -f calls ]] || fail "a stage ran beside another make"
  exec {held}>&-
  runs preprocess solve postprocess
}

# A solver that was broken off goes on; what it wrote before stays where the new run fails.
test_solver_goes_on_and_an_older_run_stays() {
  stage_pipelines
  runs preprocess solve postprocess
  grep -q -- '--on auto --resume' arguments || fail "talus-solve was not told to go on: $(<arguments)"
  change 's/end_time_s = 10.0/end_time_s = 20.0/'
  sed -i '/^for name/i echo broken >\&2; exit 4' bin/talus-solve
  expect_exit 2 make -C pipelines scene DATA=data BIN=bin OUT=out
  [[ -f out/scene/run.h5 ]] || fail "the run of before is gone"
}

test_failed_stage_is_run_again() {
  stage_pipelines
  sed -i '/^for name/i echo broken >\&2; exit 4' bin/talus-solve
  expect_exit 2 make -C pipelines scene DATA=data BIN=bin OUT=out
  stand_in solve run.h5
  runs solve postprocess
}

test_names_hold_spaces_and_umlauts() {
  stage_pipelines
  mkdir "the checkout's copy" 'Höhen und mehr'
  mv pipelines/scene 'pipelines/Großer Rutsch'
  mv pipelines "the checkout's copy/"
  mv data/scene 'Höhen und mehr/Tal 1'
  sed -i -e 's|/scene/before|/Tal 1/before|; s|/scene/survey|/Tal 1/survey|' \
    -e 's|"../../data/scene/|"../../../Höhen und mehr/Tal 1/|' \
    "the checkout's copy/pipelines/Großer Rutsch/recipe.toml"
  mv bin 'die Programme'
  local slide=(make -C "the checkout's copy/pipelines" 'Großer Rutsch' DATA='Höhen und mehr' BIN='die Programme')
  remake() {
    rm -f calls
    expect_exit 0 "${slide[@]}" OUT='Frühe Läufe'
    [[ $(cat calls 2>/dev/null) == "$1" ]] || fail "ran '$(cat calls)' instead of '$1'"
    sleep 0.05
  }
  remake 'preprocess solve postprocess '
  [[ -f 'Frühe Läufe/Großer Rutsch/score.json' ]] || fail "no results in Frühe Läufe/Großer Rutsch"
  remake ''
  touch 'Höhen und mehr/Tal 1/survey.tif'
  remake 'postprocess '
  touch 'Höhen und mehr/Tal 1/sliding.tif'
  remake 'preprocess solve postprocess '
  sed -i 's/end_time_s = 10.0/end_time_s = 20.0/' "the checkout's copy/pipelines/Großer Rutsch/recipe.toml"
  remake 'solve postprocess '
  touch 'die Programme/talus-solve'
  remake 'solve postprocess '
  expect_exit 0 make -C "the checkout's copy/pipelines" list
  grep -qx 'Großer Rutsch' stdout || fail "list does not name the scene"
  expect_exit 0 make -C "the checkout's copy/pipelines" clean OUT='Frühe Läufe'
  expect_no_file 'Frühe Läufe'
  rm 'Höhen und mehr/Tal 1/before.tif'
  expect_exit 2 "${slide[@]}" OUT=out
  expect_words "$TALUS_SCRATCH/Höhen und mehr/Tal 1/before.tif is missing" \
    "in $TALUS_SCRATCH/Höhen und mehr). Put Tal 1 there"
}

test_list_of_files_in_the_recipe_is_followed() {
  stage_pipelines
  sed -i 's/^sliding_surface.*//; s/before_dem/base_dem/' pipelines/scene/recipe.toml
  cat >>pipelines/scene/recipe.toml <<'TOML'
[[preprocess.release]]
name = "A"
thickness_raster = "thickness.tif"   # "not/this.tif"
[[preprocess.obstacle]]
name = "wall"
polygons = "walls.geojson"
height_m = 3.0
[[solve.obstacle]]
name = "wall"
TOML
  touch pipelines/scene/thickness.tif pipelines/scene/walls.geojson
  stand_in preprocess "domain.vdb obstacles.vdb"
  runs preprocess solve postprocess
  runs
  touch pipelines/scene/thickness.tif
  runs preprocess solve postprocess
  touch pipelines/scene/walls.geojson
  runs preprocess solve postprocess
  touch out/scene/obstacles.vdb
  runs solve postprocess
  rm out/scene/obstacles.vdb
  runs preprocess solve postprocess
}

test_survey_of_preprocess_is_an_input_of_postprocess() {
  stage_pipelines
  sed -i 's/^thickness = .*/from_preprocess = true/; s/^sliding_surface.*/after_dem = "after.tif"/' \
    pipelines/scene/recipe.toml
  touch pipelines/scene/after.tif
  stand_in preprocess "domain.vdb survey/slide_difference.tif survey/difference_sigma.tif"
  runs preprocess solve postprocess
  runs
  touch out/scene/survey/difference_sigma.tif
  runs postprocess
  rm out/scene/survey/slide_difference.tif
  runs preprocess solve postprocess
  runs
}

test_sidecars_and_variables_are_followed() {
  stage_pipelines
  runs preprocess solve postprocess
  touch data/scene/before.prj
  runs preprocess solve postprocess
  cp -r data elsewhere
  rm -f calls
  expect_exit 0 make -C pipelines scene DATA=elsewhere BIN=bin OUT=out
  [[ $(<calls) == 'preprocess solve postprocess ' ]] || fail "other data, but it ran '$(<calls)'"
}

test_unknown_scene_names_those_there_are() {
  stage_pipelines
  mkdir 'pipelines/other scene' pipelines/benchmarks
  cp pipelines/scene/recipe.toml 'pipelines/other scene/'
  expect_exit 2 make -C pipelines 'scen e'
  expect_error "scen e: no such scene (there is no pipelines/scen e/recipe.toml). Name one of these: other scene, scene"
  expect_exit 2 make -C pipelines benchmarks
  expect_words "benchmarks: no such scene"
}

test_faulty_recipe_runs_nothing() {
  stage_pipelines
  change 's/end_time_s/end_tim_s/'
  expect_exit 2 make -C pipelines scene DATA=data BIN=bin OUT=out
  expect_words 'talus-solve: ' 'unknown key "end_tim_s"' 'Did you mean "end_time_s"?'
  [[ ! -f calls ]] || fail "a stage ran although the recipe is wrong"
}

test_missing_data_is_one_clear_sentence() {
  stage_pipelines
  expect_exit 2 make -C pipelines scene DATA=nowhere BIN=bin OUT=out
  expect_error "$TALUS_SCRATCH/nowhere/scene/before.tif is missing (the recipes look for their data in " \
    "$TALUS_SCRATCH/nowhere). Put scene there, or say where the data are: make -C pipelines SCENE DATA=dir"
  [[ ! -f calls ]] || fail "a stage ran without its data"
}

test_missing_program_says_how_to_build_it() {
  stage_pipelines
  expect_exit 2 make -C pipelines scene DATA=data BIN=none OUT=out
  expect_error "$TALUS_SCRATCH/none/talus-preprocess is missing (the programs are not built yet). " \
    "Build them: make build"
}

run_test "$@"
