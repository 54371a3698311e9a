#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Files between the stages cut short: by a copy that broke off, say. At any place: the exit code, the message, and no
# result.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"
parts=(0 1 3 10 60 100 300 500 700 900 990 995)   # per mille; the last 128 bytes are the seal

# cut_file FILE PER_MILLE: the first part of FILE.whole.
cut_file() {
  local size
  size=$(stat -c %s "$1.whole")
  head -c $((size * $2 / 1000)) "$1.whole" >"$1"
}

# says_cut PROGRAM FILE MEND: the message of a file that has lost its seal.
says_cut() {
  grep -qF "$1: $2: is damaged (its checksum is missing: another program wrote or changed it, or its end is lost). $3" \
    stderr || fail "stderr does not say that $2 is cut"
}

test_domain() {
  scene
  expect_exit 0 preprocess
  mv out/domain.vdb out/domain.vdb.whole
  local part
  for part in "${parts[@]}"; do
    cut_file out/domain.vdb $part
    expect_exit 3 solve
    says_cut talus-solve out/domain.vdb "Run talus-preprocess again, or copy it again"
    expect_no_file out domain.vdb domain.vdb.whole preprocess.used.toml survey
  done
}

# The contents are whole, but nothing says so any more; and a byte that changed on the way.
test_seal() {
  scene
  expect_exit 0 preprocess
  expect_exit 0 solve
  local file stage mend
  while read -r stage file mend; do
    cp "out/$file" whole
    head -c -1 whole >"out/$file"
    expect_exit 3 "$stage"
    expect_words "talus-$stage: out/$file: is damaged (its checksum is missing: another program wrote or changed it, or"
    cp whole "out/$file"
    printf '\x7f' | dd of="out/$file" bs=1 seek=5000 conv=notrunc status=none
    if cmp -s whole "out/$file"; then fail "the test changed nothing"; fi
    expect_exit 3 "$stage"
    expect_words "talus-$stage: out/$file: is damaged (bytes have changed since it was written: " "$mend"
    cp whole "out/$file"
    expect_exit 0 "$stage"
  done <<'FILES'
solve domain.vdb Run talus-preprocess again, or copy it again
postprocess run.h5 Run talus-solve again
FILES
}

# A level set of another program, damaged: an error that names it, also where OpenVDB crashes.
test_damaged_level_sets() {
  scene
  printf 'id,WKT\n1,"POLYGON((%s))"\n' \
    '500080 5000050,500084 5000050,500084 5000150,500080 5000150,500080 5000050' >wall.csv
  local wall='[[preprocess.obstacle]]\nname = "wall"\npolygons = "wall.csv"\nheight_m = 15.0'
  sed -i "s/^\[preprocess.grid\]/$wall\n\n&/" recipe.toml
  expect_exit 0 preprocess
  printf '\n[[solve.obstacle]]\nname = "wall"\nlevel_set = "wall.vdb"\nfriction_angle_deg = 10.0\n' >>recipe.toml
  head -c -128 out/obstacles.vdb >whole.vdb
  cp whole.vdb wall.vdb
  expect_exit 0 solve --plan
  local size seed code
  size=$(stat -c %s wall.vdb)
  for seed in 1 2 3 4 5 6 7 8; do
    cp whole.vdb wall.vdb
    printf '\xff\xff\xff' | dd of=wall.vdb bs=1 seek=$((size * seed / 97)) conv=notrunc status=none
    code=0
    timeout 60 "$bin/talus-solve" recipe.toml --out out --on cpu --plan >stdout 2>stderr || code=$?
    [[ $code -eq 0 || $code -eq 3 ]] || fail "exit code $code with three bytes changed at $((size * seed / 97))"
    [[ $code -eq 0 ]] || grep -q 'wall\.vdb' stderr || fail "stderr does not name wall.vdb: $(<stderr)"
  done
}

test_domain_of_another_kind() {
  scene
  mkdir out
  echo "not a volume" >out/domain.vdb
  expect_exit 3 solve
  says_cut talus-solve out/domain.vdb "Run talus-preprocess again, or copy it again"
}

test_checkpoint() {
  scene
  make_checkpoint out
  mv out/checkpoint.h5 out/checkpoint.h5.whole
  local part
  for part in "${parts[@]}"; do
    cut_file out/checkpoint.h5 $part
    expect_exit 3 solve --restart
    says_cut talus-solve out/checkpoint.h5 "Run talus-solve again without --restart"
    [[ ! -e out/run.h5 ]] || fail "a truncated checkpoint ($part per mille) gave a run.h5"
  done
  mv out/checkpoint.h5.whole out/checkpoint.h5
  expect_exit 0 solve --restart
}

test_run() {
  scene
  expect_exit 0 preprocess
  expect_exit 0 solve
  mv out/run.h5 out/run.h5.whole
  local part
  for part in "${parts[@]}"; do
    cut_file out/run.h5 $part
    expect_exit 3 postprocess
    says_cut talus-postprocess out/run.h5 "Run talus-solve again"
    [[ ! -e out/score.json && ! -e out/maps && ! -e out/map.png ]] ||
      fail "a truncated run.h5 ($part per mille) gave results"
  done
}

run_test "$@"
