#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
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

test_how_much_comes_is_said_before_it_is_fetched() {
  tools id='echo 0' dpkg-query="$all_but_gdal" apt-get="case \"\$*\" in
    --assume-no*) echo '0 upgraded, 77 newly installed, 0 to remove and 0 not upgraded.'
      echo 'Need to get 61.2 MB of archives.'
      echo 'After this operation, 250 MB of additional disk space will be used.' ;;
    *' install '*) echo FETCHED >&2 ;; esac"
  expect_exit 0 install
  local said='Installing through apt: 77 packages, 61.2 MB to fetch, 250 MB on disk (libgdal-dev and what they need)'
  expect_error "$said"
  [[ $(grep -n FETCHED stderr | cut -d : -f 1) -gt $(grep -nF "$said" stderr | cut -d : -f 1) ]] || fail "said too late"
}

test_groups_bring_what_they_are_for() {
  expect_exit 0 "$script" --list
  cp stdout build
  expect_exit 0 "$script" tests --list
  [[ $(comm -23 <(sort build) <(sort stdout)) == '' ]] || fail "the tests' group lacks what building needs"
  grep -qx libgtest-dev stdout || fail "tests come without GoogleTest"
  if grep -qx libgtest-dev build; then fail "building brings GoogleTest"; fi
  expect_exit 1 "$script" toys
  expect_words "no such group: toys"
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
