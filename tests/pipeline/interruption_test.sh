#!/usr/bin/env bash
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
  interrupt INT out/.frames/frame_00001.h5 "$bin/talus-solve" recipe.toml --out out --on cpu
  [[ -s out/checkpoint.h5 ]] || fail "no checkpoint was left"
  expect_words "(interrupted). Go on with --restart; $PWD/out/checkpoint.h5 holds the state"
  grep -qE '^talus-solve: stopped at t = [0-9.]+ s, step [1-9][0-9]* ' stderr || fail "it does not say where it stopped"
  nothing_looks_finished
}

test_termination_is_the_same() {
  long_scene
  interrupt TERM out/.frames/frame_00001.h5 "$bin/talus-solve" recipe.toml --out out --on cpu
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
  expect_words "going on from $PWD/out/checkpoint.h5"
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
  expect_error "talus-solve: $PWD/out/checkpoint.h5: the checkpoint belongs to another domain or other [solve] " \
    "settings (going on from it would mix two runs). Restore the recipe and domain.vdb it was made with, or run " \
    "talus-solve without --restart"
  [[ ! -e out/run.h5 ]] || fail "a run came of it"
}

test_restart_without_checkpoint_is_refused() {
  scene
  expect_exit 0 preprocess
  expect_exit 3 solve --restart
  expect_error "talus-solve: $PWD/out/checkpoint.h5: no such file. Run talus-solve again without --restart"
}

run_test "$@"
