#!/usr/bin/env bash
# tools/install-dependencies.sh where it cannot install: stand-ins take the place of the system's tools.
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"
script=$TALUS_SOURCE/tools/install-dependencies.sh

# tools NAME=BODY...: a folder that holds only these commands, and those the script itself is made of.
tools() {
  mkdir -p tools
  local tool
  for tool in bash env sed grep printf cat paste; do ln -s "$(command -v $tool)" "tools/$tool"; done
  for tool in "$@"; do
    printf '#!%s\n%s\n' "$(command -v bash)" "${tool#*=}" >"tools/${tool%%=*}"
    chmod +x "tools/${tool%%=*}"
  done
}
install() { env PATH="$TALUS_SCRATCH/tools" bash "$script"; }

all_but_gdal='for p in "${@:4}"; do [[ $p == libgdal-dev ]] || echo "ii |$p"; done'

test_without_apt_says_so() {
  tools
  expect_exit 1 install
  expect_words "apt was not found (packages are installed on Debian 12 and Ubuntu 24.04 only)."
  expect_words "make SETUP=no build"
}

test_neither_root_nor_sudo_says_what_is_missing() {
  tools id='echo 1000' apt-get='exit 9' dpkg-query="$all_but_gdal"
  expect_exit 1 install
  local mend="Ask its administrator for: apt-get install libgdal-dev"
  expect_words "packages are missing and this is neither root nor a machine with sudo. $mend"
}

test_nothing_missing_calls_nothing() {
  tools id='echo 0' apt-get='exit 9' dpkg-query='for p in "${@:4}"; do echo "ii |$p"; done'
  expect_exit 0 install
  [[ ! -s stderr ]] || fail "it talks although nothing is missing"
}

test_only_what_is_missing_is_installed() {
  tools id='echo 0' apt-get="echo \"\$@\" >>$TALUS_SCRATCH/calls" dpkg-query="$all_but_gdal"
  expect_exit 0 install
  grep -q ' update$' calls && grep -qE 'install --yes --no-install-recommends libgdal-dev$' calls ||
    fail "called: $(<calls)"
}

test_removed_but_configured_package_counts_as_missing() {
  tools id='echo 0' apt-get="echo \"\$@\" >>$TALUS_SCRATCH/calls" \
    dpkg-query='for p in "${@:4}"; do
      if [[ $p == ccache || $p == libcgal-dev ]]; then echo "rc |$p"; else echo "ii |$p"; fi
    done'
  expect_exit 0 install
  grep -qE 'recommends libcgal-dev$' calls || fail "called: $(<calls)"
}

test_failing_apt_is_an_error() {
  tools id='echo 0' apt-get='exit 100' dpkg-query="$all_but_gdal"
  expect_exit 1 install
  expect_words "'apt-get update' failed"
}

run_test "$@"
