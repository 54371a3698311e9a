#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# An error budget (design = "budget") from recipe to table: its members beside the same runs by hand, and what is left
# out. How members are run, resumed and counted: ensemble_test.sh.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

# budget [LINE...]: the bowl with a budget, and lines for [ensemble.budget].
budget() {
  scene
  printf '\n[ensemble]\ndesign = "budget"\n[ensemble.budget]\nsurvey_draws = 1\n' >>recipe.toml
  [[ $# -eq 0 ]] || printf '%s\n' "$@" >>recipe.toml
}

# field RUN KEY: what the row of this run in budget.json has there, a line for each item of a list.
field() {
  /usr/bin/python3 - "$@" <<'PYTHON'
import json
import sys

value = next(row for row in json.load(open("out/budget.json"))["rows"] if row["run"] == sys.argv[1])[sys.argv[2]]
print("\n".join(value) if isinstance(value, list) else value)
PYTHON
}

test_a_member_is_the_run_by_hand() {
  budget
  for stage in preprocess solve postprocess; do
    expect_exit 0 $stage
    expect_stdout_paths
  done
  expect_words "error budget" "friction at the bed"
  local name value
  for name in recipe step friction-more cells; do
    local -a set=(--set ensemble.design=sobol)
    if [[ $name != recipe ]]; then
      while IFS= read -r value; do set+=(--set "$value"); done < <(field $name values)
      [[ ${#set[@]} -ge 4 ]] || fail "$name has no values"
    fi
    expect_exit 0 "$bin/talus-preprocess" recipe.toml --out "$name" "${set[@]}"
    expect_exit 0 "$bin/talus-solve" recipe.toml --out "$name" --on cpu "${set[@]}"
  done
  expect_exit 0 "$bin/talus-postprocess" recipe.toml --out recipe --set ensemble.design=sobol
  /usr/bin/python3 - >stdout 2>stderr <<'PYTHON' || fail "table and runs by hand do not say the same"
import csv
import json
import h5py
import numpy as np

table = json.load(open("out/budget.json"))
rows = {row["run"]: row for row in table["rows"]}
counts = h5py.File("out/counts.h5")["members/deposit_thickness"]
names = [row["name"] for row in csv.DictReader(open("out/members.csv"))]
ends = np.concatenate([[0], counts["ends"][()]])
quantum = counts.attrs["quantum_m"]
taken = 0
by_hand = {}
for k, name in enumerate(names):
    lengths = counts["runs"][ends[k]:ends[k + 1]]
    inside = np.repeat(np.arange(len(lengths)) % 2 == 1, lengths)
    kept = np.zeros(len(inside))
    kept[inside] = quantum * counts["values"][taken:taken + inside.sum()]
    taken += inside.sum()
    if name not in ("recipe", "step", "friction-more", "cells"):
        continue
    run = np.nan_to_num(h5py.File(f"{name}/run.h5")["maps/deposit_thickness"][()].ravel())
    assert run.sum() > 0 and len(run) == len(kept), (name, len(run), len(kept))
    assert np.abs(run - kept).max() <= 0.51 * quantum, (name, np.abs(run - kept).max())
    by_hand[name] = run
own = by_hand["recipe"]
for name in ("step", "friction-more"):
    other = by_hand[name]
    elsewhere = 50 * np.abs(own - other * own.sum() / other.sum()).sum() / own.sum()
    assert abs(rows[name]["deposit_elsewhere_percent"] - elsewhere) < 1e-4, (name, elsewhere)
# Numbers of one name are the same in the budget, the table of members and the scores of the run itself.
score = json.load(open("recipe/score.json"))
member = next(row for row in csv.DictReader(open("out/members.csv")) if row["name"] == "recipe")
pairs = [("run_out_m", "runout_m"), ("footprint_csi", "footprint_csi"), ("deposit_csi", "deposit_csi"),
         ("thickness_rmse_m", "thickness_rmse_m"), ("flow_area_m2", "affected_area_m2"),
         ("deposit_area_m2", "deposit_area_m2"), ("largest_deposit_m", "max_deposit_thickness_m"),
         ("drop_m", "drop_m"), ("centre_travel_m", "centre_of_mass_travel_m")]
compared = 0
for name, key in pairs:
    if key not in score:
        continue
    for where in (table["own"], member):
        if name in where:
            compared += 1
            off = abs(float(where[name]) - score[key])
            assert off <= 1e-5 * max(1, abs(score[key])), (name, where[name], score[key])
assert compared >= 9, compared
done = [row for row in table["rows"] if row["state"] == "counted"]
sizes = [row["deposit_elsewhere_percent"] for row in done]
assert len(sizes) > 6 and sizes == sorted(sizes, reverse=True), sizes
assert {row["kind"] for row in done} == {"numerical", "physical"}
assert all(row["deposit_csi"] is not None for row in done)
read = list(csv.DictReader(open("out/budget.csv")))
assert [row["run"] for row in read] == [row["run"] for row in table["rows"]]
page = open("out/ensemble.html").read()
assert "How sure the run is" in page and '"deposit_spread_physical"' in page
PYTHON
  expect_exit 0 gdalinfo out/budget/deposit_spread_numerical.tif
  grep -q 'name="Spread of the deposit thickness over all doubts \[m\]"' out/budget/*.qgs ||
    fail "the project of QGIS lacks the map of spread"
}

# Members leave the scar out of a change, where the score of a run takes the gain of height: another name.
test_scores_of_one_name_are_the_same_against_a_change() {
  budget 'leave_out = ["cells", "survey", "strength", "friction", "transfer", "step", "modulus", "integrator"]'
  grid later.asc "$bowl - 4 * $in_source + 2 * (i >= 6 && i < 11 && j >= 8 && j < 12)"
  sed -i 's/^thickness = "survey.asc"/before_dem = "before.asc"\nafter_dem = "later.asc"/' recipe.toml
  local stage
  for stage in preprocess solve postprocess; do expect_exit 0 $stage; done
  for stage in preprocess solve postprocess; do
    expect_exit 0 "$bin/talus-$stage" recipe.toml --out alone --set ensemble.design=sobol
  done
  /usr/bin/python3 - >stdout 2>stderr <<'PYTHON' || fail "budget and run do not say the same"
import json

own, score = json.load(open("out/budget.json"))["own"], json.load(open("alone/score.json"))
shared = sorted(set(own) & set(score))
assert "footprint_csi" in shared and "deposit_csi_outside_release" in own, shared
for name in shared:
    if name not in ("steps", "wall_time_s"):
        assert 0 != score[name] and abs(own[name] - score[name]) < 1e-5, (name, own[name], score[name])
PYTHON
  expect_exit 0 postprocess --set postprocess.deposit_threshold_m=0.5
  expect_words "members count what is thicker than 0.1 m" "thicker than 0.1 m (footprint) and 0.5 m (deposit)"
}

test_a_survey_without_a_known_error_is_named() {
  budget 'leave_out = ["strength", "transfer", "integrator"]'
  expect_exit 0 preprocess   # the models are the same but for the scar: their error cannot be seen
  expect_words "survey-1 is left out: [ensemble.elevation_error]" "the error of the survey is not known"
  expect_exit 0 solve
  expect_words "survey-1       left out: "
  expect_exit 0 postprocess
  [[ $(field survey-1 state) == "left out" && $(field survey-1 run_out_m) == None ]] || fail "it is not said"
  printf '[ensemble.elevation_error]\nterrain_deviation_m = 0.2\nrange_m = 40.0\n' >>recipe.toml
  expect_exit 0 preprocess
  expect_words "2 of 12 members get a domain of their own"
  expect_exit 0 solve
  expect_exit 0 postprocess
  [[ $(field survey-1 state) == counted ]] || fail "the survey has no row"
}

test_what_only_a_member_needs_is_accepted_for_something() {
  budget 'leave_out = ["cells", "survey", "strength", "friction", "transfer", "step", "modulus"]' \
    '[[ensemble.budget.run]]' 'name = "soft"' 'set = ["solve.material.youngs_modulus_Pa=1e5"]' \
    '[[ensemble.budget.run]]' 'name = "thrown"' 'set = ["solve.initial_velocity_m_s=[150.0, 0.0, 0.0]"]'
  sed -i 's/^end_time_s.*/end_time_s = 1.0\naccept = ["weight-strain", "strong-loads"]/' recipe.toml
  expect_exit 0 preprocess
  expect_exit 0 solve
  expect_words '[solve]: accept = ["strong-loads"]: there was nothing of the kind'
  ! grep -q 'accept = \["weight-strain"\]: there was' stderr || fail "what the budget needs is said to be idle"
  expect_words "came to the edge of their domain (thrown)"
  expect_exit 0 postprocess
  [[ $(field thrown row) == own && $(field thrown kind) == physical ]] || fail "a change of the recipe's own has no row"
}

test_one_command_makes_all_of_it() {
  budget
  sed -i '/^\[ensemble/,$d' recipe.toml
  expect_exit 0 "$bin/talus" run recipe.toml --out out --on cpu
  [[ ! -e out/counts.h5 ]] || fail "nobody asked for a budget"
  expect_exit 0 "$bin/talus" run recipe.toml --out out --on cpu --budget
  [[ -s out/budget.json && -s out/ensemble.html && -s out/report.html ]] || fail "run or budget is not shown"
  expect_exit 0 "$bin/talus" run recipe.toml --out out --on cpu --budget
  expect_words "solve: counts.h5 is up to date" "postprocess: budget.json is up to date"
  printf '[budget]\nmake = true\n' >>recipe.toml
  expect_exit 2 "$bin/talus" run recipe.toml --out out --on cpu
  expect_words "[budget]: no longer a table" 'design = "budget" in [ensemble]'
}

run_test "$@"
