#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# tools/make-image.sh up to the program that makes the image, which is none of Talus: a stand-in writes down what it is
# asked for. An image itself takes packages, the network and a machine that may make containers.
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

image=$TALUS_SOURCE/tools/make-image.sh

# package NAME: a Debian package with a file of its name, in build/packages.
package() {
  mkdir -p "root-$1/DEBIAN" "root-$1/usr/share" build/packages
  echo "$1" >"root-$1/usr/share/$1"
  printf 'Package: %s\nVersion: 1\nArchitecture: all\nMaintainer: none <none@example.org>\nDescription: none\n' "$1" \
    >"root-$1/DEBIAN/control"
  dpkg-deb --root-owner-group --build "root-$1" "build/packages/$1_1_all.deb" >/dev/null
}

# stand_in NAME: a program of that name, before all others, which writes down its words and the files it is given.
stand_in() {
  mkdir -p tools
  cat >"tools/$1" <<SCRIPT
#!/bin/sh
printf '%s\n' "\$@" >words
for last; do :; done
ls "\$last" >context
for word; do case \$word in */Dockerfile) cp "\$word" file ;; esac; done
SCRIPT
  chmod +x "tools/$1"
}

test_image_is_made_of_the_packages_without_the_documents() {
  need_tool dpkg-deb
  package talus
  package talus-doc
  stand_in buildah
  PATH=$PWD/tools:$PATH IMAGE_TOOL_OPTIONS='--storage-driver vfs' IMAGE_BUILD_OPTIONS='--isolation chroot' \
    expect_exit 0 bash "$image" build my-talus debian:12
  local wanted='--storage-driver vfs build --isolation chroot --build-arg BASE=debian:12 -t my-talus -f '
  [[ $(paste -sd' ' words) == "$wanted"* ]] ||
    fail "buildah was asked for: $(paste -sd' ' words)"
  [[ $(<context) == talus_1_all.deb ]] || fail "the image would hold: $(paste -sd' ' context)"
  cmp file "$TALUS_SOURCE/packaging/Dockerfile" || fail "it is made by another file"
  grep -qF 'image my-talus, by buildah, on debian:12' stdout || fail "it does not say what was made"
}

test_image_is_of_the_distribution_that_made_the_packages() {
  need_tool dpkg-deb
  package talus
  stand_in buildah
  PATH=$PWD/tools:$PATH expect_exit 0 bash "$image" build
  grep -qxF "BASE=$(. /etc/os-release && echo "$ID:$VERSION_ID")" words || fail "another base: $(paste -sd' ' words)"
}

test_image_asks_for_packages_and_for_a_program_that_makes_it() {
  need_tool dpkg-deb
  expect_exit 1 bash "$image" build
  grep -qF 'build/packages holds no packages. Make them: make package' stderr || fail "no reason: $(<stderr)"
  package talus
  mkdir tools
  local tool
  for tool in bash dirname; do ln -s "$(command -v "$tool")" tools/; done
  PATH=$PWD/tools expect_exit 1 bash "$image" build
  grep -qF 'none of buildah, podman and docker was found. Install one: apt-get install buildah' stderr ||
    fail "no reason: $(<stderr)"
}

run_test "$@"
