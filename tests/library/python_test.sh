#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# The Python module: runs in memory, and the wheel in a fresh environment.
source "$(dirname "${BASH_SOURCE[0]}")/../pipeline/scene.sh"
export PYTHONDONTWRITEBYTECODE=1 MPLBACKEND=Agg

need_module() {
  if ! compgen -G "$TALUS_BUILD/python/_core*.so" >/dev/null; then
    [[ -z ${TALUS_REQUIRE_TOOLS:-} ]] || fail "there is no Python module: was pybind11 there when this was configured?"
    skip "there is no Python module (pybind11-dev and python3-dev are not installed)"
  fi
  local package
  for package in h5py numpy xarray matplotlib; do
    /usr/bin/python3 -c "import $package" 2>/dev/null || need_tool "python3-$package"
  done
}

test_module_runs_in_memory_what_the_programs_run() {
  need_module
  scene
  expect_exit 0 "$bin/talus" run recipe.toml --out a --on cpu
  export PYTHONPATH=$TALUS_SOURCE/python:$TALUS_SOURCE/tests/python TALUS_PROGRAMS=$bin
  expect_exit 0 /usr/bin/python3 -m unittest discover -s "$TALUS_SOURCE/tests/library" -p '*_test.py'
  grep -qE '^Ran ([6-9]|[1-9][0-9]+) tests' stderr || fail "hardly a test ran: $(tail -n 3 stderr)"
}

test_wheel_runs_the_examples_in_a_fresh_environment() {
  need_module
  scene
  local examples=$TALUS_SOURCE/python/examples
  unset PYTHONPATH TALUS_PROGRAMS
  expect_exit 0 "$TALUS_SOURCE/tools/make-wheel.sh" "$TALUS_BUILD" wheels
  expect_exit 0 /usr/bin/python3 -m venv --system-site-packages --without-pip fresh
  expect_exit 0 fresh/bin/python -m pip install --quiet --no-index --no-deps wheels/talus-*.whl
  expect_exit 0 fresh/bin/python -c 'import talus, talus.in_process as p; print(p._core().__file__)'
  [[ $(<stdout) == "$TALUS_SCRATCH"/fresh/* ]] || fail "the module is not that of the wheel: $(<stdout)"
  expect_exit 0 fresh/bin/python "$examples/valley_in_memory.py" recipe.toml deposit.png
  [[ $(grep -cE '^[0-9.]+ s: [0-9.]+ m$' stdout) -gt 3 ]] || fail "printed: $(<stdout)"
  [[ $(stat -c %s deposit.png) -gt 10000 ]] || fail "the picture is blank"
  expect_exit 0 fresh/bin/python "$examples/study_in_memory.py" recipe.toml 0.2 0.6
  awk 'NR == 2 { low = $2 } NR == 3 { high = $2 } END { exit !(NR == 3 && low > high && high > 0) }' stdout ||
    fail "friction does not hold the flow back: $(<stdout)"
}

run_test "$@"
