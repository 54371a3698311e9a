#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Ground that shakes, through the programs: what acts is recorded, and another accelerogram is another run.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

# record STRENGTH: record.csv, a wave of a second [g].
record() {
  awk -v strength="$1" 'BEGIN {
    print "time_s,east,up"
    for (n = 0; n <= 100; ++n) printf "%.2f,%.6f,0\n", n / 100, strength * sin(6.283185307 * n / 100)
  }' >record.csv
}

shaking_scene() {
  scene
  record 0.3
  printf '[solve.shaking]\nfile = "record.csv"\nunit = "g"\nstart_s = 0.5\n\n' >shaking
  awk 'FNR == NR { table = table $0 "\n"; next } /^\[postprocess.survey\]/ { printf "%s", table } { print }' \
    shaking recipe.toml >shaken.toml
  mv shaken.toml recipe.toml
}

test_shaking_is_planned_recorded_and_listed() {
  shaking_scene
  expect_exit 0 preprocess
  expect_exit 0 solve --plan
  expect_words "shaking      101 samples from 0.5 to 1.5 s, up to 2.94 m/s2"
  expect_exit 0 solve
  grep -q "energy gain unknown; fastest point .* fall without loss unknown" stderr ||
    fail "the work of the shaking counts as a gain: $(grep sanity stderr)"
  grep -q 'input: .*record.csv  sha256' out/solve.used.toml || fail "solve.used.toml does not name the accelerogram"
  expect_exit 0 postprocess
  awk -F, 'NR == 1 { for (c = 1; c <= NF; ++c) if ($c == "ground_velocity_x_m_s") at = c }
    at && NR > 1 && $at > most { most = $at }
    END { exit !(most > 0.8 && most < 1) }' out/history.csv || fail "the ground did not run at 0.3 g / pi / 1 Hz"
}

test_another_accelerogram_is_another_run() {
  shaking_scene
  make_checkpoint out
  expect_exit 3 solve
  expect_words "it holds this very run"
  record 0.31
  expect_exit 3 solve --restart
  expect_words "the checkpoint belongs to another domain or other [solve] settings"
}

test_wrong_unit_is_refused_by_name() {
  shaking_scene
  record 294
  expect_exit 0 preprocess
  expect_exit 3 solve
  expect_words 'accept = ["strong-shaking"] in [solve]'
}

test_file_that_is_no_accelerogram() {
  shaking_scene
  echo "0.0 1.0" >record.csv
  expect_exit 0 preprocess
  expect_exit 3 solve
  expect_words 'record.csv: line 1, column 1: "0.0" (it is no name of a column)'
}

run_test "$@"
