#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# What 'make demo' and 'make test' do before they run anything; demo_results_test.sh runs the demo.
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

test_make_demo_runs_this_pipeline() {
  expect_exit 0 make -n -C "$TALUS_SOURCE" demo SETUP=no BUILD="$TALUS_BUILD"
  grep -q 'pipelines synthetic-valley' stdout || fail "make demo does not run the pipeline synthetic-valley"
  grep -q 'show-six-numbers.sh .*synthetic-valley/score.txt' stdout || fail "make demo does not show the numbers"
}

test_make_demo_installs_nothing_for_tests() {
  local packages
  expect_exit 0 make -n -C "$TALUS_SOURCE" demo BUILD="$TALUS_BUILD" OUT="$TALUS_SCRATCH/out"
  grep -qE 'tools/install-dependencies\.sh *$' stdout || fail "make demo installs: $(grep install- stdout)"
  grep -q 'minutes on' stdout || fail "make demo does not say how long it takes"
  expect_exit 0 make -n -C "$TALUS_SOURCE" test BUILD="$TALUS_BUILD"
  grep -qE 'tools/install-dependencies\.sh +tests *$' stdout || fail "make test does not install what tests need"
  packages=$("$TALUS_SOURCE/tools/install-dependencies.sh" --list)
  if grep -qE '^(ffmpeg|chromium|libgtest-dev|python3-selenium|cdo)$' <<<"$packages"; then
    fail "building and running would install: $(grep -E '^(ffmpeg|chromium|lib.*test.*)' <<<"$packages")"
  fi
}

test_ci_runs_make_test() {
  grep -qx 'make test' "$TALUS_SOURCE/.ci/run" || fail ".ci/run does not call make test"
  expect_exit 0 make -n -C "$TALUS_SOURCE" test SETUP=no BUILD="$TALUS_BUILD"
  grep -q 'ctest --test-dir' stdout || fail "make test does not run ctest"
}

run_test "$@"
