#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Puts the programs of a build, with recipes, styles, manuals and the shared libraries they need, into one relocatable
# folder, packs it, and checks that it stands alone. What every Linux machine with GCC's run-time has (glibc, libstdc++,
# libgcc_s) and NVIDIA's driver stay outside. With tests, those of the build and what times and validates go along.
# usage: tools/make-bundle.sh BUILD [--solver] [--with-tests] [--to DIR] [--no-archive]
set -euo pipefail

usage='usage: tools/make-bundle.sh BUILD [--solver] [--with-tests] [--to DIR] [--no-archive]'
build=${1:?$usage}
shift
name=bundle
folder=$build
archived=yes
with_tests=no
while [[ $# -gt 0 ]]; do
  case $1 in
    --solver) name='bundle-solver' ;;
    --with-tests) with_tests=yes ;;
    --to)
      folder=${2:?$usage}
      shift
      ;;
    --no-archive) archived=no ;;
    *)
      echo "$usage" >&2
      exit 2
      ;;
  esac
  shift
done
bundle=$folder/$name
archive=$folder/talus-$name.tar.xz
tests=()
if [[ $with_tests == yes && $name == bundle ]]; then
  tests=("$build"/bin/{talus-validate,talus-bench} "$build"/bin/talus-tests-*)
elif [[ $with_tests == yes ]]; then
  tests=("$build"/bin/talus-tests-solver*)
fi

fail() { echo "tools/make-bundle.sh: $*" >&2; exit 1; }
for tool in patchelf ldd xz; do
  command -v $tool >/dev/null || fail "$tool was not found. Install it: make setup"
done

# Libraries the target machine has by itself.
outside='^(ld-linux|linux-vdso|libc\.|libm\.|libmvec\.|libdl\.|libpthread\.|librt\.|libresolv\.|libutil\.|libanl\.'
outside+='|libstdc\+\+\.|libgcc_s\.|libcuda\.|libnvidia-)'

rm -rf "$bundle" "$archive"
mkdir -p "$bundle"/{bin,lib}
bundle=$(realpath "$bundle")
if [[ $name == bundle ]]; then
  cmake --install "$build" --prefix "$bundle" --component runtime >/dev/null ||
    fail "'cmake --install $build' failed. Build what it installs: make build"
  mv "$bundle"/lib/talus/* "$bundle/lib/"   # what programs load themselves lies among the libraries
  rmdir "$bundle/lib/talus"
else
  [[ -x $build/bin/talus-solve ]] || fail "$build/bin/talus-solve is missing. Build it: make build"
  cp "$build/bin/talus-solve" "$bundle/bin/"
fi
mapfile -t programs < <(cd "$bundle/bin" && for file in *; do
  if head -c 4 "$file" | grep -q ELF; then echo "$file"; fi   # a script needs no libraries
done)
for test in "${tests[@]}"; do
  if [[ -x $test ]]; then
    cp "$test" "$bundle/bin/"
    programs+=("$(basename "$test")")
  fi
done
(cd "$bundle/bin" && strip --strip-debug "${programs[@]}")
for program in "${programs[@]/#/$bundle/bin/}"; do
  # Only the bundle; DT_RPATH rather than RUNPATH, because it holds for the libraries' own dependencies too.
  patchelf --force-rpath --set-rpath '$ORIGIN/../lib' "$program"
done

# The closure is that of the built files, which know the way to every library on this machine.
built=$(printf "$build/bin/%s\n" "${programs[@]}")
mapfile -t modules < <(compgen -G "$bundle/lib/libtalus-*.so")
for module in "${modules[@]}"; do built+=$'\n'$build/lib/$(basename "$module"); done
needed=$(xargs ldd <<<"$built")
unresolved=$(grep 'not found' <<<"$needed" || true)
[[ -z $unresolved ]] || fail "libraries not found on this machine: $unresolved"
# What of others is in the bundle, by its place on this machine.
mapfile -t carried < <(awk '$2 == "=>" && $3 ~ /^\// { print $1, $3 }' <<<"$needed" | sort -u | grep -vE "$outside" |
  cut -d ' ' -f 2)
cp -L "${carried[@]}" "$bundle/lib/"

# A library with a search path of its own would look there instead of in the bundle.
chmod u+w "$bundle"/lib/*
mapfile -t searching < <(readelf -d "$bundle"/lib/* | awk '/^File: / { file = $2 } /R(UN)?PATH/ { print file }')
searching+=("${modules[@]}")
[[ ${#searching[@]} -eq 0 ]] || patchelf --force-rpath --set-rpath '$ORIGIN' "${searching[@]}"

if compgen -G "$bundle/lib/libproj.*" >/dev/null; then
  mkdir -p "$bundle/share/proj"
  cp /usr/share/proj/proj.db "$bundle/share/proj/"
  carried+=(/usr/share/proj/proj.db)
fi
if compgen -G "$bundle/lib/libgdal.*" >/dev/null; then
  cp -r "$(gdal-config --datadir)" "$bundle/share/gdal"
  carried+=("$(gdal-config --datadir)/gdalvrt.xsd")
fi
if compgen -G "$bundle/lib/libfontconfig.*" >/dev/null; then
  mkdir -p "$bundle"/share/{fonts,fontconfig}
  cp /usr/share/fonts/truetype/dejavu/DejaVuSans{,-Bold}.ttf "$bundle/share/fonts/"
  carried+=(/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf)
  cat >"$bundle/share/fontconfig/fonts.conf" <<XML
<?xml version="1.0"?>
<!DOCTYPE fontconfig SYSTEM "fonts.dtd">
<fontconfig><dir prefix="relative">../fonts</dir><cachedir prefix="xdg">fontconfig</cachedir></fontconfig>
XML
fi
source=$(dirname "${BASH_SOURCE[0]}")/..
cp "$source/LICENSE" "$bundle/"
if [[ $name == bundle ]]; then cp "$source/packaging/bundle-readme.md" "$bundle/README.md"; fi
rm -rf "$bundle"/share/doc/*/notices   # those of what is compiled in: they are among all that is carried
"$source/tools/collect-notices.sh" "$bundle/share/doc/notices" "${carried[@]}"

# The check: with an empty environment, every library must come from the bundle or be one of those outside.
# strangers: of lines "NAME PATH" those that are neither.
strangers() {
  local name path
  while read -r name path; do
    [[ $path == "$bundle"/* || $name =~ $outside ]] || echo "$name from $path"
  done
}
for program in "${programs[@]/#/$bundle/bin/}" "${modules[@]}"; do
  taken=$(env -i ldd "$program" | awk '$2 == "=>" { print $1, $3 }' | strangers)
  [[ -z $taken ]] || fail "the bundle does not stand alone: $(basename "$program") takes $taken"
done
for program in "${programs[@]}"; do
  env -i "$bundle/bin/$program" --help >/dev/null || fail "$program --help failed inside the bundle"
  loaded=$(env -i LD_DEBUG=libs "$bundle/bin/$program" --help 2>&1 >/dev/null |
    sed -n 's#.*calling init: \(\(.*/\)*\(.*\)\)#\3 \1#p' | sort -u | strangers)
  [[ -z $loaded ]] || fail "$program loads $loaded at run time"
done

count() { find "$1" -type f | wc -l; }
size="$bundle: $(du -sh "$bundle" | cut -f1)"
size+=", $(count "$bundle/bin") programs, $(count "$bundle/lib") libraries"
if [[ $archived == yes ]]; then   # last: it is there only if the check has passed
  XZ_OPT=-T0 tar -C "$folder" -cJf "$archive" "$name"
  size+="; $archive: $(du -h "$archive" | cut -f1)"
fi
echo "$size"
