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
mapfile -t reals < <(if [[ $# -gt 0 ]]; then realpath "$@"; fi)
if [[ $# -gt 0 ]]; then
  while IFS= read -r line; do owner[${line##*: }]=${line%%[:,]*}; done \
    < <(dpkg-query -S "$@" "${reals[@]}" "${@#/usr}" "${reals[@]#/usr}" 2>/dev/null | grep -v '^diversion')
fi

declare -A carries=()
add() { carries[$1]+="${carries[$1]:+, }$2"; }
while IFS= read -r package; do add "$package" 'compiled in'; done < <(
  dpkg-query -W -f '${db:Status-Abbrev} ${Package}\n' "${compiled_in[@]}" 2>/dev/null | sed -n 's/^.i. *//p' | sort -u)
number=0
for file in "$@"; do
  package=
  for name in "$file" "${reals[number++]}"; do
    package=${package:-${owner[$name]:-${owner[${name#/usr}]:-}}}
  done
  [[ -n $package ]] || fail "$file belongs to no package, so its licence is not known"
  add "$package" "${file##*/}"
done

{
  printf '%s\n' '# Notices' '' 'What Talus carries of others, by the package it was taken from.' \
    'The licence of each is in the file of its name.' '' '| package | version | what |' '| --- | --- | --- |'
  dpkg-query -W -f '${Package} ${Version}\n' "${!carries[@]}" | sort -u | while read -r package version; do
    notice=/usr/share/doc/$package/copyright
    [[ -s $notice ]] || fail "$package has no $notice (images that leave documents out cannot make bundles)"
    cp -L "$notice" "$folder/$package.txt"
    printf '| [%s](%s.txt) | %s | %s |\n' "$package" "$package" "$version" "${carries[$package]}"
  done
} >"$folder/README.md"

# Copyright files name the long licences by their place on a Debian system.
mkdir "$folder/common-licenses"
grep -ohE '/usr/share/common-licenses/[A-Za-z]+(-[0-9]+(\.[0-9]+)?)?' "$folder"/*.txt | sort -u |
  while IFS= read -r licence; do
    if [[ -f $licence ]]; then cp -L "$licence" "$folder/common-licenses/"; fi
  done
