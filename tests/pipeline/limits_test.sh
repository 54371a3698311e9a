#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Limits of the process (ulimit): a message, an exit code of Talus, and nothing left that looks like work under way. And
# what a killed command leaves running: nothing.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

# under LIMIT STAGE CODES: the stage under `ulimit LIMIT` ends with one of the codes, says why unless it succeeds, and
# leaves no lock and no partial file.
under() {
  local code=0
  (
    ulimit $1
    exec "$bin/talus-$2" recipe.toml --out out
  ) 2>&1 >stdout </dev/null | cat >stderr || code=${PIPESTATUS[0]}   # the limit is not to be that of the messages
  [[ " $3 " == *" $code "* ]] || fail "exit code $code under ulimit $1"
  [[ $code -eq 0 ]] || grep -q "^talus-$2: " stderr || fail "no message under ulimit $1"
  [[ -z $(find out -name '*.partial' -o -name '*.lock') ]] || fail "left under ulimit $1: $(find out -name '.*')"
}

# longer KIB STAGE: files may not be longer; the stage says so and names the limit.
longer() {
  under "-f $1" "$2" 3
  expect_words "File too large"
}

test_length_of_files() {
  scene
  mkdir out
  longer 0 preprocess
  longer 8 preprocess
  expect_words ": cannot be written (it is longer than this process may write: File too large). " \
    "Raise the limit on files (ulimit -f)"
  expect_exit 0 preprocess
  longer 0 solve
  longer 20 solve
  expect_exit 0 solve
  longer 0 postprocess
  longer 20 postprocess
}

test_memory_files_and_stack() {
  scene
  expect_exit 0 preprocess
  local limit
  for limit in '-v 500000' '-n 8' '-n 12'; do under "$limit" solve "0 3"; done
  under "-s 32" solve "0 139"
}

# The shell's limit kills without a word: the stage ends before it, with what it has saved.
test_processor_time() {
  scene
  expect_exit 0 preprocess
  sed -i 's/^end_time_s.*/end_time_s = 1000000.0/' recipe.toml
  under "-t 6" solve 130
  expect_words "the limit of processor time comes near; raise it (ulimit -t)"
  [[ -s out/checkpoint.h5 ]] || fail "no checkpoint was left"
}

# killed SIGN WORDS...: the command in a session of its own is killed once a file of the pattern is there.
killed() {
  local sign=$1 left
  shift
  setsid "$@" >stdout 2>stderr </dev/null &
  local leader=$!
  while ! compgen -G "$sign" >/dev/null; do
    kill -0 $leader 2>/dev/null || fail "it ended by itself before $sign was there: $*"
    sleep 0.01
  done
  kill -KILL $leader
  wait $leader || true
  sleep 1
  left=$(pgrep -s $leader -a || true)
  [[ -z $left ]] || fail "left running: $left"
}

test_a_killed_command_leaves_no_process() {
  scene
  local sign
  sed -i 's/^end_time_s.*/end_time_s = 100.0\nframe_interval_s = 1.0/' recipe.toml
  for sign in 'out/.talus.lock' 'out/domain.vdb' 'out/.run.h5.*.partial' 'out/run.h5'; do
    rm -rf out
    killed "$sign" "$bin/talus" run recipe.toml --out out --on cpu
  done
  killed . "$bin/talus" new before.asc after.asc --recipe new.toml
}

run_test "$@"
