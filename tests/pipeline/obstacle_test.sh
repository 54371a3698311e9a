#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# A wall from a polygon, through the three programs: its force is recorded, and what is wrong with it is said.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

wall_scene() {
  scene
  printf 'id,WKT\n1,"POLYGON((%s))"\n' "$1" >wall.csv
  local wall='[[preprocess.obstacle]]\nname = "wall"\npolygons = "wall.csv"\nheight_m = 15.0'
  sed -i "s/^\[preprocess.grid\]/$wall\n\n&/" recipe.toml
  cat >>recipe.toml <<'TOML'

[[solve.obstacle]]
name = "wall"
friction_angle_deg = 10.0
TOML
}

across='500080 5000050,500084 5000050,500084 5000150,500080 5000150,500080 5000050'

test_wall_stops_the_slide_and_records_its_force() {
  wall_scene "$across"
  expect_exit 0 preprocess
  [[ -s out/obstacles.vdb ]] || fail "no obstacles.vdb"
  expect_exit 0 solve --plan
  expect_words "obstacle     wall, 10 deg"
  sed -i 's/^end_time_s.*/end_time_s = 8.0/' recipe.toml
  expect_exit 0 solve
  expect_words "obstacle wall: impulse"
  expect_exit 0 postprocess
  awk -F, 'NR == 1 { for (c = 1; c <= NF; ++c) if ($c == "obstacle_wall_impulse_x_N_s") at = c }
    END { exit !(at && $at > 1e6) }' out/history.csv || fail "the wall was given no impulse towards the east"
  gdallocationinfo -valonly -geoloc out/maps/deposit_thickness.tif 500075 5000100 >before_wall
  gdallocationinfo -valonly -geoloc out/maps/deposit_thickness.tif 500105 5000100 >behind_wall
  awk '{ exit !($1 > 0.5) }' before_wall || fail "nothing lies before the wall: $(<before_wall)"
  awk '{ exit !($1 < 0.02) }' behind_wall || fail "the mass went through the wall: $(<behind_wall)"
}

test_wall_that_stands_elsewhere() {
  wall_scene '500080 4000050,500084 4000050,500084 4000150,500080 4000150,500080 4000050'
  expect_exit 3 preprocess
  expect_words "where there is no ground"
}

test_obstacle_without_a_level_set() {
  wall_scene "$across"
  sed -i '/^\[\[preprocess.obstacle\]\]/,/^height_m/d' recipe.toml
  expect_exit 0 preprocess
  expect_exit 3 solve
  expect_words "obstacles.vdb: no such file"
}

test_what_does_not_go_with_obstacles() {
  wall_scene "$across"
  sed -i 's/^end_time_s.*/end_time_s = 3.0\nenergy_budget = true/' recipe.toml
  expect_exit 0 preprocess
  expect_exit 2 solve
  expect_words "[[solve.obstacle]] does not go with energy_budget = true"
}

run_test "$@"
