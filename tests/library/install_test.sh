#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# A small program, configured and compiled against the library as it is installed.
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

# installed: headers, library and CMake's package, in a folder of this test.
installed() {
  expect_exit 0 cmake --install "$TALUS_BUILD" --component dev --prefix "$TALUS_SCRATCH/prefix"
}

test_program_finds_the_library_and_takes_fifty_steps() {
  installed
  expect_exit 0 cmake -S "$TALUS_SOURCE/tests/library/program" -B build -DCMAKE_PREFIX_PATH="$TALUS_SCRATCH/prefix"
  expect_exit 0 cmake --build build
  expect_exit 0 build/slope
  grep -qx '50 steps, 3600.000 m3' stdout || fail "printed: $(<stdout)"
}

test_document_shows_the_program_as_it_stands() {
  sed '/^\/\/ /d' "$TALUS_SOURCE/tests/library/program/slope.cpp" >code
  awk '/^```cpp/ { inside = 1; next } /^```/ { inside = 0 } inside' "$TALUS_SOURCE/docs/reference/library.md" >shown
  cmp code shown || fail "docs/reference/library.md does not show tests/library/program/slope.cpp as it stands"
}

test_headers_bring_the_standard_library_alone() {
  installed
  local found
  echo '#include <talus/talus.hpp>' >user.cpp
  expect_exit 0 g++ -std=c++20 -M -I prefix/include -I prefix/include/talus user.cpp
  found=$(tr -s ' \\' '\n' <stdout | grep '^/' |
    grep -vE '^/usr/(include/(c\+\+/|[a-z0-9_]+-linux-gnu/|[a-z_0-9-]*\.h$|linux/|asm-generic/)|lib/gcc/)' || true)
  [[ -z $found ]] || fail "headers of other libraries: $found"
  grep -q prefix/include/talus/common/domain/domain.hpp stdout || fail "this test looks at nothing: $(<stdout)"
}

test_library_exports_its_own_names_alone() {
  installed
  local found
  nm -DC --defined-only "$(find prefix -name libtalus.so)" >names
  grep -q ' talus::Plan::Plan(' names || fail "the library has no Plan"
  found=$(grep -vE ' (talus::|(typeinfo|typeinfo name|vtable) for talus::)' names || true)
  [[ -z $found ]] || fail "further names: $(head -n 5 <<<"$found")"
}

test_other_installations_leave_the_library_out() {
  expect_exit 0 cmake --install "$TALUS_BUILD" --prefix "$TALUS_SCRATCH/prefix"
  [[ ! -e prefix/include && -x prefix/bin/talus-solve ]] || fail "headers came with the programs"
}

run_test "$@"
