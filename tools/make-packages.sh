#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Debian packages of a build (talus or talus-gpu, and talus-doc), in BUILD/packages or DIR. Nothing is compiled: what
# `make build` has made is installed into them by the rules of cmake/install.cmake.
# usage: tools/make-packages.sh BUILD [DIR [OPTION...]]     OPTION: of cpack, besides
set -euo pipefail
build=${1:?usage: tools/make-packages.sh BUILD [DIR [OPTION...]]}
folder=${2:-$build/packages}

fail() { echo "tools/make-packages.sh: $*" >&2; exit 1; }
for tool in cpack dpkg-deb dpkg-shlibdeps; do
  command -v $tool >/dev/null || fail "$tool was not found. Install it: apt-get install cmake dpkg-dev"
done
[[ -f $build/CPackConfig.cmake ]] || fail "$build holds no configured build. Make it: make build"

rm -rf "$folder"
mkdir -p "$folder"
cpack --config "$build/CPackConfig.cmake" -G DEB -B "$(realpath "$folder")" "${@:3}" >"$folder/cpack.log" 2>&1 || {
  tail -n 20 "$folder/cpack.log" >&2
  fail "cpack failed; all that it said is in $folder/cpack.log"
}
rm -rf "$folder/_CPack_Packages"
compgen -G "$folder/*.deb" >/dev/null || fail "cpack made no package; all that it said is in $folder/cpack.log"
for package in "$folder"/*.deb; do
  printf '%s: %s, %s MB installed\n' "$package" "$(du -h "$package" | cut -f 1)" \
    "$(dpkg-deb -f "$package" Installed-Size | awk '{ printf "%.0f", $1 / 1024 }')"
done
