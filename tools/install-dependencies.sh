#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs what is missing on Debian 12 or Ubuntu 24.04, and says before how much that is. Quick when nothing is
# missing.
# usage: tools/install-dependencies.sh [GROUP...] [--list]
#   build     what building and running Talus needs; always among them
#   tests     what `make test` needs besides: GoogleTest, a browser, readers that are not ours, ffmpeg for animations
#   python    what the Python module and `make wheel` need; among those of tests
#   qgis      what `make check-qgis` needs: QGIS itself, about 1 GB
#   lint, docs, fuzz, package     what `make lint`, `make docs`, `make fuzz` and `make check-install` need
#   three-d   ParaView, for `make check-three-d`
set -euo pipefail

build=(
  # compiler and tools; python3 makes man pages and completions, patchelf and xz bundles
  g++ make cmake ninja-build pkg-config git ca-certificates xz-utils patchelf python3
  # libraries, as cmake/dependencies.cmake looks for them
  libeigen3-dev libsuitesparse-dev libopenblas0-serial libtbb-dev libfmt-dev libspdlog-dev libcli11-dev
  nlohmann-json3-dev libtomlplusplus-dev
  libgdal-dev libhdf5-dev libnetcdf-dev libcgal-dev libssl-dev
  libopenvdb-dev libboost-iostreams-dev libblosc-dev
  libopenturns-dev
  libcairo2-dev fonts-dejavu-core libdeflate-dev
  # what report.html is made of, and what bundles its scripts
  libjs-leaflet libjs-chart.js libjs-three esbuild
)
docs=(doxygen python3-sphinx python3-myst-parser furo)
python=(pybind11-dev python3-dev python3-numpy python3-pip python3-setuptools python3-venv python3-wheel)
tests=(
  libgtest-dev "${python[@]}"
  # the readers that are not ours: gdalinfo, the COG validator, ncdump, cdo, what the CF checker takes, vdb_print,
  # h5dump, pdfinfo; ffmpeg makes animations where they are asked for
  gdal-bin python3-gdal netcdf-bin cdo python3-netcdf4 udunits-bin libopenvdb-tools hdf5-tools
  python3-selenium poppler-utils ffmpeg dpkg-dev file
  # what the Python package is made of (docs/how-to/python.md)
  python3-h5py python3-numpy python3-xarray python3-rasterio
  # what the site of documents is made of
  python3-sphinx python3-myst-parser furo
  # what tutorials draw with
  python3-matplotlib python3-pil
)
qgis=(qgis python3-qgis qgis-providers gdal-bin)
lint=(clang-format clang-tidy)
fuzz=(clang)   # libFuzzer comes with its run-time library
package=(dpkg-dev file mmdebstrap)   # CPack asks file which programs there are
# ParaView, a display for it, readers of run.h5 and of pictures
three_d=(paraview python3-paraview python3-h5py python3-numpy python3-gdal xvfb xauth)

# The report is opened in a browser by its test: Debian's. Ubuntu's packages of these names only lead to the snap store,
# whose browser cannot be driven; the test says so there and is skipped. Dask, for ensembles over several machines, was
# tried on Debian alone.
if grep -qx 'ID=debian' /etc/os-release; then tests+=(chromium chromium-driver python3-distributed); fi

fail() { echo "tools/install-dependencies.sh: $*" >&2; exit 1; }

packages=("${build[@]}")
list=no
for group in "$@"; do
  case $group in
    build) ;;
    tests) packages+=("${tests[@]}") ;;
    lint) packages+=("${tests[@]}" "${lint[@]}") ;;   # it reads the tests as well
    docs) packages=("${docs[@]}") ;;
    python) packages+=("${python[@]}") ;;
    qgis) packages+=("${qgis[@]}") ;;
    fuzz) packages+=("${tests[@]}" "${fuzz[@]}") ;;
    package) packages+=("${package[@]}") ;;
    three-d) packages+=("${three_d[@]}") ;;
    --list) list=yes ;;
    *) fail "no such group: $group (build, tests, python, qgis, lint, docs, fuzz, package, three-d)" ;;
  esac
done
if [[ $list == yes ]]; then
  printf '%s\n' "${packages[@]}"
  exit 0
fi

missing_packages() {
  local installed
  installed=$(dpkg-query -W -f '${db:Status-Abbrev}|${Package}\n' "${packages[@]}" 2>/dev/null |
    sed -n 's/^[ih]i *|//p' || true)
  local package
  for package in "${packages[@]}"; do
    grep -qx "$package" <<<"$installed" || echo "$package"
  done
}

command -v apt-get >/dev/null && command -v dpkg-query >/dev/null ||
  fail "apt was not found (packages are installed on Debian 12 and Ubuntu 24.04 only)." \
    "Install the libraries that cmake/dependencies.cmake names, then build without this step: make SETUP=no build"

mapfile -t missing < <(missing_packages)
if [[ ${#missing[@]} -eq 0 ]]; then
  exit 0
fi

as_root=()
if [[ $(id -u) -ne 0 ]]; then
  command -v sudo >/dev/null ||
    fail "packages are missing and this is neither root nor a machine with sudo. Ask its administrator for:" \
      "apt-get install ${missing[*]}"
  as_root=(sudo)
fi

apt_get() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300 -qq "$@" </dev/null >&2 ||
    fail "'apt-get $1' failed (its message is above). Mend that, then run the same make command again."
}
apt_get update

# announce: how many packages come with the missing ones, and how much that is, as apt reckons it.
announce() {
  local plan count sizes
  plan=$(LC_ALL=C apt-get --assume-no --no-install-recommends install "${missing[@]}" 2>/dev/null </dev/null || true)
  count=$(sed -nE 's/.* ([0-9]+) newly installed.*/\1/p' <<<"$plan")
  sizes=$(sed -nE 's/^Need to get (.*) of archives\.$/\1 to fetch/p; s/^After this operation, (.*) of .*/\1 on disk/p' \
    <<<"$plan" | paste -sd, | sed 's/,/, /')
  echo "Installing through apt: ${count:-${#missing[@]}} packages${sizes:+, $sizes} (${missing[*]}" \
    "and what they need)" >&2
}
announce
began=$SECONDS
apt_get install --yes --no-install-recommends "${missing[@]}"
echo "Installed in $((SECONDS - began)) s" >&2
