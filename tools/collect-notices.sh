#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Copies the licences of what Talus carries: of the libraries that are compiled in (headers, scripts of the report), and
# of the packages that own the files named. Each comes from the copyright file of its package (Debian, Ubuntu).
# usage: tools/collect-notices.sh DIR [FILE...]     writes DIR/PACKAGE.txt and DIR/README.md, the list
set -euo pipefail
folder=${1:?usage: tools/collect-notices.sh DIR [FILE...]}
shift

fail() { echo "tools/collect-notices.sh: $*" >&2; exit 1; }
rm -rf "$folder"
mkdir -p "$folder"

# Headers and scripts that become part of the programs; one that this machine lacks was not compiled in.
compiled_in=(libeigen3-dev libcgal-dev libcli11-dev nlohmann-json3-dev libtomlplusplus-dev libspdlog-dev libfmt-dev
  libtbb-dev libopenvdb-dev libimath-dev libopenturns-dev libjs-leaflet libjs-chart.js libjs-three)

if ! command -v dpkg-query >/dev/null; then
  [[ $# -eq 0 ]] || fail "dpkg was not found, which knows whose files these are. Bundles are made on Debian or Ubuntu"
  echo "The libraries came from no packages of Debian or Ubuntu: their licences are where they were installed." \
    >"$folder/README.md"
  exit 0
fi

# Whose the files are. Files of a merged /usr are known under either name, and links under their own or their target's.
declare -A owner=()
if [[ $# -gt 0 ]]; then
  candidates=()
  for file in "$@"; do
    real=$(realpath "$file")
    candidates+=("$file" "$real" "${file#/usr}" "${real#/usr}")
  done
  while IFS= read -r line; do owner[${line##*: }]=${line%%[:,]*}; done \
    < <(dpkg-query -S "${candidates[@]}" 2>/dev/null | grep -v '^diversion')
fi

declare -A carries=()
add() { carries[$1]+="${carries[$1]:+, }$2"; }
for package in "${compiled_in[@]}"; do
  state=$(dpkg-query -W -f '${db:Status-Abbrev}' "$package" 2>/dev/null || true)
  if [[ $state == ?i* ]]; then add "$package" 'compiled in'; fi
done
for file in "$@"; do
  package=
  for name in "$file" "$(realpath "$file")"; do
    package=${package:-${owner[$name]:-${owner[${name#/usr}]:-}}}
  done
  [[ -n $package ]] || fail "$file belongs to no package, so its licence is not known"
  add "$package" "$(basename "$file")"
done

{
  printf '%s\n' '# Notices' '' 'What Talus carries of others, by the package it was taken from.' \
    'The licence of each is in the file of its name.' '' '| package | version | what |' '| --- | --- | --- |'
  for package in "${!carries[@]}"; do
    notice=/usr/share/doc/$package/copyright
    [[ -s $notice ]] || fail "$package has no $notice (images that leave documents out cannot make bundles)"
    cp -L "$notice" "$folder/$package.txt"
    printf '| [%s](%s.txt) | %s | %s |\n' "$package" "$package" \
      "$(dpkg-query -W -f '${Version}\n' "$package" | sed q)" "${carries[$package]}"
  done | sort
} >"$folder/README.md"

# Copyright files name the long licences by their place on a Debian system.
mkdir "$folder/common-licenses"
grep -ohE '/usr/share/common-licenses/[A-Za-z]+(-[0-9]+(\.[0-9]+)?)?' "$folder"/*.txt | sort -u |
  while IFS= read -r licence; do
    if [[ -f $licence ]]; then cp -L "$licence" "$folder/common-licenses/"; fi
  done
