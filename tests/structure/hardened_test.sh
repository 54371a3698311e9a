#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# What programs import says how they were compiled (cmake/hardening.cmake).
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

test_programs_check_lengths_and_stacks() {
  need_tool nm
  local program
  for program in talus talus-preprocess talus-solve talus-postprocess talus-make-terrain; do
    expect_exit 0 nm --dynamic "$bin/$program"
    grep -qE ' U __stack_chk_fail(@|$)' stdout || fail "$program does not protect its stack"
    grep -qE ' U __[a-z]+_chk(@|$)' stdout || fail "$program calls the C library without lengths"
  done
}

run_test "$@"
