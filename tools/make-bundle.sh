#!/usr/bin/env bash
# Copies the programs and tests of a build with the shared libraries they need into one relocatable folder, packs it, and
# checks that it stands alone. What every Linux machine with GCC's run-time has (glibc, libstdc++, libgcc_s) and NVIDIA's
# driver stay outside.
# usage: tools/make-bundle.sh BUILD [--solver]
set -euo pipefail

build=${1:?usage: tools/make-bundle.sh BUILD [--solver]}
name=bundle
programs=(talus-preprocess talus-solve talus-postprocess talus-make-terrain)
tests=("$build"/bin/talus-tests-*)
if [[ ${2:-} == --solver ]]; then
  name=bundle-solver
  programs=(talus-solve)
  tests=("$build"/bin/talus-tests-solver*)
fi
bundle=$build/$name
archive=$build/talus-$name.tar.xz

fail() { echo "tools/make-bundle.sh: $*" >&2; exit 1; }
for tool in patchelf ldd xz; do
  command -v $tool >/dev/null || fail "$tool was not found. Install it: make setup"
done

# Libraries the target machine has by itself.
outside='^(ld-linux|libc\.|libm\.|libmvec\.|libdl\.|libpthread\.|librt\.|libresolv\.|libutil\.|libanl\.|linux-vdso|libstdc\+\+\.|libgcc_s\.|libcuda\.|libnvidia-)'

rm -rf "$bundle" "$archive"
mkdir -p "$bundle"/{bin,lib}
for program in "${programs[@]}"; do
  [[ -x $build/bin/$program ]] || fail "$build/bin/$program is missing. Build it: make build"
  cp "$build/bin/$program" "$bundle/bin/"
done
for test in "${tests[@]}"; do
  if [[ -x $test ]]; then cp "$test" "$bundle/bin/"; fi
done
strip --strip-debug "$bundle"/bin/*

unresolved=$(ldd "$bundle"/bin/* | grep 'not found' || true)
[[ -z $unresolved ]] || fail "libraries not found on this machine: $unresolved"
ldd "$bundle"/bin/* | awk '$2 == "=>" && $3 ~ /^\// { print $1, $3 }' | sort -u |
  while read -r soname path; do
    if [[ ! $soname =~ $outside ]]; then cp -L "$path" "$bundle/lib/$soname"; fi
  done

# A library with a search path of its own would look there instead of in the bundle.
chmod u+w "$bundle"/lib/*
for library in "$bundle"/lib/*; do
  if [[ -n $(patchelf --print-rpath "$library") ]]; then
    patchelf --force-rpath --set-rpath '$ORIGIN' "$library"
  fi
done

if compgen -G "$bundle/lib/libproj.*" >/dev/null; then
  mkdir -p "$bundle/share/proj"
  cp /usr/share/proj/proj.db "$bundle/share/proj/"
fi
if compgen -G "$bundle/lib/libgdal.*" >/dev/null; then
  cp -r "$(gdal-config --datadir)" "$bundle/share/gdal"
fi
if [[ -f LICENSE ]]; then cp LICENSE "$bundle/"; fi

# The check: with an empty environment, every library must come from the bundle or be one of those outside.
strangers=0
for program in "$bundle"/bin/*; do
  while read -r soname path; do
    real=$(realpath "$path")
    if [[ $real != "$(realpath "$bundle")"/* && ! $soname =~ $outside ]]; then
      echo "$(basename "$program") takes $soname from $path, not from the bundle" >&2
      strangers=1
    fi
  done < <(env -i ldd "$program" | awk '$2 == "=>" { print $1, $3 }')
done
[[ $strangers -eq 0 ]] || fail "the bundle does not stand alone"
for program in "${programs[@]}"; do
  env -i "$bundle/bin/$program" --help >/dev/null || fail "$program --help failed inside the bundle"
  loaded=$(env -i LD_DEBUG=libs "$bundle/bin/$program" --help 2>&1 >/dev/null | sed -n 's/.*calling init: //p' | sort -u)
  while read -r path; do
    if [[ $(realpath "$path") != "$(realpath "$bundle")"/* && ! $(basename "$path") =~ $outside ]]; then
      fail "$program loads $path at run time"
    fi
  done <<<"$loaded"
done

XZ_OPT=-T0 tar -C "$build" -cJf "$archive" "$name"
echo "$bundle: $(du -sh "$bundle" | cut -f1) ($(find "$bundle/bin" -type f | wc -l) programs and tests," \
  "$(find "$bundle/lib" -type f | wc -l) libraries); $archive: $(du -h "$archive" | cut -f1)"
