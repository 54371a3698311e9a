#!/usr/bin/env bash
# pipelines/Makefile: which stage runs again, and when. The programs are stand-ins that note their call and write their result.
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

# A copy of the pipelines with one scene, so that recipes may be changed.
stage_pipelines() {
  mkdir -p pipelines/scene data/scene bin
  cp "$TALUS_SOURCE/pipelines/Makefile" pipelines/
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
echo -n "$1 " >>"$TALUS_SCRATCH/calls"
echo "\$*" >>"$TALUS_SCRATCH/arguments"
echo result >"\$3/$2"
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

test_failed_stage_is_run_again() {
  stage_pipelines
  printf '#!/usr/bin/env bash\necho broken >&2; exit 4\n' >bin/talus-solve
  expect_exit 2 make -C pipelines scene DATA=data BIN=bin OUT=out
  stand_in solve run.h5
  rm -f calls
  runs solve postprocess
}

test_missing_data_is_one_clear_sentence() {
  stage_pipelines
  expect_exit 2 make -C pipelines scene DATA=nowhere BIN=bin OUT=out
  expect_error "$TALUS_SCRATCH/nowhere/scene/before.tif is missing (the recipes look for their data in $TALUS_SCRATCH/nowhere). Put scene there, or say where the data are: make -C pipelines SCENE DATA=dir"
  [[ ! -f calls ]] || fail "a stage ran without its data"
}

test_missing_program_says_how_to_build_it() {
  stage_pipelines
  expect_exit 2 make -C pipelines scene DATA=data BIN=none OUT=out
  expect_error "$TALUS_SCRATCH/none/talus-preprocess is missing (the programs are not built yet). Build them: make build"
}

run_test "$@"
