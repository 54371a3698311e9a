#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# The command line that the three programs share.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"
programs=(talus-preprocess talus-solve talus-postprocess)

test_help_shows_options_examples_and_exit_codes() {
  local program word
  for program in "${programs[@]}"; do
    expect_exit 0 "$bin/$program" --help
    for word in --out --set --check --template --on --version 'Examples:' 'Exit codes:' '130 ended by Ctrl-C' \
      "$program "; do
      grep -qF -- "$word" stdout || fail "$program --help does not show: $word"
    done
  done
}

test_version_names_the_commit() {
  local program
  for program in "${programs[@]}"; do
    expect_exit 0 "$bin/$program" --version
    grep -qE "^$program [0-9]+\.[0-9]+\.[0-9]+ \(([0-9a-f]{7,}|unknown)\)$" stdout ||
      fail "$program --version says $(<stdout)"
  done
}

test_no_library_is_looked_for_in_the_folder_of_the_caller() {
  local program
  for program in "${programs[@]}"; do
    LD_DEBUG=libs "$bin/$program" --version >/dev/null 2>searched
    grep -q 'trying file=/' searched || fail "the loader does not say where it looks"
    if grep -E 'trying file=([^/]|$)' searched; then fail "$program takes libraries of the folder it is called in"; fi
  done
}

test_unknown_option_is_a_usage_error() {
  local program
  for program in "${programs[@]}"; do
    expect_exit 2 "$bin/$program" --ouput here
    expect_words "$program: " "Usage: $program recipe.toml"
  done
}

test_no_recipe_is_a_usage_error() {
  local program
  for program in "${programs[@]}"; do
    expect_exit 2 "$bin/$program"
    expect_words "$program: no recipe was given. Usage: $program"
  done
}

# A template is a recipe: read back, it is what the used recipe says of an empty one.
test_templates_are_recipes_with_help() {
  scene
  local program
  for program in "${programs[@]}"; do
    expect_exit 0 "$bin/$program" --template
    [[ ! -s stderr ]] || fail "$program --template talks on stderr"
    grep -qE "^\[${program#talus-}[].]" stdout || fail "$program --template has no table [${program#talus-}]"
    [[ $(grep -c '#' stdout) -gt 5 ]] || fail "$program --template explains nothing"
  done
  # talus-solve's defaults run as they are; the others need files.
  expect_exit 0 "$bin/talus-solve" --template
  cp stdout template.toml
  expect_exit 0 preprocess
  expect_exit 0 "$bin/talus-solve" template.toml --out out --check
}

test_check_computes_and_writes_nothing() {
  scene
  expect_exit 0 preprocess --check
  [[ ! -e out ]] || fail "talus-preprocess --check made the output folder"
  expect_exit 0 preprocess
  expect_exit 0 solve --check
  expect_no_file out domain.vdb preprocess.used.toml survey
}

test_plan_says_what_it_takes_and_writes_nothing() {
  scene
  expect_exit 0 preprocess
  expect_exit 0 solve --plan
  local word words=('drucker-prager' 'coulomb, 15 deg' 'terrain-following, quadratic' 'MB now, on the CPU'
    's at rest (waves of' 'steps to 3 s' 'ms a step')
  for word in "${words[@]}"; do
    grep -qF -- "$word" stderr || fail "--plan does not say: $word"
  done
  ! grep -qE 'softens|walls|rasters|erodible|damping' stderr || fail "--plan names what the recipe does not"
  expect_no_file out domain.vdb preprocess.used.toml survey
}

test_check_finds_faults() {
  scene
  sed -i 's/^layer_height_m/layer_hight_m/' recipe.toml
  expect_exit 2 preprocess --check
  expect_words 'Did you mean "layer_height_m"?'
  sed -i 's/^layer_hight_m/layer_height_m/' recipe.toml
  rm after.asc
  expect_exit 3 preprocess --check
  expect_words "after.asc: no such file"
}

test_stdout_holds_result_paths_only() {
  scene
  expect_exit 0 preprocess -v
  expect_stdout_paths
  expect_exit 0 solve -v
  expect_stdout_paths
  expect_exit 0 postprocess -v
  expect_stdout_paths
}

test_quiet_says_nothing() {
  scene
  expect_exit 0 preprocess -q
  [[ ! -s stderr ]] || fail "-q talks"
  expect_exit 0 solve -q
  [[ ! -s stderr ]] || fail "-q talks"
  expect_exit 0 postprocess -q
  [[ ! -s stderr ]] || fail "-q talks"
}

# STAGE.log has what a stage said and details, whatever the terminal was shown; a refused call leaves the old one.
test_log_in_the_results() {
  scene
  expect_exit 0 preprocess
  expect_exit 0 solve -q
  expect_exit 0 postprocess
  local stage
  for stage in preprocess solve postprocess; do
    head -n 1 out/$stage.log | grep -q ' UTC: .*talus-'$stage' recipe.toml' || fail "$stage.log names no command"
    grep -qE '^ +[0-9]+\.[0-9] s  [^ ]' out/$stage.log || fail "$stage.log says nothing: $(<out/$stage.log)"
  done
  cp out/solve.log before
  expect_exit 2 solve --set solve.cfl=-1
  cmp before out/solve.log || fail "a refused call wrote a log"
}

# Every used recipe runs again and gives the same result.
test_used_recipes_are_recipes() {
  scene
  expect_exit 0 preprocess
  expect_exit 0 solve
  expect_exit 0 postprocess
  local stage
  for stage in preprocess solve postprocess; do
    grep -q 'sha256' out/$stage.used.toml || fail "$stage.used.toml names no checksum"
    expect_exit 0 "$bin/talus-$stage" out/$stage.used.toml --out out
  done
}

# --set: as if the recipe said it, in every stage, with --check and --plan too.
test_set_values_take_the_place_of_the_recipes() {
  scene
  expect_exit 0 preprocess --set preprocess.grid.layer_height_m=1 --set scene.title=Other
  grep -qxF '# set: preprocess.grid.layer_height_m=1' out/preprocess.used.toml || fail "the used recipe does not say it"
  grep -qF 'layer_height_m = 1.0' out/preprocess.used.toml || fail "the used recipe has another layer height"
  grep -qxF 'title = "Other"' out/preprocess.used.toml || fail "the used recipe has another title"

  # The domain is one of other values than the recipe's file has.
  expect_exit 3 solve --check
  expect_words 'another recipe made it'
  local set=(--set preprocess.grid.layer_height_m=1)
  expect_exit 0 solve "${set[@]}" --plan --set solve.end_time_s=2
  expect_words 'steps to 2 s'
  expect_exit 2 solve "${set[@]}" --check --set solve.end_time_s=-2
  expect_error 'talus-solve: --set solve.end_time_s=-2: [solve] end_time_s = -2 (out of range). It must be > 0'
  expect_exit 0 solve "${set[@]}" --set solve.end_time_s=2
  grep -qF 'end_time_s = 2.0' out/solve.used.toml || fail "the used recipe has another end"

  # A run of other values is refused as one of another recipe is; with the values it is taken.
  expect_exit 3 postprocess "${set[@]}"
  expect_words 'another recipe made it'
  expect_exit 0 postprocess "${set[@]}" --set solve.end_time_s=2 --set postprocess.deposit_threshold_m=0.3
  grep -qF 'deposit_threshold_m = 0.3' out/postprocess.used.toml || fail "the used recipe has another threshold"
  grep -qF 'postprocess.deposit_threshold_m=0.3' out/report.html || fail "the report does not name what was set"
}

test_set_values_are_noted() {
  scene
  cp before.asc other.asc
  expect_exit 0 preprocess --set preprocess.before_dem=other.asc
  grep -qF '# set: preprocess.before_dem=other.asc' out/preprocess.used.toml || fail "it is not said what was set"
  grep -qF "# input: $TALUS_SCRATCH/other.asc  sha256 " out/preprocess.used.toml || fail "the input is not noted"
  ! grep -qF '/before.asc' out/preprocess.used.toml || fail "the recipe's own value is noted"
}

test_gpu_that_is_not_there_is_refused() {
  scene
  expect_exit 0 preprocess
  if command -v nvidia-smi >/dev/null && nvidia-smi -L >/dev/null 2>&1; then skip "this machine has a GPU"; fi
  expect_exit 2 "$bin/talus-solve" recipe.toml --out out --on gpu
  expect_error "talus-solve: --on gpu (this machine has no GPU that the program can use). Use --on cpu or --on auto"
  expect_exit 2 "$bin/talus-solve" recipe.toml --out out --on gpus
  expect_error "talus-solve: --on gpus (this machine has no GPU that the program can use). Use --on cpu or --on auto"
  expect_no_file out domain.vdb preprocess.used.toml survey
}

# at_a_terminal LOG COMMAND...: what a person sees of it, without the lines of progress.
at_a_terminal() {
  local log=$1
  shift
  script -qec "${*@Q}" "$log.raw" >/dev/null </dev/null || fail "${*@Q}: $(<"$log.raw")"
  tr '\r' '\n' <"$log.raw" | grep -vE '^$|^Script (started|done)|%  eta' >"$log" || fail "nothing is shown"
}

test_a_terminal_shows_few_lines_and_the_report_last() {
  need_tool script
  scene
  local stage
  for stage in preprocess solve postprocess; do
    at_a_terminal shown "$bin/talus-$stage" recipe.toml --out out
    (($(wc -l <shown) <= 25)) || fail "$stage shows $(wc -l <shown) lines"
  done
  grep -q 'deposit CSI' shown || fail "the overlap is not shown"
  [[ $(tail -n 1 shown) == *out/report.html* ]] || fail "the last line is $(tail -n 1 shown)"
  at_a_terminal shown "$bin/talus-postprocess" recipe.toml --out out -v
  (($(grep -c '/out/' shown) >= 20)) || fail "-v does not list the files"
  at_a_terminal shown "$bin/talus" run recipe.toml --out anew
  (($(grep -cvE '^(warning|advice): ' shown) <= 25)) || fail "talus run shows $(wc -l <shown) lines"
  [[ $(tail -n 1 shown) == *anew/report.html\ * ]] || fail "the last line is $(tail -n 1 shown)"
}

# No line of progress is wider than the terminal, and percent and time to the end are on all of them.
test_progress_fits_the_terminal() {
  need_tool script
  scene
  expect_exit 0 preprocess
  local width
  for width in 40 80 120; do
    script -qec "stty cols $width; '$bin/talus-solve' recipe.toml --out out --on cpu --set solve.end_time_s=200 \
      --set solve.stop_kinetic_fraction=0" raw >/dev/null </dev/null || fail "$(<raw)"
    tr '\r' '\n' <raw | sed -n 's/\x1b\[K.*//; /%  eta/p' >lines
    grep -qE '^[0-9]+ %  eta (at most )?[0-9]+ ' lines || fail "$width columns: no time to the end: $(<raw)"
    ! grep -E "^.{$width}" lines || fail "$width columns: a line is wider"
  done
}

test_the_log_of_a_run_can_be_read_by_a_program() {
  scene
  TALUS_PROGRESS_S=0.001 expect_exit 0 "$bin/talus" run recipe.toml --out out --json
  python3 - <<'PYTHON' || fail "it is no log in JSON"
import json, os, sys
lines = [json.loads(line) for line in open(os.environ["TALUS_SCRATCH"] + "/stderr", encoding="utf-8")]
levels = {line["level"] for line in lines}
assert {"info", "progress", "warning"} <= levels <= {"info", "progress", "advice", "warning"}, levels
assert any(0 < line.get("percent", -1) <= 100 for line in lines), "no percent"
PYTHON
  expect_exit 2 "$bin/talus" run recipe.toml --out out --json --set solve.end_time_s=-1
  grep -q '^{"level":"error","text":"' "$TALUS_SCRATCH/stderr" || fail "a fault is no line of JSON"
}

run_test "$@"
