#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# What the results let a reader believe: from which thickness cells count, and the doubts of all stages on page one.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

# run_of [ARGUMENT...]: all three stages of recipe.toml.
run_of() {
  rm -rf out
  expect_exit 0 preprocess "$@"
  expect_exit 0 solve "$@"
  expect_exit 0 postprocess "$@"
}

# One threshold in the run, the scores, the used recipe and the report, and the areas and run-out that follow from it.
expect_threshold() {
  /usr/bin/python3 - "$1" >stdout 2>stderr <<'PYTHON' || fail "threshold $1: $(<stderr)"
import json
import re
import sys
import h5py
import numpy as np

threshold = float(sys.argv[1])
score = json.load(open("out/score.json"))
maps = h5py.File("out/run.h5")["maps"]
assert abs(maps.attrs["threshold_m"] - threshold) < 1e-9, maps.attrs["threshold_m"]
for name in ("footprint", "deposit"):
    assert abs(score[f"{name}_threshold_m"] - threshold) < 1e-9, score[f"{name}_threshold_m"]
used = open("out/solve.used.toml").read()
assert float(re.search(r"^map_threshold_m = (\S+)", used, re.M)[1]) == threshold, used
cell = maps.attrs["cell_m"]
deposit, peak = (np.nan_to_num(maps[name][()]) for name in ("deposit_thickness", "peak_thickness"))
assert score["affected_area_m2"] == (peak > threshold).sum() * cell**2
assert score["deposit_area_m2"] == (deposit > threshold).sum() * cell**2
page = json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', open("out/report.html").read(),
                            re.S)[1])
assert set(page["run"]["thresholds"].values()) == {threshold}, page["run"]["thresholds"]
shown = {e["key"]: e for section in page["score"]["sections"] for e in section["entries"]}
for key in ("affected_area_m2", "deposit_area_m2", "runout_m", "h_over_l"):
    assert shown[key]["value"] == score[key], key
for key in ("affected_area_m2", "deposit_area_m2", "runout_m"):
    assert f"> {threshold:g} m" in shown[key]["label"], shown[key]["label"]
PYTHON
}

test_the_threshold_follows_a_thin_release() {
  scene
  sed -i 's/^\[preprocess.grid\]/[preprocess.source]\nseed_m = [500045, 5000105]\n\n&/' recipe.toml
  local thick threshold
  while read -r thick threshold; do
    grid after.asc "$bowl - $thick * $in_source"
    sed -i "s/^layer_height_m.*/layer_height_m = $(awk "BEGIN { print $thick / 2 }")/" recipe.toml
    run_of --set preprocess.source.threshold_m=0.001
    expect_threshold "$threshold"
  done <<<$'4 0.1\n1 0.05\n0.2 0.01'
}

test_a_threshold_that_is_given_stays_and_that_of_the_run_goes_on() {
  scene
  run_of --set solve.map_threshold_m=0.3
  expect_threshold 0.3
  run_of --set postprocess.deposit_threshold_m=0.5
  grep -q '"deposit_threshold_m": 0.5' out/score.json && grep -q '"footprint_threshold_m": 0.1' out/score.json ||
    fail "a threshold that is given changes the other, or is not taken"
}

# expect_doubts NAME...: each is found in scores, table and report, and no finding of the run is missing there.
expect_doubts() {
  /usr/bin/python3 - "$@" >stdout 2>stderr <<'PYTHON' || fail "doubts $*: $(<stderr)"
import json
import re
import sys

score = json.load(open("out/score.json"))
table = " ".join(open("out/score.txt").read().split())
page = json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', open("out/report.html").read(),
                            re.S)[1])
found = {f["name"] for f in score["findings"]}
assert set(sys.argv[1:]) <= found, found
assert len(score["belief"]) == 3 and page["score"]["belief"] == score["belief"]
for sentence in score["belief"]:
    assert " ".join(sentence.split()) in table, sentence
for finding in score["findings"]:
    if finding["severity"] != "advice":
        assert finding["name"] in score["belief"][1], finding["name"]
    assert finding["name"] in {f["name"] for f in page["score"]["findings"]}
    assert f'"{finding["name"]}"' in table, finding["name"]
PYTHON
}

# expect_belief WORDS...
expect_belief() {
  local words said
  said=$(/usr/bin/python3 -c 'import json; print(*json.load(open("out/score.json"))["belief"])')
  for words in "$@"; do [[ $said == *"$words"* ]] || fail "\"$words\" is not in: $said"; done
}

test_a_guessed_depth_stands_on_page_one() {
  scene
  cat >outline.geojson <<'GEOJSON'
{"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {}, "geometry": {"type": "Polygon",
  "coordinates": [[[500020, 5000070], [500080, 5000070], [500080, 5000130], [500020, 5000130], [500020, 5000070]]]}}]}
GEOJSON
  sed -i 's/^after_dem = "after.asc"/source.polygon = "outline.geojson"/; /^\[postprocess.survey/,$d' recipe.toml
  run_of
  expect_doubts assumed-volume
  expect_belief "guessed from the area of its outline, an order of magnitude" "No survey says how far" \
    "the recipe does not say"
  run_of --set preprocess.source.sliding_surface.volume_m3=4000
  expect_belief "the volume of 4 000 m3 is given by the recipe"
  run_of --set preprocess.source.sliding_surface.depth_m=3
  expect_belief "computed for a depth that the recipe gives"
}

test_doubts_of_every_stage_reach_page_one() {
  scene
  sed -i '/^friction_angle_deg = 15/d; /^\[solve.base\]/d' recipe.toml
  run_of --set solve.end_time_s=0.5
  expect_doubts unknown-survey-error ended-before-rest
  expect_belief "is the program's default" "measured between two elevation models, of an error that is not known" \
    'of "survey"' "may not be used by itself"
}

test_what_was_accepted_stands_on_page_one() {
  scene
  sed -i 's/^\[solve\]/&\naccept = ["weight-strain", "slow-waves"]/
    s/^\[solve.material\]/&\nyoungs_modulus_Pa = 2e4/' recipe.toml
  run_of --set solve.end_time_s=0.5
  expect_doubts weight-strain
  expect_belief "weight-strain of [solve], accepted"
}

test_a_recipe_of_talus_new_says_that_its_friction_is_a_guess() {
  local samples=$TALUS_SOURCE/data_samples/valley spacing
  expect_exit 0 "$bin/talus" new "$samples/before_dem.tif" "$samples/after_dem.tif" --recipe new.toml
  grep -q '^friction_is = "guessed"' new.toml || fail "the recipe does not call its friction a guess"
  spacing=$(sed -n 's/^spacing_m = \([0-9]*\).*/\1/p' new.toml)
  expect_exit 0 "$bin/talus" run new.toml --out out --on cpu --set "preprocess.grid.spacing_m=$((2 * spacing))" \
    --set solve.end_time_s=5
  expect_belief "is a guess, neither measured nor fitted"
}

run_test "$@"
