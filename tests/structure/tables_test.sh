#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Tables and pictures of figures: each shows one commit, and noted rows claim nothing.
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

tabulate() { /usr/bin/python3 "$TALUS_SOURCE/tools/tabulate-validation.py" "$@"; }

# sitting COMMIT CASE ROW...: a validation.json.
sitting() {
  local commit=$1 name=$2 rows
  shift 2
  rows=$(IFS=, && echo "$*")
  echo "{\"commit\": \"$commit\", \"date\": \"2026-11-22\", \"on\": \"cpu\", \"complete\": false, \"coarse\": false,
    \"cases\": [\"$name\"], \"rows\": [$rows]}"
}

common='"case": "X1", "computed": 1.02, "steps": 20, "place": "a processor"'
met="{$common, \"quantity\": \"way\", \"judged\": true, \"reference\": 1, \"error\": 0.02, \"tolerance\": 0.05,
  \"pass\": true}"
missed="{$common, \"quantity\": \"height\", \"judged\": true, \"reference\": 1, \"error\": 0.02, \"tolerance\": 0.01,
  \"pass\": false}"
noted="{$common, \"quantity\": \"speed\", \"judged\": false}"

test_noted_rows_claim_nothing() {
  sitting 1a2b3c4d5 X1 "$met" "$missed" "$noted" >one.json
  expect_exit 0 tabulate one.json table.md
  grep -qF '| way | 1.02 | 1 | 0.02 | 0.05 | met | 20 |' table.md || fail "no row that is met: $(<table.md)"
  grep -qF '| height | 1.02 | 1 | 0.02 | 0.01 | **missed** | 20 |' table.md || fail "no row that misses: $(<table.md)"
  grep -qF '| speed | 1.02 | - | - | noted | | 20 |' table.md || fail "no row that is noted: $(<table.md)"
  grep -qF '3 rows: 2 are judged, 1 of these miss their tolerance; 1 are noted' table.md || fail "counts: $(<table.md)"
}

test_commit_and_date_stand_in_it() {
  sitting 1a2b3c4d5 X1 "$met" >one.json
  expect_exit 0 tabulate one.json table.md
  grep -qF 'Commit 1a2b3c4d5, 2026-11-22, the quick runs, on a processor.' table.md || fail "heading: $(<table.md)"
}

test_rows_of_two_commits_are_refused() {
  sitting 1a2b3c4d5 X1 "$met" >one.json
  sitting 9f8e7d6c5 X2 "$met" >two.json
  expect_exit 1 tabulate one.json two.json table.md
  expect_words 'different commits (1a2b3c4d5, 9f8e7d6c5)'
  [[ ! -e table.md ]] || fail "it wrote a table of two states"
}

test_a_case_stands_in_it_once() {
  sitting 1a2b3c4d5 X1 "$met" >one.json
  expect_exit 1 tabulate one.json one.json table.md
  expect_words 'X1 in more than one file'
}

test_pages_show_the_rows_that_are_given() {
  mkdir -p tree/docs/explanation tree/tools
  cp "$TALUS_SOURCE/README.md" tree
  cp "$TALUS_SOURCE"/docs/explanation/{validation,performance}.md tree/docs/explanation
  cp -r "$TALUS_SOURCE/docs/benchmarks" tree/docs
  cp "$TALUS_SOURCE/tools/make-tables.py" tree/tools
  expect_exit 0 /usr/bin/python3 tree/tools/make-tables.py
  cmp tree/README.md "$TALUS_SOURCE/README.md" || fail "tables of the validation changed without its rows"
  sitting 1a2b3c4d5 B1 "${met//X1/B1}" "${missed//X1/B1}" >one.json
  expect_exit 0 tabulate one.json
  expect_exit 0 /usr/bin/python3 tree/tools/make-tables.py --validation validation-table.md
  grep -qF "| B1: block on an incline, any direction | Newton's law | 1 of 2 | 2 % | 2 % |" tree/README.md ||
    fail "README has no such row"
  grep -qF 'Commit 1a2b3c4, 2026-11-22, on a processor' tree/README.md || fail "README names no commit"
  expect_exit 1 /usr/bin/python3 tree/tools/make-tables.py --validation nowhere.md
  expect_words 'nowhere.md was not found' 'make validate'
}

test_rows_of_two_commits_are_not_drawn() {
  local table=$TALUS_SOURCE/docs/benchmarks/speed-against-error.csv commit
  commit=$(sed -n '$p' "$table" | grep -oE ',[0-9a-f]{9},' | tr -d ,)
  sed "\$s/,$commit,/,0123abcde,/" "$table" >mixed.csv
  expect_exit 1 /usr/bin/python3 "$TALUS_SOURCE/tools/plot-speed-against-error.py" mixed.csv drawn.png
  expect_words 'rows of more than one commit'
  [[ ! -e drawn.png ]] || fail "it was drawn"
}

run_test "$@"
