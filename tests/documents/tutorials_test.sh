#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Every tutorial, run as it is written, with the built programs in an empty folder.
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

python=/usr/bin/python3

# run_tutorial NAME [PICTURE...]: the page runs as written and draws its pictures as they are stored; none is blank.
run_tutorial() {
  local page=$1 picture
  shift
  if ! "$python" -c 'import matplotlib' 2>/dev/null; then
    [[ -z ${TALUS_REQUIRE_TOOLS:-} ]] || fail "matplotlib is missing (make setup-tests installs it)"
    skip "matplotlib is not installed (make setup-tests installs it)"
  fi
  need_tool chromium
  expect_exit 0 "$python" "$TALUS_SOURCE/tools/run-tutorial.py" "$TALUS_SOURCE/docs/tutorials/$page.md" --bin "$bin" \
    --work "$TALUS_SCRATCH/work" --pictures "$TALUS_SCRATCH/pictures" --compare "$TALUS_SOURCE/docs/pictures"
  for picture in "$@"; do
    [[ -f $TALUS_SOURCE/docs/pictures/$picture ]] || fail "docs/pictures/$picture is missing. Make it: make pictures"
    [[ $(stat -c %s "$TALUS_SCRATCH/pictures/$picture") -gt 10000 ]] || fail "$picture is blank"
  done
}

test_first_run() { run_tutorial first-run first-run-map.png first-run-report.png; }
test_your_own_slide() { run_tutorial your-own-slide your-own-slide-map.png; }
test_friction() { run_tutorial friction friction-weakening.png; }
test_slope_that_may_fail() { run_tutorial slope-that-may-fail slope-critical.png slope-run.png; }
test_loose_or_dense() { run_tutorial loose-or-dense wet-slide-loose.png wet-slide-dense.png; }
test_next_slide() { run_tutorial next-slide posterior.png next-slide.png; }
test_impact() { run_tutorial impact impact-map.png impact-force.png; }
test_how_far() { run_tutorial how-far how-far-run-out.png; }

test_every_tutorial_is_run_and_shows_a_picture() {
  local page
  for page in "$TALUS_SOURCE"/docs/tutorials/*.md; do
    page=$(basename "$page" .md)
    [[ $page != index ]] || continue
    grep -q "run_tutorial $page " "$TALUS_SOURCE/tests/documents/tutorials_test.sh" ||
      fail "no test runs docs/tutorials/$page.md"
    grep -q '<!-- picture: ' "$TALUS_SOURCE/docs/tutorials/$page.md" || fail "$page.md shows no picture of its run"
  done
}

# The test itself: a command that fails and a line that does not come are named with the page's own words.
test_what_a_page_gets_wrong_is_named() {
  mkdir "$TALUS_SCRATCH/pages"
  printf '%s\n' '# Page' '' '```console' '$ echo 12 m and more' '12.2 m and more' '$ echo 14 m' '12 m' '```' \
    >"$TALUS_SCRATCH/pages/wrong.md"
  expect_exit 1 "$python" "$TALUS_SOURCE/tools/run-tutorial.py" "$TALUS_SCRATCH/pages/wrong.md" --bin "$bin" \
    --work "$TALUS_SCRATCH/work"
  expect_words 'wrong.md: $ echo 14 m' 'does not print' '    12 m' 'It printed' '    14 m'
  printf '%s\n' '# Page' '' '```console' '$ false' '```' >"$TALUS_SCRATCH/pages/fails.md"
  expect_exit 1 "$python" "$TALUS_SOURCE/tools/run-tutorial.py" "$TALUS_SCRATCH/pages/fails.md" --bin "$bin" \
    --work "$TALUS_SCRATCH/work2"
  expect_words 'fails.md: $ false' 'ended with 1'
}

run_test "$@"
