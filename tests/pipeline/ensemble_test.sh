#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# An ensemble from recipe to counts: in parts, after Ctrl-C and after a kill, and a member beside the same run alone.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

# ensemble [KEY]: the bowl with twelve members that differ in friction and shape functions, and by a factor in KEY.
ensemble() {
  scene
  cat >>recipe.toml <<'TOML'

[ensemble]
members = 12
design = "latin-hypercube"
keep = ["3"]

[[ensemble.vary]]
key = "solve.base.friction_angle_deg"
low = 10.0
high = 20.0

[[ensemble.vary]]
key = "solve.material.friction_angle_deg"
distribution = "normal"
mean = 32.0
deviation = 2.0

[[ensemble.vary]]
key = "solve.shape"
distribution = "discrete"
words = ["quadratic", "linear"]
TOML
  if [[ -n ${1:-} ]]; then
    printf '\n[[ensemble.vary]]\nkey = "%s"\n' "$1" >>recipe.toml
    printf 'distribution = "lognormal"\nmean = 1.0\ndeviation = 0.1\n' >>recipe.toml
  fi
  expect_exit 0 preprocess
  [[ -s out/members.h5 ]] || fail "there is no table of members"
}

test_parts_add_up_to_the_whole() {
  ensemble preprocess.thickness_factor
  expect_exit 0 solve
  expect_stdout_paths
  mv out/counts.h5 whole.h5
  expect_exit 0 solve --members 0:5
  expect_exit 0 solve --members 5:12
  same_counts whole.h5 out/counts.0-5.h5 out/counts.5-12.h5
  expect_exit 0 solve --members 5:12
  expect_words "out/counts.5-12.h5: it holds this very part already"
}

test_a_member_is_the_run_alone() {
  ensemble
  need_tool h5diff
  expect_exit 0 solve --members 0:4
  local -a set=(--set ensemble.members=0)
  local value
  while IFS= read -r value; do set+=(--set "$value"); done < <(
    /usr/bin/python3 - <<'PYTHON'
import h5py

for key in h5py.File("out/members.h5")["keys"].values():
    words = key.attrs["words"].decode().strip("\0").split("\n")
    value = key[3]
    print(key.attrs["key"].decode() + "=" + (words[int(value)] if words != [""] else repr(float(value))))
PYTHON
  )
  [[ ${#set[@]} -eq 8 ]] || fail "three keys vary: ${set[*]}"
  mkdir alone
  cp out/domain.vdb alone
  expect_exit 0 "$bin/talus-solve" recipe.toml --out alone --on cpu "${set[@]}"
  expect_exit 0 h5diff alone/run.h5 out/members/00003/run.h5 /maps
  /usr/bin/python3 - >stdout 2>stderr <<'PYTHON' || fail "the member's footprint is not that of its map"
import h5py
import numpy as np

maps = h5py.File("alone/run.h5")["maps"]
members = h5py.File("out/counts.0-4.h5")["members"]
begin, end = members["flow/ends"][2:4]
inside = np.concatenate([np.full(n, k % 2) for k, n in enumerate(members["flow/runs"][begin:end])])
assert np.array_equal(inside == 1, (maps["peak_thickness"][()] > maps.attrs["threshold_m"]).ravel())
assert inside.sum() > 16, "nothing has moved"
PYTHON
}

test_an_interrupted_ensemble_goes_on() {
  ensemble
  expect_exit 0 solve
  mv out/counts.h5 whole.h5
  rm -r out/members
  sed -i 's/^end_time_s.*/end_time_s = 3.0/; s/^keep = .*//' recipe.toml
  expect_exit 0 preprocess
  interrupt INT 'out/unfinished.0-12.h5' "$bin/talus-solve" recipe.toml --out out --on cpu --threads 1
  expect_words "(interrupted). Go on with --restart; out/unfinished.0-12.h5 holds them"
  [[ ! -e out/counts.h5 && ! -s stdout ]] || fail "an interrupted ensemble looks finished"
  expect_exit 3 solve
  expect_words "finished members of this very ensemble"
  expect_exit 0 solve --restart
  expect_words "going on from out/unfinished.0-12.h5"
  [[ ! -e out/unfinished.0-12.h5 ]] || fail "finished members lie about"
  same_counts whole.h5 out/counts.h5
}

test_a_killed_ensemble_goes_on() {
  ensemble
  expect_exit 0 solve
  mv out/counts.h5 whole.h5
  interrupt KILL 'out/unfinished.0-12.h5' "$bin/talus-solve" recipe.toml --out out --on cpu --threads 1
  [[ ! -e out/counts.h5 ]] || fail "a killed ensemble looks finished"
  expect_exit 0 solve --resume
  same_counts whole.h5 out/counts.h5
  [[ -z $(find out -name '*.partial') ]] || fail "partial files lie about"
}

# Four members, of which the first two fail.
half_that_fails() {
  scene
  cat >>recipe.toml <<'TOML'

[ensemble]
members = 4
design = "full-grid"
levels = 4

[[ensemble.vary]]
key = "solve.material.youngs_modulus_Pa"
distribution = "discrete"
values = [50.0, 60.0, 1e6, 2e6]
TOML
}

test_too_many_failures_fail_the_run() {
  half_that_fails
  expect_exit 0 preprocess
  expect_exit 4 solve
  expect_words "2 of 4 members failed" "failed_share" "member 0"
  [[ ! -e out/counts.h5 ]] || fail "counts of half of the members look finished"
  sed -i 's/^levels = 4/levels = 4\nfailed_share = 0.5/' recipe.toml
  expect_exit 0 preprocess
  expect_exit 0 solve --resume
  expect_words "2 of 4 members failed; the counts are without them"
}

test_failures_of_parts_are_judged_together() {
  half_that_fails
  sed -i 's/^levels = 4/levels = 4\nfailed_share = 0.3/' recipe.toml
  expect_exit 0 preprocess
  expect_exit 4 solve --members 0:2
  for part in 0:1 1:2 2:4; do expect_exit 0 solve --members "$part"; done
  expect_exit 4 postprocess
  expect_words "2 of 4 members failed" "failed_share allows 30 %"
}

test_flags_without_an_ensemble_are_refused() {
  scene
  expect_exit 0 preprocess
  expect_exit 2 solve --members 0:3
  expect_words "--members without an ensemble"
}

run_test "$@"
