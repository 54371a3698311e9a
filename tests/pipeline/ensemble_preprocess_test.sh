#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# The members of an ensemble as talus-preprocess writes them: their table, and domains of those that have ground of
# their own, read by tools that are not ours.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

# releases: the bowl as base with a block of 40 x 40 m, 4 m thick, given by a polygon.
releases() {
  scene
  cat >block.csv <<'CSV'
WKT,thickness
"POLYGON((500030 5000080,500070 5000080,500070 5000120,500030 5000120,500030 5000080))",4
CSV
  sed -i -e 's/^before_dem.*/base_dem = "before.asc"/' -e '/^after_dem/d' \
    -e 's/^\[preprocess.grid\]/[[preprocess.release]]\nname = "block"\npolygons = "block.csv"\n\n&/' recipe.toml
}

# ensemble LINES: [ensemble] with 4 members and these lines.
ensemble() { printf '\n[ensemble]\nmembers = 4\n%s\n' "$1" >>recipe.toml; }

# fact FILE NAME: what a domain says of itself.
fact() {
  vdb_print -m "$1" >printed
  local place
  place=$(sed -nE "s/^ *fact_name\.([0-9]+): $2\$/\1/p" printed | head -n 1)
  [[ -n $place ]] || fail "$1 says nothing of $2"
  sed -nE "s/^ *fact_value\.$place: //p" printed | head -n 1
}

# expect_near A B TOLERANCE WHAT
expect_near() {
  awk -v a="$1" -v b="$2" -v t="$3" 'BEGIN { exit !(a - b <= t && b - a <= t) }' || fail "$4: $1 instead of $2"
}

test_members_differ_in_every_kind_of_key() {
  need_tool vdb_print
  releases
  {
    echo '# one member a row'
    printf 'preprocess.%s,' thickness_factor 'release[0].thickness_m' 'release[0].grow_m' grid.jitter \
      'release[0].direction'
    cat <<'CSV'
solve.base.friction_angle_deg,solve.shape
1,4,0,0.1,vertical,15,linear
0.5,6,0,0.2,vertical,12.5,quadratic
2,4,10,0.3,vertical,15,quadratic
1,4,-10,0.3,slope-normal,18,linear
CSV
  } >members.csv
  ensemble $'design = "table"\ntable = "members.csv"'
  expect_exit 0 preprocess --check
  expect_words 'ensemble: 4 members, design table' '4 of 4 members get a domain of their own' \
    'preprocess.release[0].grow_m: -10 to 10, mean 0' 'solve.shape: linear in 2, quadratic in 2 members'
  [[ ! -e out ]] || fail "--check wrote something"
  expect_exit 0 preprocess
  expect_stdout_paths
  grep -q '/members\.h5$' stdout || fail "stdout does not name members.h5"
  # thickness_factor is left to talus-solve; 10 m around a square of 40 m with round corners, or off it.
  local volumes=(6400 9600 14057 1600) k
  for k in 0 1 2; do
    expect_near "$(fact out/members/domain.0000$k.vdb released_volume_m3)" "${volumes[$k]}" 5 "volume of member $k"
  done
  awk -v v="$(fact out/members/domain.00003.vdb released_volume_m3)" 'BEGIN { exit !(v > 1610 && v < 2200) }' ||
    fail "member 3 is not 20 x 20 m x 4 m normal to the slope"
  [[ $(fact out/members/domain.00002.vdb ensemble.member) == 2 ]] || fail "a domain does not say whose it is"
  [[ $(fact out/members/domain.00002.vdb ensemble.base) == $(fact out/domain.vdb domain.id) ]] ||
    fail "a member's domain does not name the base"
}

test_the_table_is_read_by_h5py() {
  scene
  ensemble $'seed = 5\n[[ensemble.vary]]\nkey = "solve.base.friction_angle_deg"\nlow = 10.0\nhigh = 20.0
[[ensemble.vary]]\nkey = "solve.base.law"\ndistribution = "discrete"\nwords = ["coulomb", "voellmy"]'
  expect_exit 0 preprocess
  expect_words 'all members run on the base domain'
  [[ ! -e out/members ]] || fail "there are domains of members that need none"
  /usr/bin/python3 - <<'PYTHON' || fail "members.h5 is not what it should be"
import h5py
table = h5py.File("out/members.h5")
assert table.attrs["members"] == 4 and table.attrs["design"].decode() == "sobol" and table.attrs["seed"] == 5
angles, laws = table["keys/000"], table["keys/001"]
assert angles.attrs["key"].decode() == "solve.base.friction_angle_deg"
assert all(10 < a < 20 for a in angles[()]) and len(set(angles[()])) == 4
assert laws.attrs["words"].decode() == "coulomb\nvoellmy" and set(laws[()]) == {0, 1}
assert not table["own_domain"][()].any()
PYTHON
}

test_a_seed_gives_the_same_members_and_domains_are_made_once() {
  need_tool vdb_print
  scene
  ensemble $'[ensemble.elevation_error]\nterrain_deviation_m = 0.5\nthickness_deviation_m = 0.3\nrange_m = 50.0'
  expect_exit 0 preprocess
  expect_words 'elevation error: ground 0.5 m, released thickness 0.3 m' 'domains of members: 4 made'
  h5dump -d /own_domain out/members.h5 >once
  cp out/members/domain.00002.vdb kept.vdb
  rm out/members/domain.00001.vdb
  printf 'x' | dd of=out/members/domain.00003.vdb bs=1 seek=5000 conv=notrunc status=none
  expect_exit 0 preprocess
  expect_words 'domains of members: 2 made' '2 were there'
  cmp -s kept.vdb out/members/domain.00002.vdb || fail "a domain that was there was made again"
  expect_exit 0 "$bin/talus-preprocess" recipe.toml --out other
  [[ $(fact out/members/domain.00001.vdb released_volume_m3) == \
    $(fact other/members/domain.00001.vdb released_volume_m3) ]] || fail "the same seed gave another field"
  [[ $(fact out/members/domain.00000.vdb released_volume_m3) != \
    $(fact out/members/domain.00001.vdb released_volume_m3) ]] || fail "two members have one field"
  expect_exit 0 preprocess --set ensemble.members=2
  [[ $(find out/members -name '*.vdb' | wc -l) -eq 2 ]] || fail "domains of members that are gone were left"
  expect_exit 0 preprocess --set ensemble.members=0
  expect_no_file out/members
  [[ ! -e out/members.h5 ]] || fail "an ensemble that is off left its table"
}

test_a_recipe_that_cannot_be_is_refused_before_anything_runs() {
  scene
  ensemble $'[[ensemble.vary]]\nkey = "preprocess.source.threshold_m"\ndistribution = "normal"\nmean = 0.2
deviation = 0.5'
  expect_exit 2 preprocess
  expect_words 'out of range' 'It must be >= 0. Bound the distribution: low and high in [[ensemble.vary]]'
  expect_no_file out
  sed -i 's/^mean = 0.2/&\nlow = 0.0/' recipe.toml
  expect_exit 2 preprocess
  expect_words '[ensemble]: preprocess.source.threshold_m has no effect (the domain is the same with'
  expect_no_file out
  sed -i 's/^key = .*/key = "preprocess.coregistration.tild"/' recipe.toml
  expect_exit 2 preprocess
  expect_words 'unknown key "tild"'
}

test_the_used_recipe_names_the_ensemble() {
  scene
  expect_exit 0 preprocess
  ! grep -q '^\[ensemble\|^# table: ensemble' out/preprocess.used.toml || fail "it tells of an ensemble that is none"
  printf '10\n20\n' | sed 's/$/,1/' >density.csv
  ensemble $'[[ensemble.vary]]\nkey = "solve.base.friction_angle_deg"\ndistribution = "table"\ntable = "density.csv"'
  expect_exit 0 preprocess --if-outdated
  expect_words 'preprocess: there is no members.h5'
  grep -q '^key = "solve.base.friction_angle_deg"' out/preprocess.used.toml || fail "it does not tell what varies"
  grep -q '^\[\[ensemble.vary\]\]' out/preprocess.used.toml || fail "the used recipe does not tell what varies"
  local line
  for line in '# table: ensemble  sha256 ' '# result: members.h5' '# input: .*/density\.csv  sha256 '; do
    grep -q "^$line" out/preprocess.used.toml || fail "it has no line: $line"
  done
}

test_ctrl_c_leaves_nothing_half() {
  scene
  ensemble $'[ensemble.elevation_error]\nterrain_deviation_m = 0.5\nrange_m = 50.0'
  interrupt INT 'out/members/domain.*.vdb' "$bin/talus-preprocess" recipe.toml --out out --set ensemble.members=20000
  [[ ! -e out/members.h5 && ! -e out/domain.vdb ]] || fail "a stage that was stopped left a result"
  [[ -z $(find out -name '*.partial') ]] || fail "a file that is half was left"
}

run_test "$@"
