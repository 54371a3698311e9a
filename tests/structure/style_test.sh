#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# The documents' style, citations, and tables of figures (tools/check-style.py, tools/make-tables.py).
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

test_sentences_and_paragraphs_are_short() {
  expect_exit 0 python3 "$TALUS_SOURCE/tools/check-style.py" sentences
  grep -qE '^[3-9][0-9]+ pages' stdout || fail "fewer than thirty pages were looked at: $(cat stdout)"
}

test_pages_speak_of_the_subject() {
  expect_exit 0 python3 "$TALUS_SOURCE/tools/check-style.py" words
}

test_every_work_that_is_cited_is_in_the_bibliography() {
  expect_exit 0 python3 "$TALUS_SOURCE/tools/check-style.py" citations
  grep -qE '^[2-9][0-9][0-9]+ citations' stdout || fail "fewer than 200 citations were found: $(cat stdout)"
}

test_tables_of_pages_are_those_of_their_files() {
  expect_exit 0 python3 "$TALUS_SOURCE/tools/make-tables.py" --check
  grep -qE '^[5-9] tables' stdout || fail "fewer than five tables were found: $(cat stdout)"
}

# The test itself: each fault is named with its place and its mend.
test_what_is_wrong_is_named() {
  mkdir -p tree/docs/reference tree/docs/how-to
  git -C tree init -q   # of its own: the build folder, in which it lies, is one that the checkout ignores
  printf '%s\n' '# Bibliography' '' '- Horn, B. K. P. (1981). Hill shading.' >tree/docs/reference/bibliography.md
  { printf '# Page\n\n'; printf 'word %.0s' {1..120}; printf '\n\nOur goal is (Horn 1981).\n'; } >tree/docs/how-to/a.md
  local year=1999   # not written out behind the names, which are made up
  printf '%s\n' '/// Slope after Horn (1981) and' "/// Nobody & Never $year." >tree/slope.hpp
  expect_exit 1 python3 "$TALUS_SOURCE/tools/check-style.py" sentences "$TALUS_SCRATCH/tree"
  expect_words 'docs/how-to/a.md:3: a paragraph of 120 words'
  expect_exit 1 python3 "$TALUS_SOURCE/tools/check-style.py" words "$TALUS_SCRATCH/tree"
  expect_words "docs/how-to/a.md:5: 'goal'"
  expect_exit 1 python3 "$TALUS_SOURCE/tools/check-style.py" citations "$TALUS_SCRATCH/tree"
  expect_words "slope.hpp: 'Nobody & Never $year' is cited" 'Add an entry there'
  [[ $(grep -c 'is cited' stderr) -eq 1 ]] || fail "more than one work was missed: $(cat stderr)"
}

# Who describes the reference paper's scheme names the paper in full.
test_the_reference_paper_is_cited_in_full_where_it_is_named() {
  cd "$TALUS_SOURCE"
  local page missing=""
  while IFS= read -r page; do
    grep -q '10.1007/s11440-023-02155-1' "$page" || missing+=" $page"
  done < <(grep -liE 'reference paper|preset = "reference"|the paper.s (own )?scheme' README.md docs/*/*.md \
    pipelines/*/README.md)
  [[ -z $missing ]] || fail "these pages name the reference paper without its title and DOI:$missing"
}

run_test "$@"
