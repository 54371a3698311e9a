#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# An error budget from recipe to report: its runs beside the same runs by hand, after Ctrl-C, and what is left out.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

# budget [LINE...]: the bowl with a budget of few runs, and lines for [budget].
budget() {
  scene
  sed -i 's/^layer_height_m.*/layer_height_m = 2.0/' recipe.toml
  printf '\n[budget]\nsurvey_draws = 1\n' >>recipe.toml
  [[ $# -eq 0 ]] || printf '%s\n' "$@" >>recipe.toml
}

# same_deposit BUDGET RUN FILE: the run of this name in budget.h5 has the bits of the run in FILE.
same_deposit() {
  /usr/bin/python3 - "$@" <<'PYTHON' || fail "the deposit of run $2 of $1 is not that of $3"
import sys
import h5py
import numpy as np

runs = h5py.File(sys.argv[1])["runs"].values()
run = next(run for run in runs if run.attrs["name"].decode().strip("\0") == sys.argv[2])
alone = h5py.File(sys.argv[3])["maps/deposit_thickness"][()].ravel()
assert np.array_equal(run["deposit_thickness"][()], alone, equal_nan=True)
assert alone[np.isfinite(alone)].sum() > 0, "nothing is there"
PYTHON
}

# values_of RUN: its values as --set arguments, a line each.
values_of() {
  /usr/bin/python3 - "$1" <<'PYTHON'
import sys
import h5py

for run in h5py.File("out/budget.h5")["runs"].values():
    if run.attrs["name"].decode().strip("\0") == sys.argv[1]:
        print(run.attrs["values"].decode().strip("\0"))
PYTHON
}

test_a_run_of_the_budget_is_the_run_by_hand() {
  budget
  expect_exit 0 preprocess --budget
  expect_stdout_paths
  expect_exit 0 solve --budget
  expect_stdout_paths
  [[ -s out/run.h5 && -s out/budget.h5 ]] || fail "run or budget is missing"
  local name value
  for name in step friction-more cells; do
    local -a set=()
    while IFS= read -r value; do set+=(--set "$value"); done < <(values_of $name)
    [[ ${#set[@]} -ge 2 ]] || fail "$name has no values"
    expect_exit 0 "$bin/talus-preprocess" recipe.toml --out "$name" "${set[@]}"
    expect_exit 0 "$bin/talus-solve" recipe.toml --out "$name" --on cpu "${set[@]}"
    same_deposit out/budget.h5 $name $name/run.h5
  done
}

test_the_table_and_the_maps_show_each_run() {
  budget
  expect_exit 0 preprocess --budget
  expect_exit 0 solve --budget
  expect_exit 0 postprocess
  expect_stdout_paths
  expect_words "error budget" "friction at the bed"
  /usr/bin/python3 - >stdout 2>stderr <<'PYTHON' || fail "table and maps do not say the same"
import csv
import json
import h5py
import numpy as np

table = json.load(open("out/budget.json"))
rows = {row["run"]: row for row in table["rows"]}
own = h5py.File("out/run.h5")["maps/deposit_thickness"][()].ravel()
for run in h5py.File("out/budget.h5")["runs"].values():
    name = run.attrs["name"].decode().strip("\0")
    if run.attrs["state"].decode().strip("\0") != "done" or name == "cells":
        continue
    other = run["deposit_thickness"][()]
    elsewhere = 50 * np.nansum(np.abs(own - other * np.nansum(own) / np.nansum(other))) / np.nansum(own)
    assert abs(rows[name]["deposit_elsewhere_percent"] - elsewhere) < 1e-9, (name, elsewhere)
done = [row for row in table["rows"] if row["state"] == "done"]
sizes = [row["deposit_elsewhere_percent"] for row in done]
assert len(sizes) > 6 and sizes == sorted(sizes, reverse=True), sizes
assert {row["kind"] for row in done} == {"numerical", "physical"}
assert all("deposit_csi" in row and row["deposit_csi"] is not None for row in done)
read = list(csv.DictReader(open("out/budget.csv")))
assert [row["run"] for row in read] == [row["run"] for row in table["rows"]]
page = open("out/report.html").read()
assert "How sure this run is" in page and '"spread_physical"' in page
PYTHON
  expect_exit 0 gdalinfo out/maps/deposit_spread.tif
  grep -q 'name="Spread of the deposit thickness over all doubts \[m\]"' out/maps/*.qgs ||
    fail "the project of QGIS lacks the map of spread"
  expect_exit 0 ncdump -h out/maps/results.nc
  grep -q "deposit_spread_numerical" stdout || fail "results.nc lacks the spread"
}

test_a_missing_domain_is_named() {
  budget
  expect_exit 0 preprocess
  expect_exit 0 solve --budget
  expect_words "cells is left out: " "domain.cells.vdb is missing; talus-preprocess --budget makes it"
  expect_exit 0 postprocess
  expect_words "left out: "
}

test_a_survey_without_a_known_error_is_named() {
  budget
  expect_exit 0 preprocess --budget   # the models are the same but for the scar: their error cannot be seen
  grep -q "survey-1: left out: the error of the survey is not known" out/budget/domains.txt || fail "it is not said"
  expect_words 'no domain "survey-1"'
  expect_exit 0 solve --budget
  expect_words "survey-1 is left out: the error of the survey is not known"
  sed -i 's/^survey_draws = 1/survey_draws = 2/' recipe.toml
  printf '[budget.elevation_error]\nterrain_deviation_m = 0.2\nrange_m = 40.0\n' >>recipe.toml
  expect_exit 0 preprocess --budget
  [[ -s out/budget/domain.survey-1.vdb && -s out/budget/domain.survey-2.vdb ]] || fail "there are no draws"
  expect_exit 0 solve --budget --resume
  [[ $(grep -c "left out" out/budget/domains.txt) -eq 0 ]] || fail "something is left out"
  expect_exit 0 preprocess
  [[ ! -e out/budget ]] || fail "domains of no budget lie about"
}

test_an_interrupted_budget_goes_on() {
  budget
  expect_exit 0 preprocess --budget
  expect_exit 0 solve --budget
  cp out/budget.h5 whole.h5
  rm out/budget.h5
  interrupt INT out/budget.unfinished.h5 "$bin/talus-solve" recipe.toml --out out --on cpu --threads 1 --budget
  expect_words "(interrupted). Go on with --restart; out/budget.unfinished.h5 holds them"
  [[ ! -e out/budget.h5 ]] || fail "an interrupted budget looks finished"
  expect_exit 3 solve --budget
  expect_words "finished runs of this very budget"
  expect_exit 0 solve --budget --restart
  expect_words "out/run.h5: it is this run already" "going on from out/budget.unfinished.h5"
  [[ ! -e out/budget.unfinished.h5 ]] || fail "finished runs lie about"
  expect_exit 0 h5diff whole.h5 out/budget.h5 /runs/00/deposit_thickness
  expect_exit 0 solve --budget
  expect_words "out/budget.h5: it holds this very budget already"
}

test_an_interrupted_run_goes_on_to_its_budget() {
  budget 'leave_out = ["cells", "survey", "strength", "friction", "transfer"]'
  sed -i 's/^end_time_s.*/end_time_s = 20.0\ncheckpoint_interval_s = 1.0/' recipe.toml
  expect_exit 0 preprocess --budget
  interrupt INT out/checkpoint.h5 "$bin/talus-solve" recipe.toml --out out --on cpu --budget
  [[ ! -e out/run.h5 && ! -e out/budget.h5 ]] || fail "an interrupted run looks finished"
  expect_exit 0 solve --budget --restart
  [[ -s out/run.h5 && -s out/budget.h5 && -s out/solve.used.toml ]] || fail "run or budget is missing"
  expect_exit 3 solve --budget --set budget.step_factor=0.25 --restart
  expect_words "out/budget.unfinished.h5: no such file"
}

test_a_run_of_the_recipes_own_stands_in_the_table() {
  budget 'leave_out = ["cells", "survey", "strength", "friction", "transfer", "step"]' '[[budget.run]]' \
    'name = "steep"' 'set = ["solve.base.friction_angle_deg=25"]'
  expect_exit 0 preprocess
  expect_exit 0 solve --budget
  expect_exit 0 postprocess
  grep -q "^steep,own,physical,done,solve.base.friction_angle_deg=25," out/budget.csv || fail "it is not in the table"
  sed -i 's/friction_angle_deg=25/friction_angel_deg=25/' recipe.toml
  expect_exit 2 solve --budget
  expect_words '[[budget.run]] "steep": ' "friction_angle_deg"
}

test_what_only_a_variation_needs_is_accepted_for_something() {
  budget 'leave_out = ["cells", "survey", "strength", "friction", "transfer", "step"]' 'modulus_factor = 0.01' \
    '[[budget.run]]' 'name = "thrown"' 'set = ["solve.initial_velocity_m_s=[150.0, 0.0, 0.0]"]'
  sed -i 's/^end_time_s.*/end_time_s = 1.0\naccept = ["weight-strain", "strong-loads"]/' recipe.toml
  expect_exit 0 preprocess
  expect_exit 0 solve --budget
  expect_words '[solve]: accept = ["strong-loads"]: there was nothing of the kind'
  ! grep -q 'accept = \["weight-strain"\]: there was' stderr || fail "what the budget needs is said to be idle"
  expect_exit 0 postprocess
  grep -A1 '"warnings": \[' out/budget.json | grep -q "left the domain" ||
    fail "a run that left the domain warns of nothing"
}

test_the_price_is_said_before() {
  budget
  expect_exit 0 preprocess --budget
  expect_exit 0 solve --budget --plan
  expect_words "runs beside the run itself" "friction-less" "steps 0.5 times as long"
  [[ ! -e out/run.h5 && ! -e out/budget.h5 ]] || fail "--plan has run"
  expect_exit 0 solve --budget --check
  [[ ! -e out/run.h5 && ! -e out/budget.h5 ]] || fail "--check has run"
}

test_what_a_budget_cannot_be_of_is_refused() {
  budget
  printf '[ensemble]\nmembers = 2\n[[ensemble.vary]]\nkey = "solve.cfl"\nlow = 0.1\nhigh = 0.2\n' >>recipe.toml
  expect_exit 2 preprocess --budget
  expect_words "an error budget with [ensemble]"
  expect_exit 0 preprocess
  expect_exit 2 solve --budget
  expect_words "an error budget with [ensemble]"
}

test_one_command_makes_all_of_it() {
  budget
  expect_exit 0 "$bin/talus" run recipe.toml --out out --on cpu
  [[ ! -e out/budget.h5 ]] || fail "nobody asked for a budget"
  expect_exit 0 "$bin/talus" run recipe.toml --out out --on cpu --budget
  expect_stdout_paths
  [[ -s out/budget.csv && -s out/report.html ]] || fail "the budget is not shown"
  expect_exit 0 "$bin/talus" run recipe.toml --out out --on cpu --budget
  expect_words "solve: budget.h5 is up to date" "postprocess: score.json is up to date"
  expect_exit 0 "$bin/talus" run recipe.toml --out out --on cpu
  expect_words "preprocess: domain.vdb is up to date" "solve: run.h5 is up to date"
  sed -i 's/^survey_draws.*/survey_draws = 1\nfriction_doubt = 0.2/' recipe.toml
  expect_exit 0 "$bin/talus" run recipe.toml --out out --on cpu --budget
  expect_words "out/run.h5: it is this run already" "budget: "
}

run_test "$@"
