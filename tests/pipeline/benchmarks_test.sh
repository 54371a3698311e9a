#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# The benchmarks at their smallest, so that they cannot rot: what they time is checked, and the tables are whole.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

test_kernels_are_checked_and_timed() {
  expect_exit 0 "$bin/talus-bench" kernels --on cpu --most 1e4 --out out
  [[ -s out/kernels-time.png && -s out/kernels-memory.png ]] || fail "no pictures"
  [[ $(wc -l <out/kernels.csv) -eq 7 ]] || fail "not six ways of stepping: $(<out/kernels.csv)"
  awk -F, 'NR > 1 && !($7 > 0 && $8 > 0 && $9 > 100) { exit 1 }' out/kernels.csv ||
    fail "a time or a size is missing: $(<out/kernels.csv)"
  grep -q 'points to grid: ' out/kernels.csv || fail "no phases"
  # Which program was timed, and when: the last two columns.
  [[ $(head -n 1 out/kernels.csv) == *,commit,date ]] || fail "no commit and date: $(head -n 1 out/kernels.csv)"
  [[ $(grep -cE ",(unknown|[0-9a-f]{7,}),$(date -u +%Y)-[0-9]{2}-[0-9]{2}\$" out/kernels.csv) -eq 6 ]] ||
    fail "rows without commit or date: $(tail -n 1 out/kernels.csv)"
}

test_sets_are_listed() {
  expect_exit 0 make -s -C "$TALUS_SOURCE/pipelines/benchmarks" help
  for set in kernels paper scenes speed-against-error; do
    grep -q "^  $set " stdout || fail "the set $set is not listed"
  done
}

run_test "$@"
