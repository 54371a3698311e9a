#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# What stands in the output folder under the name of a result: a link, a pipe, a folder. Nothing is followed out of
# --out, nothing is waited for, and the name is said.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

# put_in_the_way KIND NAME: a link to a file or folder elsewhere, a pipe or a folder takes the name.
put_in_the_way() {
  local is_folder=
  [[ ! -d $2 ]] || is_folder=yes
  rm -rf "$2" elsewhere
  mkdir elsewhere
  echo x >elsewhere/victim
  case $1 in
    link) ln -s "$PWD/elsewhere${is_folder:-/victim}" "$2" ;;
    pipe) mkfifo "$2" ;;
    folder) mkdir "$2" ;;
  esac
  if [[ $1 == link && -n $is_folder ]]; then ln -sfn "$PWD/elsewhere" "$2"; fi
}

# keeps_inside STAGE NAME: it names what is in the way, or removes it as an old result; nothing elsewhere has changed.
keeps_inside() {
  local code=0
  timeout 60 "$bin/talus-$1" recipe.toml --out out >stdout 2>stderr || code=$?
  if ((code == 0)); then
    [[ ! -L $2 && (! -e $2 || -f $2 || -d $2) ]] || fail "$2 is still in the way"
  else
    ((code == 3)) || fail "exit code $code: $(<stderr)"
    expect_words "$2: cannot be " " (it is a "   # written; or read, where the stage looks for its last record first
    refused=$((refused + 1))
  fi
  [[ $(cat elsewhere/victim) == x && $(ls -A elsewhere) == victim ]] || fail "$2 was followed"
}

# every_name STAGE: each name that it writes, as each kind, then each folder that it makes, as a link and a pipe.
every_name() {
  local stage=$1 name kind looked=0 refused=0
  cp -a out before
  "$bin/talus-$stage" recipe.toml --out out >paths 2>/dev/null || fail "talus-$stage does not run"
  cp -a out made
  while IFS= read -r name; do
    for kind in link pipe folder; do
      [[ -f made/$name || $kind != folder ]] || continue
      rm -rf out
      cp -a made out
      put_in_the_way $kind "out/$name"
      keeps_inside "$stage" "out/$name"
      looked=$((looked + 1))
    done
  done < <(cd made && find . -mindepth 1 -printf '%P\n' | while read -r name; do
    [[ -e ../before/$name ]] || echo "$name"
  done)
  [[ $looked -ge 3 && $((2 * refused)) -ge $looked ]] || fail "$refused of $looked ways refused: this test sees nothing"
}

test_preprocess() {
  scene
  mkdir out
  every_name preprocess
}

test_solve() {
  scene
  sed -i 's/^end_time_s.*/end_time_s = 0.5\ncheckpoint_interval_s = 0.2/' recipe.toml
  expect_exit 0 preprocess
  every_name solve
  local name kind
  for name in checkpoint.h5 .frames .talus.lock; do
    for kind in link pipe folder; do
      [[ $name != .frames || $kind != folder ]] || continue
      rm -rf out
      cp -a before out
      [[ $name != .frames ]] || mkdir out/.frames
      put_in_the_way $kind "out/$name"
      expect_exit 3 timeout 60 "$bin/talus-solve" recipe.toml --out out
      expect_words "out/$name: "
      [[ $(cat elsewhere/victim) == x && $(ls -A elsewhere) == victim ]] || fail "$name was followed"
    done
  done
}

test_postprocess() {
  scene
  sed -i 's/^end_time_s.*/end_time_s = 0.5/' recipe.toml
  expect_exit 0 preprocess
  expect_exit 0 solve
  every_name postprocess
}

# The folder of the results itself is the user's choice.
test_a_linked_output_folder_is_taken() {
  scene
  mkdir real
  ln -s real out
  expect_exit 0 preprocess
  expect_exit 0 solve
  expect_exit 0 postprocess
  [[ -s real/maps/deposit_thickness.tif || -s real/report.html ]] || fail "the results are not there"
}

run_test "$@"
