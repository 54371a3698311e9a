#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# An image of the packages of a build, by whichever of buildah, podman and docker is here.
# usage: tools/make-image.sh BUILD [NAME [BASE]]     (NAME: talus; BASE: this machine's distribution, as debian:12)
set -euo pipefail
build=${1:?usage: tools/make-image.sh BUILD [NAME [BASE]]}
name=${2:-talus}
system=$(. /etc/os-release && echo "$ID:$VERSION_ID")
base=${3:-$system}
file=$(dirname "${BASH_SOURCE[0]}")/../packaging/Dockerfile

fail() { echo "tools/make-image.sh: $*" >&2; exit 1; }
compgen -G "$build/packages/*.deb" >/dev/null || fail "$build/packages holds no packages. Make them: make package"
for tool in buildah podman docker; do
  if command -v $tool >/dev/null; then break; fi
  tool=
done
[[ -n $tool ]] || fail "none of buildah, podman and docker was found. Install one: apt-get install buildah"

# The context is the packages alone, without documents: an image has no readers.
context=$(mktemp -d)
trap 'rm -rf "$context"' EXIT
for package in "$build"/packages/*.deb; do
  if [[ $(dpkg-deb -f "$package" Package) != talus-doc ]]; then cp "$package" "$context/"; fi
done
options=(--build-arg "BASE=$base" -t "$name" -f "$file")
# Words before and after `build` for machines that need some: inside a container --storage-driver vfs, and
# --isolation chroot.
read -ra before <<<"${IMAGE_TOOL_OPTIONS:-}"
read -ra after <<<"${IMAGE_BUILD_OPTIONS:-}"
"$tool" "${before[@]}" build "${after[@]}" "${options[@]}" "$context"
echo "image $name, by $tool, on $base. Try it: podman run --rm -v \"\$PWD:/data\" $name talus-solve --version"
