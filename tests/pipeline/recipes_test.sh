#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Random recipes within the allowed ranges end in a result that holds, or in a clear refusal (tools/check-recipes.py);
# `make check-recipes` draws 500.
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

test_a_few_that_are_drawn_end_in_a_result_or_a_clear_refusal() {
  /usr/bin/python3 -c 'import osgeo' 2>/dev/null || need_tool python3-gdal
  # Without 1017: 100,000 steps of gravity loading, which do not hear SIGTERM.
  local first count
  while read -r first count; do
    expect_exit 0 /usr/bin/python3 "$TALUS_SOURCE/tools/check-recipes.py" --bin "$bin" --out drawn \
      --first "$first" --count "$count" --time 5 --jobs 2
    grep -q "^$count recipes, " stdout || fail "the table is not there: $(<stdout)"
  done < <(printf '%s\n' '1000 17' '1018 6')
}

# The check itself: what must be a fault is one.
test_what_is_wrong_is_found() {
  /usr/bin/python3 -c 'import osgeo' 2>/dev/null || need_tool python3-gdal
  mkdir bin
  local program
  for program in preprocess solve postprocess; do ln -s "$bin/talus-$program" bin/; done
  rm bin/talus-solve
  cat >bin/talus-solve <<SOLVE
#!/usr/bin/env bash
[[ \$1 == --template ]] && exec "$bin/talus-solve" --template
echo 'talus-solve: std::bad_function_call (this is a bug). Please report it' >&2
exit 1
SOLVE
  chmod +x bin/talus-solve
  expect_exit 1 /usr/bin/python3 "$TALUS_SOURCE/tools/check-recipes.py" --bin bin --out drawn --first 1000 --count 4
  grep -q 'FAULT' stdout || fail "a bug is no fault: $(<stdout)"
}

run_test "$@"
