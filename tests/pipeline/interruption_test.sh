#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Ctrl-C: a checkpoint is left from which the run goes on to the same result; nothing looks finished.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

# What an interrupted solver may leave: the checkpoint, and the frames so far, hidden.
nothing_looks_finished() {
  [[ ! -s stdout ]] || fail "an interrupted run names results on stdout"
  rm -rf out/.frames
  expect_no_file out domain.vdb preprocess.used.toml survey checkpoint.h5
}

long_scene() {
  scene
  expect_exit 0 preprocess
  sed -i 's/^end_time_s.*/end_time_s = 1000000.0/' recipe.toml
}

test_solve_leaves_a_checkpoint() {
  long_scene
  interrupt INT 'out/.run.h5.*.partial' "$bin/talus-solve" recipe.toml --out out --on cpu
  [[ -s out/checkpoint.h5 ]] || fail "no checkpoint was left"
  expect_words "(interrupted). Go on with --restart; out/checkpoint.h5 holds the state"
  grep -q 'stopped at t' out/solve.log || fail "the log does not say that it was stopped: $(<out/solve.log)"
  grep -qE '^talus-solve: stopped at t = [0-9.]+ s, step [1-9][0-9]* ' stderr || fail "it does not say where it stopped"
  nothing_looks_finished
}

test_termination_is_the_same() {
  long_scene
  interrupt TERM 'out/.run.h5.*.partial' "$bin/talus-solve" recipe.toml --out out --on cpu
  [[ -s out/checkpoint.h5 ]] || fail "no checkpoint was left"
  nothing_looks_finished
}

# A power cut: no time to tidy up, but the checkpoint of before holds, and nothing else looks finished.
test_killed_run_goes_on_from_its_last_checkpoint() {
  long_scene
  sed -i 's/^end_time_s.*/end_time_s = 100.0\ncheckpoint_interval_s = 5.0/' recipe.toml
  "$bin/talus-solve" recipe.toml --out out --on cpu >stdout 2>stderr &
  local process=$!
  while [[ ! -e out/checkpoint.h5 ]]; do sleep 0.02; done
  kill -KILL $process
  wait $process || true
  [[ ! -e out/run.h5 && ! -s stdout ]] || fail "a killed run looks finished"
  expect_exit 0 solve --restart
  expect_stdout_paths
}

test_restart_gives_the_unbroken_result() {
  need_tool h5diff
  scene
  make_checkpoint out
  expect_exit 0 solve --restart
  expect_words "going on from out/checkpoint.h5"
  [[ ! -e out/checkpoint.h5 && ! -e out/.frames ]] || fail "a finished run leaves a checkpoint or frames behind"
  expect_exit 0 "$bin/talus-preprocess" recipe.toml --out unbroken
  expect_exit 0 "$bin/talus-solve" recipe.toml --out unbroken --on cpu
  local group
  for group in /maps /frames /history /VTKHDF; do
    expect_exit 0 h5diff -v1 out/run.h5 unbroken/run.h5 $group
  done
}

test_checkpoint_of_another_recipe_is_refused() {
  scene
  make_checkpoint out
  sed -i 's/^friction_angle_deg = 15.0/friction_angle_deg = 16.0/' recipe.toml
  expect_exit 3 solve --restart
  expect_error "talus-solve: out/checkpoint.h5: the checkpoint belongs to another domain or other [solve] " \
    "settings (going on from it would mix two runs). Restore the recipe and domain.vdb it was made with, or run " \
    "talus-solve without --restart"
  [[ ! -e out/run.h5 ]] || fail "a run came of it"
}

# The run of before stays, with its maps, until the new one is whole.
test_a_run_that_fails_leaves_the_one_of_before() {
  scene
  expect_exit 0 preprocess
  expect_exit 0 solve
  cp out/run.h5 before.h5
  sed -i 's/^end_time_s.*/end_time_s = 1000000.0/' recipe.toml
  interrupt KILL 'out/.run.h5.*.partial' "$bin/talus-solve" recipe.toml --out out --on cpu
  cmp out/run.h5 before.h5 || fail "the run of before is gone, or another one"
  rm out/.run.h5.*.partial   # of the killed run: the sign below is to be the next one's
  interrupt TERM 'out/.run.h5.*.partial' "$bin/talus-solve" recipe.toml --out out --on cpu
  cmp out/run.h5 before.h5 || fail "the run of before is gone, or another one"
  expect_exit 3 postprocess   # and nobody takes it for one of the new recipe
  expect_words "out/run.h5: another recipe made it"
}

test_a_checkpoint_of_this_run_is_not_thrown_away() {
  scene
  make_checkpoint out
  cp out/checkpoint.h5 before.h5
  expect_exit 3 solve
  grep -qE "^talus-solve: out/checkpoint.h5: it holds this very run at t = [0-9.]+ s, step [0-9]+ " stderr ||
    fail "it does not say what the checkpoint holds"
  expect_words "Go on from it with --restart, or remove it to begin anew"
  cmp out/checkpoint.h5 before.h5 || fail "the checkpoint was touched"
  expect_exit 0 solve --resume
  expect_words "going on from out/checkpoint.h5"
  expect_exit 0 solve --resume   # nothing to go on from: from the start
  ! grep -q "going on" stderr || fail "it goes on from nothing"
}

test_a_checkpoint_of_another_recipe_stays_until_it_is_replaced() {
  scene
  make_checkpoint out
  cp out/checkpoint.h5 before.h5
  sed -i 's/^friction_angle_deg = 15.0/friction_angle_deg = 16.0/; s/^checkpoint_interval_s.*//' recipe.toml
  interrupt KILL 'out/.run.h5.*.partial' "$bin/talus-solve" recipe.toml --out out --on cpu --resume
  expect_words "a checkpoint of another domain or other [solve] settings; it stays until this run has one of its own"
  cmp out/checkpoint.h5 before.h5 || fail "the checkpoint of the other recipe is gone"
  sed -i 's/^friction_angle_deg = 16.0/friction_angle_deg = 15.0/; s/^end_time_s.*/&\ncheckpoint_interval_s = 5.0/' \
    recipe.toml
  expect_exit 0 solve --restart   # its frames are there too
}

# A checkpoint whose frames were lost is said, and the pipeline's --resume begins anew.
test_resume_without_frames_begins_anew() {
  scene
  make_checkpoint out
  rm -r out/.frames
  expect_exit 3 solve --restart
  expect_words "frames of the broken-off run are missing"
  expect_exit 0 solve --resume
  expect_words "frames of the broken-off run are missing" "The run begins anew"
}

# hears STAGE DELAY...: SIGTERM after each of these delays ends the stage with 130, in far less time than its work
# takes, and leaves nothing hidden. The limit is for a busy machine; the end itself comes within a second.
hears() {
  local stage=$1 delay code process begun heard=0
  shift
  for delay in "$@"; do
    code=0
    "$bin/talus-$stage" recipe.toml --out out >stdout 2>stderr </dev/null &
    process=$!
    sleep "$delay"
    begun=$SECONDS
    kill -TERM $process 2>/dev/null || true
    wait $process || code=$?
    # 143: it had not come to its first line yet, a busy machine still loaded its libraries.
    [[ $code -eq 130 || $code -eq 0 || $code -eq 143 ]] || fail "exit code $code after SIGTERM"
    [[ $code -ne 130 ]] || heard=$((heard + 1))
    [[ $((SECONDS - begun)) -le 20 ]] || fail "talus-$stage went on for $((SECONDS - begun)) s after SIGTERM"
    [[ -z $(find out -name '.*' -type f) ]] || fail "left behind: $(find out -name '.*' -type f)"
  done
  [[ $heard -ge 1 ]] || fail "talus-$stage was always done before the signal: this test looks at nothing"
}

test_preprocess_hears_the_signal() {
  need_tool gdal_translate
  scene
  local name
  for name in before after; do
    gdal_translate -q -outsize 2000 2000 -r bilinear -a_srs EPSG:32611 $name.asc $name.tif
  done
  sed -i 's/\.asc"/.tif"/' recipe.toml
  hears preprocess 0.3 1 3 6
}

test_postprocess_hears_the_signal() {
  need_tool gdal_translate
  scene
  gdal_translate -q -outsize 2000 2000 survey.asc survey.tif   # which is drawn 200 times
  sed -i 's/^thickness = .*/thickness = "survey.tif"\nsigma_m = 0.28/' recipe.toml
  expect_exit 0 preprocess
  expect_exit 0 solve
  hears postprocess 0.3 1 3 9
}

# Gravity loading has nothing to save: it stops at once.
test_gravity_loading_hears_the_signal() {
  scene
  sed -i 's/^end_time_s.*/end_time_s = 1.0\ngravity_loading_steps = 100000/' recipe.toml
  expect_exit 0 preprocess
  interrupt TERM out/.talus.lock "$bin/talus-solve" recipe.toml --out out --on cpu
  expect_no_file out domain.vdb preprocess.used.toml survey
}

# A step of these takes minutes of processor time: it is given up where the signal comes, and the state of its start is
# saved. The limit is for a busy machine; the end itself comes within a second.
implicit_step_is_given_up() {
  local begun
  scene
  sed -i "s/^layer_height_m.*/layer_height_m = 0.25\nspacing_m = 5.0/" recipe.toml
  sed -i "s/^end_time_s.*/&\nintegrator = \"$1\"/" recipe.toml
  cat >>recipe.toml <<'TOML'

[solve.implicit]
step_s = 1.0
newton_tolerance = 1e-13
linear_tolerance = 1e-14
TOML
  expect_exit 0 preprocess
  begun=$SECONDS
  interrupt TERM 'out/.run.h5.*.partial' "$bin/talus-solve" recipe.toml --out out --on cpu
  [[ $((SECONDS - begun)) -le 30 ]] || fail "the run took $((SECONDS - begun)) s from its start to its end"
  expect_words 'stopped at t = 0.000 s, step 0 (interrupted). Go on with --restart; out/checkpoint.h5 holds the state'
  nothing_looks_finished
}

test_a_step_towards_equilibrium_hears_the_signal() { implicit_step_is_given_up quasi-static; }
test_a_newmark_step_hears_the_signal() { implicit_step_is_given_up newmark; }

test_restart_without_checkpoint_is_refused() {
  scene
  expect_exit 0 preprocess
  expect_exit 3 solve --restart
  expect_error "talus-solve: out/checkpoint.h5: no such file. Run talus-solve again without --restart"
}

run_test "$@"
