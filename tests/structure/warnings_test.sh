#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# All our own code is compiled with the warnings of cmake/warnings.cmake, of which conversions are errors; but not the
# program of a user of the library.
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

# bare_targets FILE...: "FILE: TARGET" for each library or program of C++ that does not link talus_warnings.
bare_targets() {
  /usr/bin/python3 - "$@" <<'PYTHON'
import re
import sys

for name in sys.argv[1:]:
    text = re.sub(r"#.*", "", open(name, encoding="utf-8").read())
    linked = set()
    for target, words in re.findall(r"target_link_libraries\(\s*(\S+)\s+([^)]*)\)", text):
        if "talus_warnings" in words.split():
            linked.add(target)
    for target, words in re.findall(r"add_(?:library|executable)\(\s*(\S+)\s*([^)]*)\)", text):
        kinds = words.split()
        if kinds and (kinds[0] in ("INTERFACE", "ALIAS") or "IMPORTED" in kinds):
            continue
        sources = [word for word in kinds if word not in ("STATIC", "SHARED", "MODULE", "OBJECT")]
        if all(word.endswith(".c") for word in sources):
            continue  # the warnings are of C++
        if target not in linked:
            print(f"{name}: {target}")
PYTHON
}

test_every_target_of_our_own_has_the_warnings() {
  local -a files
  mapfile -t files < <(cd "$TALUS_SOURCE" && find . \( -name build -o -name 'build-*' -o -path ./pipelines/out \
    -o -path ./tests/library/program \) -prune -o \( -name CMakeLists.txt -o -name '*.cmake' \) -printf '%P\n')
  [[ ${#files[@]} -gt 15 ]] || fail "only ${#files[@]} files of CMake were found"
  (cd "$TALUS_SOURCE" && bare_targets "${files[@]}") >found
  [[ ! -s found ]] || fail "without talus_warnings: $(<found)"
}

test_a_target_without_the_warnings_is_found() {
  cat >CMakeLists.txt <<'CMAKE'
add_library(good STATIC a.cpp)
target_link_libraries(good PUBLIC other
  PRIVATE talus_warnings)
add_executable(bare ${_sources})
target_link_libraries(bare PRIVATE good)   # talus_warnings
add_library(shim SHARED shim.c)
add_library(words INTERFACE)
CMAKE
  bare_targets CMakeLists.txt >found
  [[ $(<found) == "CMakeLists.txt: bare" ]] || fail "found: $(<found)"
}

# Conversions are errors for g++, and in what nvcc hands to it.
test_the_warnings_are_errors_and_of_conversions() {
  local rules=$TALUS_SOURCE/cmake/warnings.cmake
  grep -qE '^set\(_warnings .*-Wconversion -Wsign-conversion' "$rules" || fail "warnings.cmake says no -Wconversion"
  grep -q 'APPEND _warnings -Werror' "$rules" || fail "warnings.cmake says no -Werror"
  grep -q 'Wconversion' "$TALUS_SOURCE/cmake/kernels.cmake" || fail "kernels.cmake says no -Wconversion"
  local turned_off
  turned_off=$(cd "$TALUS_SOURCE" && grep -rlE --exclude-dir='build*' --include=CMakeLists.txt --include='*.cmake' \
    --include='*.cpp' --include='*.cu' --include='*.hpp' -e '-Wno-(sign-)?conversion' \
    -e 'diagnostic ignored "-W(sign-)?conversion"' . || true)
  [[ -z $turned_off ]] || fail "they are turned off in: $turned_off"
}

run_test "$@"
