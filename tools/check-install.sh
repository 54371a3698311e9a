#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs the packages in a fresh root of the distribution on which they were made (by mmdebstrap), runs the shipped
# example to its report, removes them, and looks for what was left. Nothing stays on this machine.
# usage: tools/check-install.sh PACKAGES [SUITE [MIRROR]]   (PACKAGES: a folder with *.deb; SUITE: this machine's)
set -euo pipefail
usage='usage: tools/check-install.sh PACKAGES [SUITE [MIRROR]]'
packages=${1:?$usage}
suite=${2:-$(. /etc/os-release && echo "$VERSION_CODENAME")}
mirror=(${3:+"$3"})
cd "$(dirname "${BASH_SOURCE[0]}")/.."

fail() { echo "tools/check-install.sh: $*" >&2; exit 1; }
command -v mmdebstrap >/dev/null || fail "mmdebstrap was not found. Install it: make check-install"
compgen -G "$packages/*.deb" >/dev/null || fail "$packages holds no packages. Make them: make package"

began=$SECONDS
uploads=()
for package in "$packages"/*.deb; do
  uploads+=("--customize-hook=upload '$(realpath "$package")' '/tmp/$(basename "$package")'")
done
# Ubuntu's smallest system has no apt, and libraries of Talus come from its universe.
of_distribution=()
if [[ $(. /etc/os-release && echo "$ID") == ubuntu ]]; then
  of_distribution=(--include=apt)
  archive=${3:-http://archive.ubuntu.com/ubuntu}
  mirror=("deb $archive $suite main universe" "deb $archive $suite-updates main universe")
fi
mmdebstrap --variant=minbase "${of_distribution[@]}" --format=null --quiet --logfile="$packages/../check-install.log" \
  "${uploads[@]}" \
  --customize-hook="upload 'packaging/check-install-inside.sh' /tmp/check.sh" \
  --customize-hook='chroot "$1" bash /tmp/check.sh >&3' \
  "$suite" /dev/null "${mirror[@]}" 3>&1 || {
    tail -n 20 "$packages/../check-install.log" >&2
    fail "the packages do not pass in a fresh $suite (all of it: $packages/../check-install.log)"
  }
echo "all of it, the fresh root included: $((SECONDS - began)) s"
