#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# The table of speed against error: rows of one commit and one machine, every method at the same modulus.
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

table=$TALUS_SOURCE/docs/benchmarks/speed-against-error.csv

# column NAME: the values of a column where there is a result.
column() {
  python3 - "$table" "$1" <<'PYTHON'
import csv, sys
with open(sys.argv[1], newline="") as file:
    for row in csv.DictReader(file):
        if row["steps"] != "failed":
            print(row[sys.argv[2]])
PYTHON
}

test_rows_are_of_one_commit_and_machine() {
  need_tool python3
  local key kinds
  for key in commit machine; do
    kinds=$(column "$key" | sort | uniq -c)
    [[ $(wc -l <<<"$kinds") -eq 1 ]] || fail "rows of more than one $key: $kinds"
  done
  [[ $(column steps | wc -l) -gt 50 ]] || fail "only $(column steps | wc -l) rows have a result"
}

test_sets_are_called_by_what_they_show() {
  need_tool python3
  local sets
  sets=$(column set | sort -u | paste -sd,)
  [[ $sets == 'Frank Slide,at rest,cost of steps,sand column' ]] || fail "other sets than those of the program: $sets"
  # The program's own words for them.
  local name
  for name in 'Frank Slide' 'at rest' 'cost of steps' 'sand column'; do
    grep -qF "\"$name\"" "$TALUS_SOURCE/pipelines/benchmarks/speed_against_error.py" || fail "it knows no set $name"
  done
}

test_kernels_say_of_which_commit_and_day_they_are() {
  local kernels=$TALUS_SOURCE/docs/benchmarks/kernels-h200.csv page=$TALUS_SOURCE/docs/explanation/benchmarks.md
  local of
  of=$(sed -nE '2,$s/.*,([0-9a-f]{7,}),(20[0-9]{2}-[0-9]{2}-[0-9]{2})$/commit \1, \2/p' "$kernels" | sort | uniq -c)
  [[ $(wc -l <<<"$of") -eq 1 && $of =~ ^\ *$(($(wc -l <"$kernels") - 1))\  ]] || fail "not every row says it: $of"
  grep -qF "NVIDIA H200, explicit steps, commit" "$page" && grep -qF "${of##*[0-9] }" "$page" ||
    fail "benchmarks.md does not say: $of"
}

test_rows_of_two_commits_are_refused() {
  need_tool python3
  local commit
  commit=$(column commit | sed -n 1p)
  sed "\$s/,$commit,/,0123abcde,/" "$table" >mixed.csv
  ! cmp -s "$table" mixed.csv || fail "the last row does not name $commit"
  expect_exit 1 python3 "$TALUS_SOURCE/tools/plot-speed-against-error.py" mixed.csv drawn.png
  local both
  both=$(printf '%s\n' 0123abcde "$commit" | sort | paste -sd, | sed 's/,/, /')
  grep -qF "rows of more than one commit ($both)" stderr || fail "no reason: $(<stderr)"
  [[ ! -e drawn.png ]] || fail "it was drawn"
}

run_test "$@"
