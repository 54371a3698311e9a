#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Makes a release of what is here: the version in CMakeLists.txt (all else reads it there), version and date in
# CITATION.cff, and the heading of CHANGELOG.md under which the unreleased changes come. It commits nothing.
# The table of all rows of the validation is a file of the release.
# usage: tools/release.sh VERSION [DATE]     (2.0.1; the date of today, as 2026-12-31)
set -euo pipefail
usage='usage: tools/release.sh VERSION [DATE]'
version=${1:?$usage}
date=${2:-$(date +%F)}
cd "${TALUS_RELEASE_OF:-$(dirname "${BASH_SOURCE[0]}")/..}"

fail() { echo "tools/release.sh: $*" >&2; exit 1; }
[[ $version =~ ^[0-9]+\.[0-9]+\.[0-9]+$ ]] || fail "$version is no version (three numbers with dots between)"
[[ $date =~ ^[0-9]{4}-[0-9]{2}-[0-9]{2}$ ]] || fail "$date is no date (2026-12-31)"
present=$(sed -nE 's/^project\(talus VERSION ([0-9.]+).*/\1/p' CMakeLists.txt)
if grep -qF "## [$version]" CHANGELOG.md; then fail "CHANGELOG.md has a release $version already"; fi
[[ $(printf '%s\n' "$present" "$version" | sort -V | tail -n 1) == "$version" ]] ||
  fail "$version comes before $present, which CMakeLists.txt has"
grep -qx '## \[Unreleased\]' CHANGELOG.md || fail "CHANGELOG.md has no heading ## [Unreleased]"

sed -i -E "s/^(project\(talus VERSION )[0-9.]+/\1$version/" CMakeLists.txt
sed -i -E "/^date-released: /d; s/^version: .*/version: $version\ndate-released: $date/" CITATION.cff
sed -i "s/^## \[Unreleased\]$/&\n\n## [$version] - $date/" CHANGELOG.md
echo "$present -> $version, $date. Look at the change, then: git commit -am 'Version $version' &&" \
  "git tag -a v$version -m 'Talus $version'. docs/benchmarks/validation.csv is of commit" \
  "$(sed -n '2s/.*,\([0-9a-f]*\),[0-9-]*$/\1/p' docs/benchmarks/validation.csv)."
