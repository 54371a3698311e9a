#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Packs the Python package with its module and libtalus into a wheel. It needs the libraries of this distribution that
# Talus needs (GDAL, HDF5, OpenVDB, ...), nothing from the network, and is for the Python that it was built with.
# usage: tools/make-wheel.sh BUILD [FOLDER]      FOLDER: of the wheel; default BUILD/wheels
set -euo pipefail
source=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$(realpath -- "${1:?usage: tools/make-wheel.sh BUILD [FOLDER]}")
folder=$(realpath -m -- "${2:-$build/wheels}")
fail() { echo "tools/make-wheel.sh: $*" >&2; exit 1; }

module=$(compgen -G "$build/python/_core*.so") ||
  fail "$build holds no Python module. Install pybind11-dev and python3-dev, then: make build"
/usr/bin/python3 -c 'import setuptools, wheel, pip' 2>/dev/null ||
  fail "setuptools, wheel or pip is missing (apt-get install python3-setuptools python3-wheel python3-pip)"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp "$source/python/setup.py" "$work"
cp -r "$source/python/talus" "$work"
cp "$module" "$work/talus"
library=$build/lib/libtalus.so
cp "$(realpath "$library")" "$work/talus/$(objdump -p "$library" | awk '/SONAME/ { print $2 }')"
cp "$build/lib/libtalus-openturns.so" "$work/talus"
strip --strip-unneeded "$work"/talus/*.so*
TALUS_VERSION=$(sed -nE 's/^project\(talus VERSION ([0-9.]+).*/\1/p' "$source/CMakeLists.txt")
export TALUS_VERSION
mkdir -p "$folder"
rm -f "$folder"/talus-*.whl
/usr/bin/python3 -m pip wheel --quiet --no-index --no-deps --no-build-isolation --wheel-dir "$folder" "$work"
ls "$folder"/talus-*.whl
