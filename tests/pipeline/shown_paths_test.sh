#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# What ensembles and many slides say on stderr calls files as the user did, and never by the folders of this machine.
# Single runs: wrong_input_test.sh and the unit tests ShownPaths.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

# said CODE COMMAND...: it ends with this code, and says nothing of where this machine keeps the scene.
said() {
  expect_exit "$@"
  [[ -s $TALUS_SCRATCH/stderr ]] || fail "it says nothing: this test looks at nothing"
  ! grep -F -e "$TALUS_SCRATCH" -e "$TALUS_BUILD" "$TALUS_SCRATCH/stderr" >found || fail "an absolute path: $(<found)"
}

# stages_say RESULTS TABLE: the three stages, then what they say of RESULTS cut short and of TABLE gone.
stages_say() {
  local results=$1 table=$2
  said 0 preprocess
  said 0 solve
  said 0 postprocess
  cp "$results" whole
  truncate -s -200 "$results"
  said 3 postprocess
  expect_words "$results"
  cp whole "$results"
  rm "$table"
  said 3 solve --restart
}

test_an_ensemble_says_no_absolute_path() {
  scene
  printf '\n[ensemble]\nmembers = 3\n\n[[ensemble.vary]]\nkey = "solve.base.friction_angle_deg"\n' >>recipe.toml
  printf 'low = 10.0\nhigh = 20.0\n' >>recipe.toml
  stages_say out/counts.h5 out/members.h5
  sed -i 's/^after_dem.*/after_dem = "gone.asc"/' recipe.toml
  said 3 preprocess
  expect_words 'gone.asc'
}

test_slides_say_no_absolute_path() {
  scene
  /usr/bin/python3 - <<'PYTHON' || fail "no outlines of slides"
import json
features = []
for n, x in enumerate([30, 50]):
    ring = [[500000 + x + dx, 5000080 + dy] for dx, dy in ((0, 0), (20, 0), (20, 40), (0, 40), (0, 0))]
    features.append({"type": "Feature", "geometry": {"type": "Polygon", "coordinates": [ring]},
                     "properties": {"name": f"slide {n}", "depth": 4 - n}})
json.dump({"type": "FeatureCollection", "features": features}, open("areas.geojson", "w"))
PYTHON
  sed -i 's/^before_dem.*/base_dem = "before.asc"/; /^after_dem/d; /^\[postprocess.survey/,$d' recipe.toml
  cat >>recipe.toml <<'TOML'
[slides]
outlines = "areas.geojson"
name_from = "name"
margin_m = 60.0
set = [{ key = "preprocess.release[0].thickness_m", attribute = "depth" }]
TOML
  stages_say out/counts.h5 out/members.h5
  sed -i 's/"depth": 3/"depth": null/' areas.geojson
  said 3 preprocess
  expect_words 'areas.geojson'
}

run_test "$@"
