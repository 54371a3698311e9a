#!/usr/bin/env bash
# Installs what is missing to build, run and test Talus on Debian 12 or Ubuntu 24.04. Quick when nothing is missing.
# usage: tools/install-dependencies.sh [lint|docs|fuzz] [--list]     (what `make lint`, docs or fuzz needs)
set -euo pipefail

packages=(
  # compiler and tools
  g++ make cmake ninja-build pkg-config git ca-certificates xz-utils patchelf
  # libraries, as cmake/dependencies.cmake looks for them
  libeigen3-dev libsuitesparse-dev libopenblas0-serial libtbb-dev libfmt-dev libspdlog-dev libcli11-dev
  nlohmann-json3-dev libtomlplusplus-dev
  libgdal-dev libhdf5-dev libnetcdf-dev libcgal-dev
  libopenvdb-dev libboost-iostreams-dev libblosc-dev
  libcairo2-dev fonts-dejavu-core zlib1g-dev
  # what report.html is made of, and what bundles its scripts; ffmpeg makes animations where they are asked for
  libjs-leaflet libjs-chart.js esbuild ffmpeg
  # tests, and the readers that are not ours: gdalinfo, the COG validator, ncdump, cdo, what the CF checker takes,
  # vdb_print, h5dump, pdfinfo
  libgtest-dev gdal-bin python3-gdal netcdf-bin cdo python3-netcdf4 udunits-bin libopenvdb-tools hdf5-tools
  python3-selenium poppler-utils
)

# The report is opened in a browser by its test: Debian's. Ubuntu's packages of these names only lead to the snap store,
# whose browser cannot be driven; the test says so there and is skipped.
if grep -qx 'ID=debian' /etc/os-release; then packages+=(chromium chromium-driver); fi

fail() { echo "tools/install-dependencies.sh: $*" >&2; exit 1; }

case ${1:-} in
  lint) packages+=(clang-format clang-tidy) && shift ;;
  docs) packages=(doxygen) && shift ;;
  fuzz) packages+=(clang) && shift ;;   # libFuzzer comes with its run-time library
esac

if [[ ${1:-} == --list ]]; then
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

echo "Installing ${#missing[@]} packages through apt: ${missing[*]}" >&2
apt_get() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300 -qq "$@" </dev/null >&2 ||
    fail "'apt-get $1' failed (its message is above). Mend that, then run the same make command again."
}
apt_get update
apt_get install --yes --no-install-recommends "${missing[@]}"
