#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# The Python package on two runs of the bowl, and its examples as docs/how-to/python.md shows them.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"
export PYTHONPATH=$TALUS_SOURCE/python:$TALUS_SOURCE/tests/python PYTHONDONTWRITEBYTECODE=1 TALUS_PROGRAMS=$bin

need_packages() {
  local package
  for package in h5py numpy xarray rasterio; do
    /usr/bin/python3 -c "import $package" 2>/dev/null || need_tool "python3-$package"
  done
}

test_package_reads_changes_runs_and_compares() {
  need_packages
  scene
  gdalsrsinfo -o wkt_esri EPSG:32633 | sed '/^$/d' | tee before.prj after.prj >survey.prj
  expect_exit 0 "$bin/talus" run recipe.toml --out a --on cpu
  expect_exit 0 "$bin/talus" run recipe.toml --out b --on cpu --set solve.base.friction_angle_deg=10
  expect_exit 0 "$bin/talus" compare a b
  expect_exit 0 /usr/bin/python3 -m unittest discover -s "$TALUS_SOURCE/tests/python" -p '*_test.py'
  grep -qE '^Ran [1-9][0-9]+ tests' stderr || fail "hardly a test ran: $(tail -n 3 stderr)"
}

test_examples_run_as_they_stand() {
  need_packages
  scene
  local examples=$TALUS_SOURCE/python/examples
  expect_exit 0 /usr/bin/python3 "$examples/sweep_friction.py" recipe.toml sweep 10 20
  # A smoother bed leads further down.
  awk 'NR == 2 && $1 == 10.0 { low = $2 } NR == 3 && $1 == 20.0 { high = $2 } END { exit !(NR == 3 && low > high) }' \
    stdout || fail "no table, or friction does not hold the slide back"
  expect_exit 0 /usr/bin/python3 "$examples/read_a_run.py" sweep/friction-10 deposit.png
  grep -q '^deposit: 6400 m3' stdout || fail "the volume of the deposit is not 6400 m3"
  if /usr/bin/python3 -c 'import matplotlib' 2>/dev/null; then
    expect_exit 0 gdalinfo deposit.png
  else
    grep -q '^no picture: matplotlib is not installed' stdout || fail "nothing says why there is no picture"
  fi
  expect_exit 0 /usr/bin/python3 "$examples/compare_two_runs.py" sweep/friction-10 sweep/friction-20
  grep -qE '^friction angle of the bed +10 deg and 20 deg$' stdout || fail "the angles are not shown"
}

test_document_shows_the_examples_as_they_stand() {
  local example
  for example in "$TALUS_SOURCE"/python/examples/*.py; do
    # Without the lines of the licence, between the block's fences.
    grep -v '^# SPDX-' "$example" >code
    awk -v name="examples/${example##*/}" '/^```python/ { block = ""; inside = 1; next }
      /^```/ && inside { inside = 0; if (index(heading, name)) printf "%s", block; next }
      inside { block = block $0 "\n"; next } /^#/ || /examples\// { heading = $0 }' \
      "$TALUS_SOURCE"/docs/how-to/{python,extend}.md >shown
    cmp code shown || fail "docs/how-to/{python,extend}.md do not show ${example##*/} as it stands"
  done
}

run_test "$@"
