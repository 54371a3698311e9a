#!/usr/bin/env bash
# Files between the stages cut short: by a copy that broke off, say. At any place: the exit code, the message, and no
# result.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"
parts=(0 1 3 10 60 100 300 500 700 900 990 999)   # per mille

# cut_file FILE PER_MILLE: the first part of FILE.whole.
cut_file() {
  local size
  size=$(stat -c %s "$1.whole")
  head -c $((size * $2 / 1000)) "$1.whole" >"$1"
}

# says_cut FILE MEND: the message of a truncated HDF5 file; the library names the lengths.
says_cut() {
  grep -qE "$1: cannot be opened as HDF5 \((truncated file: .*|file signature not found)\)\. $2\$" stderr ||
    fail "stderr does not say that $1 is cut"
}

test_domain() {
  scene
  expect_exit 0 preprocess
  mv out/domain.vdb out/domain.vdb.whole
  local part
  for part in "${parts[@]}"; do
    cut_file out/domain.vdb $part
    expect_exit 3 solve
    expect_error "talus-solve: out/domain.vdb: ends too early (the file is truncated: its writing or copying " \
      "was cut short). Run talus-preprocess again, or copy it again"
    expect_no_file out domain.vdb domain.vdb.whole preprocess.used.toml survey
  done
}

test_domain_of_another_kind() {
  scene
  mkdir out
  echo "not a volume" >out/domain.vdb
  expect_exit 3 solve
  expect_error "talus-solve: out/domain.vdb: not an OpenVDB file (its first bytes say so). " \
    "Make it with talus-preprocess"
}

test_checkpoint() {
  scene
  make_checkpoint out
  mv out/checkpoint.h5 out/checkpoint.h5.whole
  local part
  for part in "${parts[@]}"; do
    cut_file out/checkpoint.h5 $part
    expect_exit 3 solve --restart
    says_cut "talus-solve: out/checkpoint.h5" "Run talus-solve again without --restart"
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
    says_cut "talus-postprocess: out/run.h5" "Run talus-solve again"
    [[ ! -e out/score.json && ! -e out/maps && ! -e out/map.png ]] ||
      fail "a truncated run.h5 ($part per mille) gave results"
  done
}

run_test "$@"
