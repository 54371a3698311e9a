#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# One version, said in one place and repeated right; the licence in every source; what a repository says of itself.
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

version_of() { sed -nE 's/^project\(talus VERSION ([0-9.]+).*/\1/p' "$1/CMakeLists.txt"; }

test_citation_and_changes_name_the_version() {
  cd "$TALUS_SOURCE"
  local version newest
  version=$(version_of .)
  [[ -n $version ]] || fail "CMakeLists.txt names no version"
  grep -qx "version: $version" CITATION.cff || fail "CITATION.cff is of $(grep ^version: CITATION.cff), not $version"
  newest=$(sed -nE 's/^## \[([0-9.]+)\] - .*/\1/p' CHANGELOG.md | sed q)
  [[ -z $newest || $newest == "$version" ]] || fail "the newest release in CHANGELOG.md is $newest, not $version"
  grep -qx '## \[Unreleased\]' CHANGELOG.md || fail "CHANGELOG.md has no place for the next changes"
}

# The version stands nowhere else in what is built or packed.
test_version_is_written_once() {
  cd "$TALUS_SOURCE"
  local version found
  version=$(version_of .)
  found=$(grep -rnF "$version" CMakeLists.txt cmake packaging tools Makefile |
    grep -v '^CMakeLists.txt:[0-9]*:project' || true)
  [[ -z $found ]] || fail "the version is written again:"$'\n'"$found"
}

test_release_sets_version_date_and_heading() {
  cp "$TALUS_SOURCE"/{CMakeLists.txt,CITATION.cff,CHANGELOG.md} .
  mkdir -p docs/benchmarks
  printf 'case,commit,date\nA1,1a2b3c4d5,2096-01-02\n' >docs/benchmarks/validation.csv
  export TALUS_RELEASE_OF=$TALUS_SCRATCH
  expect_exit 0 "$TALUS_SOURCE/tools/release.sh" 97.1.2 2097-05-04
  grep -q 'validation.csv is of commit 1a2b3c4d5\.' stdout || fail "it names no state of the validation: $(<stdout)"
  [[ $(version_of .) == 97.1.2 ]] || fail "CMakeLists.txt has $(version_of .)"
  grep -qx 'version: 97.1.2' CITATION.cff && grep -qx 'date-released: 2097-05-04' CITATION.cff ||
    fail "$(<CITATION.cff)"
  grep -A2 -x '## \[Unreleased\]' CHANGELOG.md | grep -qx '## \[97.1.2\] - 2097-05-04' || fail "$(head CHANGELOG.md)"
  expect_exit 1 "$TALUS_SOURCE/tools/release.sh" 97.1.2
  expect_words "CHANGELOG.md has a release 97.1.2 already"
  expect_exit 1 "$TALUS_SOURCE/tools/release.sh" 3.0.0
  expect_words "3.0.0 comes before 97.1.2"
}

# From the day on which CMakeLists.txt has its lines, every source has.
test_every_source_says_its_licence() {
  cd "$TALUS_SOURCE"
  git rev-parse --is-inside-work-tree >/dev/null 2>&1 || skip "this is no checkout, which knows what is a source"
  grep -q 'SPDX-License-Identifier' CMakeLists.txt || skip "the sources have no licence lines yet"
  expect_exit 0 /usr/bin/python3 tools/add-licence-lines.py --check
}

test_licence_lines_are_added_once_and_behind_the_shebang() {
  git init -q . 2>/dev/null
  printf '#!/usr/bin/env bash\necho\n' >run
  printf '#pragma once\n' >a.hpp
  printf 'words\n' >notes.md
  git add -A
  expect_exit 1 /usr/bin/python3 "$TALUS_SOURCE/tools/add-licence-lines.py" --check
  [[ $(<stdout) == $'a.hpp\nrun' ]] || fail "it names: $(<stdout)"
  expect_exit 0 /usr/bin/python3 "$TALUS_SOURCE/tools/add-licence-lines.py"
  expect_exit 0 /usr/bin/python3 "$TALUS_SOURCE/tools/add-licence-lines.py"
  [[ $(<stdout) == '2 sources, 0 of them changed' ]] || fail "$(<stdout)"
  [[ $(sed -n 3p run) == '# SPDX-License-Identifier: GPL-3.0-or-later' && $(sed -n 4p run) == echo ]] || fail "$(<run)"
  [[ $(<a.hpp) == *$'GPL-3.0-or-later\n#pragma once' && $(<notes.md) == words ]] || fail "$(<a.hpp)"
}

test_repository_says_where_to_report_and_how_to_behave() {
  cd "$TALUS_SOURCE"
  local file
  for file in CODE_OF_CONDUCT.md .github/ISSUE_TEMPLATE/bug.md .github/ISSUE_TEMPLATE/question.md; do
    [[ -s $file ]] || fail "$file is missing"
  done
  grep -q '^## Reporting a bug' CONTRIBUTING.md || fail "CONTRIBUTING.md does not say how to report a bug"
  grep -q 'run: .*\.ci/run' .github/workflows/check.yml || fail "the workflow does not run .ci/run"
}

run_test "$@"
