#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Formatting of every source by clang-format 14 (Debian 12's), headers that build alone, and static analysis of every
# C++ source, kernels included, by clang-tidy 14 with the checks of .clang-tidy: all of them in batches of a folder (see
# cmake/batches.cmake), which reads the headers that they share once. What was clean is not looked at again until it, a
# header that it includes or .clang-tidy has changed.
# usage: tools/lint.sh [--format | --changed N] [FILE...]
#   --format: look at the formatting alone; --changed: analyse only the N units changed last; FILE: only these
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

fail() { echo "tools/lint.sh: $*" >&2; exit 1; }

changed=
format_only=no
if [[ ${1:-} == --format ]]; then
  format_only=yes
  shift
elif [[ ${1:-} == --changed ]]; then
  changed=${2:?tools/lint.sh --changed N}
  shift 2
fi
needed=(clang-format clang-tidy cmake ninja)
if [[ $format_only == yes ]]; then needed=(clang-format); fi
for tool in "${needed[@]}"; do
  command -v "$tool" >/dev/null || fail "$tool was not found. Install it: make lint"
done
clang-format --version | grep -q 'version 14\.' ||
  fail "clang-format is not version 14 ($(clang-format --version)); other versions format otherwise. Use Debian 12's."

mapfile -t sources < <(git ls-files --cached --others --exclude-standard '*.cpp' '*.hpp' '*.cu' |
  while IFS= read -r file; do if [[ -f $file ]]; then printf '%s\n' "$file"; fi; done)
[[ ${#sources[@]} -gt 100 ]] || fail "only ${#sources[@]} sources were found"
printf '%s\0' "${sources[@]}" | xargs -0 clang-format --dry-run -Werror ||
  fail "these files are not formatted. Format them: git ls-files '*.cpp' '*.hpp' '*.cu' | xargs clang-format -i"
echo "clang-format: ${#sources[@]} files"
if [[ $format_only == yes ]]; then exit 0; fi

# Everything is analysed in batches, files that were asked for one by one.
batches=OFF
if [[ -z $changed && $# -eq 0 ]]; then batches=ON; fi
build=build-lint/$([[ $batches == ON ]] && echo batches || echo units)
export build
mkdir -p "$build"
cmake --preset cpu -B "$build" -DCMAKE_EXPORT_COMPILE_COMMANDS=ON -DTALUS_WERROR=OFF -DTALUS_BATCHES=$batches \
  >"$build/configure.log" 2>&1 || { cat "$build/configure.log" >&2; fail "configuring failed"; }

if [[ $# -gt 0 ]]; then
  units=("${@/#/$PWD/}")
elif [[ -n $changed ]]; then
  # Units of the last commits, the latest first.
  mapfile -t units < <({ git diff --name-only HEAD; git log --format= --name-only -n 200; } |
    awk '!seen[$0]++' | grep -E '\.(cpp|cu)$' |
    while IFS= read -r file; do if [[ -f $file ]]; then printf '%s\n' "$PWD/$file"; fi; done |
    head -n "$changed" || true)
else
  mapfile -t units < <(grep -oE '"file": "[^"]+\.(cpp|cxx|cu)"' "$build/compile_commands.json" | cut -d'"' -f4 |
    awk '/unity_/ { print; next } { single[++n] = $0 } END { for (i = 1; i <= n; i++) print single[i] }')
fi

# Headers that can be included alone. The flags are those of all units of the project together.
flags=$(grep -oE ' (-I|-isystem |-D|-std=)[^ ]+' "$build/compile_commands.json" | grep -v '\\' | sort -u | tr '\n' ' ')
export flags
# text_of FILE: checksum of a file, of the project's headers that it includes, and of .clang-tidy.
text_of() {
  # shellcheck disable=SC2086
  { g++ $flags -I. -x c++ -MM "$1" 2>/dev/null | tr ' \\' '\n\n' | grep -E '\.(hpp|cpp|cu)$' | xargs -r cat
    cat "$1" .clang-tidy; } | sha256sum
}
alone() {
  local stamp=build-lint/alone/${1//\//_} sum
  sum=$(text_of "$1")
  if [[ -f $stamp && $(<"$stamp") == "$sum" ]]; then return 0; fi
  # shellcheck disable=SC2086
  g++ $flags -I. -fsyntax-only -x c++ -Wall -Wextra -include "$1" /dev/null || return 1
  echo "$sum" >"$stamp"
}
export -f alone text_of

# analyse FILE: clang-tidy, unless this very text of the unit and of its headers has been found clean before.
analyse() {
  local unit=$1 stamp log
  log=build-lint/tidy/${unit//\//_}
  stamp=$(text_of "$unit")
  if [[ -f $log.clean && $(<"$log.clean") == "$stamp" ]]; then return 0; fi
  # A batch includes sources, which is what that check looks for.
  if clang-tidy -p "$build" --quiet --warnings-as-errors='*' --checks=-bugprone-suspicious-include "$unit" \
    >"$log.log" 2>"$log.err"; then
    echo "$stamp" >"$log.clean"
  else
    { grep -E 'warning:|error:' "$log.log" || tail -n 20 "$log.err"; } | sort -u
    return 1
  fi
}
export -f analyse
mkdir -p build-lint/tidy build-lint/alone
if [[ -z $changed && $# -eq 0 ]]; then
  # What includes CUDA's own headers needs its toolkit.
  mapfile -t headers < <(printf '%s\n' "${sources[@]}" | grep -E '\.hpp$' | xargs grep -L '#include <cuda')
  printf '%s\0' "${headers[@]}" | xargs -0 -r -P "$(nproc)" -n 1 bash -c 'alone "$1"' _ ||
    fail "headers do not build alone"
  echo "headers that build alone: ${#headers[@]}"
fi
# Units that CMake makes or leaves out are not looked at: they are not there, or have no command.
printf '%s\n' "${units[@]}" | while IFS= read -r unit; do
  if [[ -f $unit ]] && grep -qF "\"$unit\"" "$build/compile_commands.json"; then printf '%s\0' "$unit"; fi
done >build-lint/list
count=$(tr -cd '\0' <build-lint/list | wc -c)
[[ $count -gt 0 || -n $changed ]] || fail "no unit to analyse"
xargs -0 -r -P "$(nproc)" -n 1 bash -c 'analyse "$1"' _ <build-lint/list || fail "clang-tidy has something to say"
echo "clang-tidy: $count units"
