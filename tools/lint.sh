#!/usr/bin/env bash
# Formatting of every source by clang-format 14 (Debian 12's), and static analysis of every unit, kernels included, by
# clang-tidy 14 with the checks of .clang-tidy. A unit that was clean is not analysed again until it, a header of the
# project or .clang-tidy has changed.
# usage: tools/lint.sh [--changed N] [FILE...]     --changed: analyse only the N units changed last; FILE: only these
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

fail() { echo "tools/lint.sh: $*" >&2; exit 1; }

changed=
if [[ ${1:-} == --changed ]]; then
  changed=${2:?tools/lint.sh --changed N}
  shift 2
fi
for tool in clang-format clang-tidy cmake ninja; do
  command -v $tool >/dev/null || fail "$tool was not found. Install it: make lint"
done
clang-format --version | grep -q 'version 14\.' ||
  fail "clang-format is not version 14 ($(clang-format --version)); other versions format otherwise. Use Debian 12's."

mapfile -t sources < <(git ls-files --cached --others --exclude-standard '*.cpp' '*.hpp' '*.cu' |
  while IFS= read -r file; do if [[ -f $file ]]; then printf '%s\n' "$file"; fi; done)
[[ ${#sources[@]} -gt 100 ]] || fail "only ${#sources[@]} sources were found"
printf '%s\0' "${sources[@]}" | xargs -0 clang-format --dry-run -Werror ||
  fail "these files are not formatted. Format them: git ls-files '*.cpp' '*.hpp' '*.cu' | xargs clang-format -i"
echo "clang-format: ${#sources[@]} files"

build=build-lint
cmake --preset cpu -B $build -DCMAKE_EXPORT_COMPILE_COMMANDS=ON -DTALUS_WERROR=OFF >"$build.log" 2>&1 ||
  { cat "$build.log" >&2; fail "configuring failed"; }
mv "$build.log" "$build/configure.log"

mapfile -t units < <(printf '%s\n' "${sources[@]}" | grep -E '\.(cpp|cu)$')
if [[ $# -gt 0 ]]; then
  units=("$@")
elif [[ -n $changed ]]; then
  # Units of the last commits, the latest first.
  mapfile -t units < <({ git diff --name-only HEAD; git log --format= --name-only -n 200; } |
    awk '!seen[$0]++' | grep -E '\.(cpp|cu)$' |
    while IFS= read -r file; do if [[ -f $file ]]; then printf '%s\n' "$file"; fi; done | head -n "$changed" || true)
fi

# analyse FILE: clang-tidy, unless this very text of the unit and of all headers has been found clean before.
analyse() {
  local unit=$1 stamp log
  log=build-lint/tidy/${unit//\//_}
  stamp=$(cat "$unit" build-lint/headers.sum .clang-tidy | sha256sum)
  if [[ -f $log.clean && $(<"$log.clean") == "$stamp" ]]; then return 0; fi
  if clang-tidy -p build-lint --quiet --warnings-as-errors='*' "$unit" >"$log.log" 2>"$log.err"; then
    echo "$stamp" >"$log.clean"
  else
    { grep -E 'warning:|error:' "$log.log" || tail -n 20 "$log.err"; } | sort -u
    return 1
  fi
}
export -f analyse
mkdir -p build-lint/tidy
printf '%s\n' "${sources[@]}" | grep -E '\.hpp$' | xargs -d '\n' cat | sha256sum >build-lint/headers.sum
# Units that CMake makes or leaves out have no command: they are not looked at.
printf '%s\n' "${units[@]}" | while IFS= read -r unit; do
  if grep -qF "/$unit\"" build-lint/compile_commands.json; then printf '%s\0' "$unit"; fi
done >build-lint/units
count=$(tr -cd '\0' <build-lint/units | wc -c)
[[ $count -gt 0 || -n $changed ]] || fail "no unit to analyse"
xargs -0 -r -P "$(nproc)" -n 1 bash -c 'analyse "$1"' _ <build-lint/units || fail "clang-tidy has something to say"
echo "clang-tidy: $count units"
