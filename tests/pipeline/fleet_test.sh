#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# An ensemble over four workers of Dask on this machine's loopback, of which two are killed in the middle of a part.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

started=()
stop_cluster() {
  local leader
  for leader in "${started[@]}"; do kill -KILL -- "-$leader" 2>/dev/null || true; done
  wait 2>/dev/null || true
}

# start ROLE...: a scheduler or worker, leader of a session of its own.
start() {
  setsid dask "$@" --scheduler-file out/dask.json --no-dashboard >>"dask.log" 2>&1 </dev/null &
  started+=("$!")
}

start_cluster() {
  command -v dask >/dev/null || grep -qx 'ID=debian' /etc/os-release || skip "make setup installs Dask on Debian alone"
  need_tool dask
  export TALUS_BIN=$bin
  trap stop_cluster EXIT
  start scheduler --host 127.0.0.1 --port 0
  local worker
  for worker in 1 2 3 4; do start worker --nthreads 1 --no-nanny; done
}

fleet() { /usr/bin/python3 "$TALUS_SOURCE/pipelines/ensemble.py" "$@"; }

# kill_worker WHOLE: kill -9 a worker that has members of a part finished, with all that it started where WHOLE is yes.
# Its part goes into the array `cut`.
kill_worker() {
  local look file part solver worker
  for ((look = 0; look < 2000; ++look)); do
    for file in $(compgen -G 'out/unfinished.*.h5' | shuf); do
      part=${file#out/unfinished.}
      part=${part%.h5}
      solver=$(sed -n 's/.*(process \([0-9]*\) .*/\1/p' "out/.talus.$part.lock" 2>/dev/null) || continue
      worker=$(ps -o sid= -p "${solver:-0}" | tr -d ' ') || continue
      [[ " ${cut[*]} " != *" $part "* ]] || continue
      if [[ $1 == yes ]]; then kill -KILL -- "-$worker"; else kill -KILL "$worker"; fi || continue
      sleep 0.2
      if [[ -e out/counts.$part.h5 ]]; then  # it was as good as done: one worker more may die for nothing
        ((spare-- > 0)) || fail "part $part was finished before its worker was killed"
        continue
      fi
      cut+=("$part")
      return
    done
    sleep 0.01
  done
  fail "no worker was caught in a part: $(tail -n 5 fleet.log dask.log)"
}

test_parts_of_killed_workers_are_done_again() {
  scene_of_members 64
  sed -i 's/^end_time_s.*/end_time_s = 20.0/' recipe.toml
  expect_exit 0 preprocess
  expect_exit 0 solve
  expect_exit 0 postprocess
  mkdir whole
  mv out/counts.h5 out/members.csv out/probability whole
  start_cluster
  expect_exit 1 fleet recipe.toml out 2 --on nowhere
  expect_words "exit code 2" "2 of 2 parts failed"

  local cut=() spare=1 part code=0 map maps=0
  fleet recipe.toml out 8 --on cpu --threads 1 >stdout 2>fleet.log </dev/null &
  local process=$!
  kill_worker yes
  kill_worker no
  wait $process || code=$?
  [[ $code -eq 0 ]] || fail "exit code $code of ensemble.py: $(tail -n 20 fleet.log)"
  grep -q "^8 of 8 parts" fleet.log || fail "not all parts were said to be done"
  for part in "${cut[@]}"; do
    grep -q "going on from" "out/solve.$part.log" || fail "part $part began anew: $(<"out/solve.$part.log")"
  done
  same_counts whole/counts.h5 out/counts.*.h5
  for map in whole/probability/*.tif; do
    cmp "$map" "out/probability/${map##*/}" || fail "$map differs"
    maps=$((maps + 1))
  done
  [[ $maps -ge 10 ]] || fail "there are only $maps maps"
}

run_test "$@"
