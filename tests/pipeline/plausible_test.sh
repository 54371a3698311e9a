#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# What hardly any slide does is refused by name or said; every run says at its end whether its numbers are sane.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

# scene_with TABLE LINE...: the scene with these lines put into a table of its recipe, and its domain.
scene_with() {
  local table=$1
  shift
  scene
  sed -i "s/^\[$table\]/&\n$(printf '%s\\n' "$@")/" recipe.toml
  expect_exit 0 preprocess
}

test_run_says_that_it_is_sane() {
  scene
  expect_exit 0 preprocess
  expect_exit 0 solve
  expect_words 'sanity: volume error' 'packing' 'fall without loss' ': sane'
  expect_exit 0 postprocess
  grep -q '"sanity": "sane"' out/score.json || fail "score.json does not say that the run is sane"
  for name in volume_error packing_p99 packing_max energy_gain speed_max_m_s speed_bound_m_s; do
    grep -q "\"sanity_$name\": [0-9-]" out/score.json || fail "score.json has no sanity_$name"
  done
  for name in packing_p99 packing_max speed_max_so_far_m_s; do
    head -n 1 out/history.csv | grep -q "$name" || fail "history.csv has no $name"
  done
  grep -q 'Sanity' out/score.txt || fail "score.txt has no sanity"
}

# A slope that the mass runs down and out of: the force on the ground is not known then, which a run says at its end.
test_what_a_run_is_warned_of_at_its_end_stands_in_its_results() {
  scene
  grid before.asc '0.6 * (200 - x)'
  grid after.asc '0.6 * (200 - x) - 4 * (i >= 14 && i < 18 && j >= 8 && j < 12)'
  sed -i 's/^end_time_s.*/end_time_s = 8.0/; /^\[postprocess.survey/,$d' recipe.toml
  sed -i 's/^\[preprocess.grid\]/[preprocess.source]\nseed_m = [500155, 5000105]\n\n&/' recipe.toml
  expect_exit 0 preprocess
  expect_exit 0 solve
  local warning='the force on the ground is not known in'
  expect_words "warning: $warning"
  h5dump -d /findings -b LE -o findings out/run.h5 >/dev/null
  grep -qaF "$warning" findings || fail "run.h5 does not say so"
  expect_exit 0 postprocess
  local file
  for file in score.json score.txt report.html; do
    grep -qF "$warning" "out/$file" || fail "$file does not say what the run was warned of at its end"
  done
}

# The surveys that fail, and the one that the run is scored by.
test_other_vertical_datums_are_refused_by_name_in_both_stages() {
  need_tool gdal_translate
  scene
  gdal_translate -q -a_srs EPSG:32633+5773 before.asc before.tif
  gdal_translate -q -a_srs EPSG:32633+3855 after.asc after.tif
  sed -i 's/asc"/tif"/; s/^thickness = .*/after_dem = "after.tif"/' recipe.toml
  expect_exit 3 preprocess
  expect_words 'after.tif: heights above the EGM2008 geoid, while those of before.tif are above the EGM96 geoid' \
    'gdalwarp -s_srs EPSG:32633+3855 -t_srs EPSG:32633+5773' 'accept = ["different-vertical-datums"] in [preprocess]'
  sed -i 's/^\[preprocess\]/&\naccept = ["different-vertical-datums"]/' recipe.toml
  expect_exit 0 preprocess
  expect_exit 0 solve
  expect_exit 3 postprocess
  expect_words 'EGM2008 geoid' 'those of before.tif are above the EGM96 geoid' \
    'accept = ["different-vertical-datums"] in [postprocess]'
  sed -i 's/^\[postprocess.survey\]/[postprocess]\naccept = ["different-vertical-datums"]\n&/' recipe.toml
  expect_exit 0 postprocess
}

# wide_grid FILE EXPRESSION: as grid() of scene.sh, 60 x 60 cells.
wide_grid() {
  awk "BEGIN {
    printf \"ncols 60\nnrows 60\nxllcorner 500000\nyllcorner 5000000\ncellsize 10\n\"
    for (j = 59; j >= 0; --j) for (i = 0; i < 60; ++i) {
      x = 10 * i + 5; y = 10 * j + 5
      printf \"%s%s\", $2, i == 59 ? \"\n\" : \" \"
    }
  }" >"$1"
}

# A mosaic of two flights: its east, a step, a stripe or a tile lies lower, and is no slide.
test_shifted_part_of_a_survey_is_refused_by_name() {
  scene
  local ground='0.3 * x + 4 * sin(y / 40)'
  wide_grid before.asc "$ground"
  local part
  for part in '(i >= 35)' '(i >= 30 && i < 42)' '(i + j > 60)' '(i >= 30 && j >= 30)'; do
    wide_grid after.asc "$ground - 4 * $in_source - 2.5 * $part"
    expect_exit 3 preprocess
    expect_words 'm lower than what is around' 'accept = ["shifted-part"] in [preprocess]'
    expect_exit 3 "$bin/talus" new before.asc after.asc --recipe new/recipe.toml
    expect_words 'm lower than what is around'
    expect_no_file new
  done
  sed -i 's/^\[preprocess\]/&\naccept = ["shifted-part"]/' recipe.toml
  sed -i 's/^\[preprocess.grid\]/[preprocess.source]\nseed_m = [500045, 5000105]\n\n&/' recipe.toml
  expect_exit 0 preprocess
  expect_words 'accepted, "shifted-part"'
}

test_mass_that_its_weight_squashes_is_refused_by_name() {
  scene_with solve.material 'youngs_modulus_Pa = 1.0e4'
  expect_exit 3 solve
  expect_words 'strains by 6.54 under its own weight: 4 m of it press with 7.85e+04 Pa' \
    'accept = ["weight-strain"] in [solve]'
  expect_no_file out domain.vdb survey preprocess.used.toml
  sed -i 's/^\[solve\]/&\naccept = ["weight-strain", "slow-waves"]/' recipe.toml
  expect_exit 0 solve
  expect_words 'accepted, "weight-strain"'
  expect_exit 0 postprocess
  grep -q '"name": "weight-strain"' out/score.json || fail "score.json does not say what was insisted on"
}

test_stiffness_without_end_is_refused_and_ends_the_run_where_insisted_on() {
  scene_with solve.material 'youngs_modulus_Pa = 1.0e300'
  expect_exit 3 solve --check
  expect_words 'youngs_modulus_Pa = 1e+300' 'accept = ["fast-waves"] in [solve]'
  sed -i 's/^\[solve\]/&\naccept = ["fast-waves"]/' recipe.toml
  expect_exit 4 timeout 60 "$bin/talus-solve" recipe.toml --out out --on cpu
  expect_words 'time stands still' 'youngs_modulus_Pa'
  expect_no_file out domain.vdb survey preprocess.used.toml .frames
}

test_load_that_throws_the_mass_out_is_refused_by_name() {
  scene
  cat >>recipe.toml <<'TOML'

[[solve.load]]
extent_m = [500000.0, 5000000.0, 500200.0, 5000200.0, 0.0, 10.0]
force_N = [0.0, 0.0, 1.0e15]
TOML
  expect_exit 0 preprocess
  expect_exit 3 solve
  expect_words '1e+15 N' 'accept = ["strong-loads"] in [solve]'
}

run_test "$@"
