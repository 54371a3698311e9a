#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Ground that can be taken along, through the three programs: told apart on the maps and in the score.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

# The bowl, its after DEM a metre lower in a second place below the source.
erodible_scene() {
  scene
  grid after.asc "$bowl - 4 * $in_source - 1 * (i >= 8 && i < 11 && j >= 8 && j < 12)"
  sed -i 's/^\[preprocess.grid\]/[[preprocess.erodible]]\nname = "ground"\nlowering = true\n\n&/' recipe.toml
  sed -i 's/^\[preprocess.grid\]/[preprocess.source]\nseed_m = [500045, 5000105]\n\n&/' recipe.toml
  cat >>recipe.toml <<'TOML'

[[solve.part]]
release = "ground"
friction_angle_deg = 30.0
cohesion_Pa = 1000.0
softening_slip_m = 0.2
residual_friction_angle_deg = 25.0
TOML
}

test_ground_is_told_from_source() {
  erodible_scene
  expect_exit 0 preprocess
  expect_words "ground: 1,200 m3"
  expect_exit 0 solve
  expect_exit 0 postprocess
  for map in deposit_thickness_source deposit_thickness_ground eroded_depth; do
    [[ -s out/maps/$map.tif ]] || fail "no $map.tif"
  done
  grep -q '"volume_entrained_m3"' out/score.json || fail "score.json does not say what was taken along"
  grep -qE '"volume_released_m3": 6(400|399\.99)' out/score.json ||
    fail "the ground counts as released: $(grep volume_released out/score.json)"
}

test_release_that_is_not_there() {
  erodible_scene
  sed -i 's/^release = "ground"/release = "grund"/' recipe.toml
  expect_exit 0 preprocess
  expect_exit 2 solve
  expect_error 'talus-solve: [[solve.part]] release = "grund": no material point is of that release ' \
    '(the scene has ground, source). Name one of those, or leave the part out'
  expect_no_file out domain.vdb preprocess.used.toml survey
}

test_lowering_needs_two_models() {
  scene
  sed -i -e 's/^after_dem = .*/sliding_surface = "after.asc"/' \
    -e 's/^\[preprocess.grid\]/[[preprocess.erodible]]\nlowering = true\n\n&/' recipe.toml
  expect_exit 2 preprocess
  expect_words "the layer is the difference of two elevation models"
}

test_raster_that_the_law_does_not_use() {
  scene
  grid xi.asc 500
  printf '\n[[preprocess.bed.raster]]\nnumber = "turbulence_m_s2"\nfile = "xi.asc"\n' >>recipe.toml
  expect_exit 0 preprocess
  expect_exit 2 solve
  expect_error 'talus-solve: [preprocess.bed] turbulence_m_s2 is given, but [solve.base] law does not use it ' \
    '(the raster would have no effect). Name the law that does, or leave the raster out and run talus-preprocess again'
  sed -i 's/^friction_angle_deg = 15.0/law = "voellmy"\nfriction_angle_deg = 15.0/' recipe.toml
  expect_exit 0 preprocess
  expect_exit 0 solve
  expect_exit 0 postprocess
  tr '\n' ' ' <out/score.txt | grep -qF 'where no raster of turbulence_m_s2 says otherwise) may be measured' ||
    fail "the score names a number that a raster has taken the place of: $(head -n 5 out/score.txt)"
}

run_test "$@"
