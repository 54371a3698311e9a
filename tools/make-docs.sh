#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# The programmers' reference by Doxygen: every header. A warning of Doxygen is an error. tools/make-site.py takes the
# pages into the site.
# usage: tools/make-docs.sh DIR
set -euo pipefail
folder=${1:?usage: tools/make-docs.sh DIR}
cd "$(dirname "${BASH_SOURCE[0]}")/.."
command -v doxygen >/dev/null || {
  echo "tools/make-docs.sh: doxygen was not found (it makes the pages of the headers). Install it: make docs" >&2
  exit 1
}
mkdir -p "$folder"
version=$(sed -nE 's/^project\(talus VERSION ([0-9.]+).*/\1/p' CMakeLists.txt)
settings() {
  cat docs/Doxyfile
  printf '%s\n' "OUTPUT_DIRECTORY = $folder" "PROJECT_NUMBER = $version"
}
settings | doxygen - 2>"$folder/warnings.txt" >/dev/null || true
if [[ -s $folder/warnings.txt ]]; then
  cat "$folder/warnings.txt" >&2
  echo "tools/make-docs.sh: Doxygen has $(grep -c 'warning:' "$folder/warnings.txt") warnings" >&2
  exit 1
fi
echo "$folder/html/index.html"
