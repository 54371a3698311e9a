#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# From stability to run-out: what a search for the factor of safety finds is what the run of the same scene lets go.
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

# The scene on cells of 20 m, in seconds.
stage_scene() {
  mkdir -p pipelines
  cp "$TALUS_SOURCE/pipelines/Makefile" pipelines/
  cp -r "$TALUS_SOURCE/pipelines/synthetic-stability" pipelines/scene
  sed -i -e "s,../../data_samples,$TALUS_SOURCE/data_samples," -e 's/^spacing_m.*/spacing_m = 20.0/' \
    -e 's/^tolerance.*/tolerance = 0.1/' pipelines/scene/stability.toml
  sed -i 's/^end_time_s.*/end_time_s = 4.0/' pipelines/scene/recipe.toml
}

make_scene() { make -C pipelines scene BIN="$bin" OUT=out ON=cpu; }

# number FILE KEY: of a JSON file with one key a line.
number() { sed -n "/^ *\"$2\": */{s///;s/,*\$//;p;q}" "$1"; }

test_the_mass_that_fails_first_is_what_runs() {
  stage_scene
  expect_exit 0 make_scene
  local search=out/scene/stability/stability.json factor critical released
  factor=$(number $search factor_of_safety)
  critical=$(number $search critical_volume_m3)
  released=$(number out/scene/score.json volume_released_m3)
  awk -v f="$factor" 'BEGIN { exit !(f > 1 && f < 1.6) }' || fail "the factor of safety is '$factor'"
  grep -q '"failure_confirmed": true' $search || fail "the mass that fails was not seen to move"
  # The same mass, as a map: thickness below the threshold of maps is left out.
  awk -v a="$critical" -v b="$released" 'BEGIN { exit !(a > 0 && b > 0.95 * a && b < 1.05 * a) }' ||
    fail "$critical m3 fail, but $released m3 are let go"
  [[ -s out/scene/map.png && -s out/scene/stability/map.png ]] || fail "a map is missing"
}

run_test "$@"
