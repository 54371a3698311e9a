#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# pipelines/Makefile: what it calls, with which paths, and its messages. The programs are stand-ins that note their call
# and write their result. Whether a stage is up to date the programs decide: talus_test.sh.
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

# A copy of the pipelines with one scene, so that recipes may be changed.
stage_pipelines() {
  mkdir -p pipelines/scene data/scene bin
  cp "$TALUS_SOURCE/pipelines/Makefile" pipelines/
  touch data/scene/before.tif
  cat >pipelines/scene/recipe.toml <<'TOML'
[preprocess]
before_dem = "${TALUS_DATA}/scene/before.tif"
TOML
  stand_in preprocess domain.vdb
  stand_in solve run.h5
  stand_in postprocess score.json
}

stand_in() {
  cat >"bin/talus-$1" <<SCRIPT
#!/usr/bin/env bash
echo -n "$1 " >>"$TALUS_SCRATCH/calls"
echo "\$* data \$TALUS_DATA results \$TALUS_RESULTS" >>"$TALUS_SCRATCH/arguments"
mkdir -p "\$3"
echo result >"\$3/$2"
SCRIPT
  chmod +x "bin/talus-$1"
}

# runs STAGES... [-- ARGUMENTS...]: make calls exactly these stages, in this order.
runs() {
  local expected=""
  while [[ $# -gt 0 && $1 != -- ]]; do expected+="$1 "; shift; done
  rm -f calls arguments
  expect_exit 0 make -C pipelines scene DATA=data BIN=bin OUT=out "${@:2}"
  [[ $(<calls) == "$expected" ]] || fail "ran '$(<calls)' instead of '$expected'"
}

test_calls_each_stage_once_and_leaves_the_choice_to_it() {
  stage_pipelines
  runs preprocess solve postprocess
  local recipe=$TALUS_SCRATCH/pipelines/scene/recipe.toml out=$TALUS_SCRATCH/out/scene
  local rest="data $TALUS_SCRATCH/data results $out"
  printf '%s\n' "$recipe --out $out --if-outdated $rest" "$recipe --out $out --on auto --resume --if-outdated $rest" \
    "$recipe --out $out --if-outdated $rest" | diff - arguments >difference || fail "$(<difference)"
  expect_words "scene: results in $out"
}

test_what_is_searched_first_runs_first_into_a_folder_of_its_own() {
  stage_pipelines
  cp pipelines/scene/recipe.toml pipelines/scene/stability.toml
  runs preprocess solve postprocess preprocess solve postprocess
  [[ $(grep -c "scene/stability.toml --out $TALUS_SCRATCH/out/scene/stability .* results $TALUS_SCRATCH/out/scene$" \
    arguments) -eq 3 ]] || fail "the search has no folder of its own: $(<arguments)"
}

test_place_is_handed_to_the_solver() {
  stage_pipelines
  runs preprocess solve postprocess -- ON=cpu
  grep -q 'out/scene --on cpu' arguments || fail "talus-solve was not called with --on cpu: $(<arguments)"
}

test_out_is_relative_to_where_the_user_stands() {
  stage_pipelines
  mkdir elsewhere
  cd elsewhere
  expect_exit 0 make -C ../pipelines scene DATA=../data BIN=../bin OUT=results
  [[ -f results/scene/score.json ]] || fail "no results in elsewhere/results"
}

test_a_failed_stage_ends_it() {
  stage_pipelines
  sed -i '/^mkdir/i echo broken >\&2; exit 4' bin/talus-solve
  expect_exit 2 make -C pipelines scene DATA=data BIN=bin OUT=out
  [[ $(<calls) == 'preprocess solve ' ]] || fail "it went on: $(<calls)"
  expect_words broken
}

test_names_hold_spaces_and_umlauts() {
  stage_pipelines
  mkdir "the checkout's copy" 'Höhen und mehr'
  mv pipelines/scene 'pipelines/Großer Rutsch'
  mv pipelines "the checkout's copy/"
  mv data/scene 'Höhen und mehr/Tal 1'
  sed -i 's|/scene/before|/Tal 1/before|' "the checkout's copy/pipelines/Großer Rutsch/recipe.toml"
  mv bin 'die Programme'
  local slide=(make -C "the checkout's copy/pipelines" 'Großer Rutsch' DATA='Höhen und mehr' BIN='die Programme')
  expect_exit 0 "${slide[@]}" OUT='Frühe Läufe'
  [[ $(<calls) == 'preprocess solve postprocess ' ]] || fail "ran '$(<calls)'"
  [[ -f 'Frühe Läufe/Großer Rutsch/score.json' ]] || fail "no results in Frühe Läufe/Großer Rutsch"
  grep -qF "results $TALUS_SCRATCH/Frühe Läufe/Großer Rutsch" arguments || fail "$(<arguments)"
  expect_exit 0 make -C "the checkout's copy/pipelines" list
  grep -qx 'Großer Rutsch' stdout || fail "list does not name the scene"
  expect_exit 0 make -C "the checkout's copy/pipelines" clean OUT='Frühe Läufe'
  expect_no_file 'Frühe Läufe'
  rm 'Höhen und mehr/Tal 1/before.tif'
  sed -i '/^mkdir/i exit 3' 'die Programme/talus-preprocess'
  expect_exit 2 "${slide[@]}" OUT=out
  expect_words "$TALUS_SCRATCH/Höhen und mehr/Tal 1/before.tif is missing" \
    "in $TALUS_SCRATCH/Höhen und mehr). Put Tal 1 there"
}

test_help_names_the_scenes() {
  stage_pipelines
  echo '# A slide' >pipelines/scene/README.md
  expect_exit 0 make -C pipelines OUT=out
  grep -qE '^  scene +A slide$' stdout || fail "help does not name the scene: $(<stdout)"
  grep -qF "OUT=$TALUS_SCRATCH/out" stdout || fail "help does not name the results: $(<stdout)"
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

test_missing_data_is_one_clear_sentence() {
  stage_pipelines
  sed -i '/^mkdir/i exit 3' bin/talus-preprocess
  expect_exit 2 make -C pipelines scene DATA=nowhere BIN=bin OUT=out
  expect_error "$TALUS_SCRATCH/nowhere/scene/before.tif is missing (the recipes look for their data in " \
    "$TALUS_SCRATCH/nowhere). Put scene there, or say where the data are: make -C pipelines SCENE DATA=dir"
}

test_missing_program_says_how_to_build_it() {
  stage_pipelines
  expect_exit 2 make -C pipelines scene DATA=data BIN=none OUT=out
  expect_error "$TALUS_SCRATCH/none/talus-preprocess is missing (the programs are not built yet). " \
    "Build them: make build"
}

run_test "$@"
