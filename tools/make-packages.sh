#!/usr/bin/env bash
# Debian packages of a build (talus or talus-gpu, and talus-doc), in BUILD/packages. Nothing is compiled: what `make
# build` has made is installed into them by the rules of cmake/install.cmake.
# usage: tools/make-packages.sh BUILD
set -euo pipefail
build=${1:?usage: tools/make-packages.sh BUILD}

fail() { echo "tools/make-packages.sh: $*" >&2; exit 1; }
for tool in cpack dpkg-deb dpkg-shlibdeps; do
  command -v $tool >/dev/null || fail "$tool was not found. Install it: apt-get install cmake dpkg-dev"
done
[[ -f $build/CPackConfig.cmake ]] || fail "$build holds no configured build. Make it: make build"

rm -rf "$build/packages"
mkdir -p "$build/packages"
cpack --config "$build/CPackConfig.cmake" -G DEB >"$build/packages.log" 2>&1 || {
  tail -n 20 "$build/packages.log" >&2
  fail "cpack failed; all that it said is in $build/packages.log"
}
rm -rf "$build/packages/_CPack_Packages"
for package in "$build"/packages/*.deb; do
  printf '%s: %s, %s MB installed\n' "$package" "$(du -h "$package" | cut -f 1)" \
    "$(dpkg-deb -f "$package" Installed-Size | awk '{ printf "%.0f", $1 / 1024 }')"
done
