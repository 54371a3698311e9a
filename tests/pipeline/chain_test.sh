#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# From two raw surveys to a score: the valley as noisy, shifted surveys with holes see it, beside the same valley as
# it is.
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

scene() { expect_exit 0 make -C "$TALUS_SOURCE/pipelines" "$1" OUT="$TALUS_SCRATCH/out" BIN="$bin" ON=cpu; }

test_raw_surveys_score_as_the_true_terrain_does() {
  scene synthetic-valley
  scene synthetic-raw-survey
  expect_words 'corrected' 'voids of' 'filled by natural neighbours'
  # The true terrain shows thinner deposit than raw surveys can detect: it is scored above their level of detection.
  local level
  level=$(sed -n 's/.*"survey_detection_m": \([0-9.]*\).*/\1/p' out/synthetic-raw-survey/score.json)
  expect_exit 0 "$bin/talus-postprocess" "$TALUS_SOURCE/pipelines/synthetic-valley/recipe.toml" \
    --out out/synthetic-valley --set "postprocess.deposit_threshold_m=$level"
  local otherwise="the raw surveys do not lead where the true terrain does"
  /usr/bin/python3 - "$TALUS_SCRATCH/out" >stdout 2>stderr <<'PYTHON' || fail "$otherwise"
import json, sys
out = sys.argv[1]
def load(scene, name):
    with open(f"{out}/{scene}/{name}") as file:
        return json.load(file)
clean, raw = load("synthetic-valley", "score.json"), load("synthetic-raw-survey", "score.json")
true_survey, survey = load("synthetic-valley", "survey/survey.json"), load("synthetic-raw-survey", "survey/survey.json")
faults = []
def check(what, value, wanted, allowed):
    print(f"{what}: {value:.4f}, wanted {wanted:.4f} +- {allowed:.4f}")
    if not abs(value - wanted) <= allowed:
        faults.append(what)
a = survey["alignment"]
check("shift east [cells]", a["after_lies_east_m"] / 10, 0.4, 0.05)
check("shift north [cells]", a["after_lies_north_m"] / 10, -0.7, 0.05)
check("lift [m]", a["after_lies_high_m"], 1.3, 0.1)
# What is left on stable ground: two surveys of 0.15 m noise and a swell of 0.13 m (rms), one of them smoothed by
# resampling.
check("NMAD of stable ground [m]", a["stable_ground_aligned"]["nmad_m"], 0.27, 0.06)
erosion = true_survey["volumes"]["raw"]["erosion"]["volume_m3"]
for name in ("source", "deposit"):   # 95 %: 1.96 standard errors
    check(f"{name} volume [m3]", survey[name]["volume_m3"], erosion, 1.96 * survey[name]["error_m3"])
    if not 0.001 < survey[name]["error_m3"] / erosion < 0.02:
        faults.append(f"{name} error of {survey[name]['error_m3']} m3")
for key in ("deposit_csi", "footprint_csi"):
    check(key, raw[key], clean[key], 0.02)
if not 0 < raw["deposit_csi_sd"] < 0.05:
    faults.append("spread of the score")
print(faults)
sys.exit(bool(faults))
PYTHON
}

test_difference_alone_needs_no_solver_options() {
  cat >recipe.toml <<TOML
[scene]
name = "pair"
[preprocess]
before_dem = "$TALUS_SOURCE/data_samples/raw-valley/before_dem.tif"
after_dem = "$TALUS_SOURCE/data_samples/raw-valley/after_dem.tif"
[preprocess.coregistration]
mode = "apply"
TOML
  expect_exit 0 "$bin/talus-preprocess" recipe.toml --out out --difference
  expect_stdout_paths
  expect_words 'erosion' 'beyond its level of detection'
  [[ ! -e out/domain.vdb ]] || fail "a domain was made"
  need_tool gdalinfo
  expect_exit 0 gdalinfo -stats out/survey/difference_sigma.tif
  grep -q 'CORRELATION_LENGTH_M=[1-9]' stdout || fail "the sigma raster does not say how far its errors are alike"
}

run_test "$@"
