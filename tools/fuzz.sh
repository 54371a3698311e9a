#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Builds the fuzz targets (tests/fuzz) with clang and lets libFuzzer run each for some seconds, from the inputs in
# tests/fuzz/corpus. What ends a target lies in build-fuzz/findings/TARGET; copy it to tests/fuzz/corpus/TARGET once
# mended, where an ordinary test replays it. One line for each target on stdout.
# usage: tools/fuzz.sh SECONDS [TARGET...]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
seconds=${1:?usage: tools/fuzz.sh SECONDS [TARGET...]}
shift
targets=("$@")
[[ ${#targets[@]} -gt 0 ]] || mapfile -t targets < <(ls tests/fuzz/corpus)

[[ -f build-fuzz/build.ninja ]] || cmake --preset fuzz >/dev/null
cmake --build build-fuzz -j "${JOBS:-$(nproc)}" --target "${targets[@]/#/talus-fuzz-}"

failed=0
for target in "${targets[@]}"; do
  findings=$PWD/build-fuzz/findings/$target
  seen=$PWD/build-fuzz/seen/$target   # inputs that reached something new, kept from run to run
  mkdir -p "$findings" "$seen"
  rm -f "$findings"/*
  leaks=1
  options=(-max_total_time="$seconds" -timeout=20 -rss_limit_mb=4096 -max_len=262144 -artifact_prefix="$findings/")
  # Where a library reads the bytes first, its crashes are its own (programs read such files in a child): count, go on.
  # What OpenVDB leaves behind when it throws would end every job; the child gives it back when it ends.
  case $target in
    run | checkpoint | counts | members | domain | level_set)
      leaks=0
      options+=(-fork=1 -ignore_crashes=1 -ignore_timeouts=1 -ignore_ooms=1) ;;
  esac
  ASAN_OPTIONS=detect_leaks=$leaks build-fuzz/bin/talus-fuzz-"$target" "${options[@]}" "$seen" \
    tests/fuzz/corpus/"$target" >"build-fuzz/$target.log" 2>&1 || failed=1
  runs=$(grep -oE '^#[0-9]+' "build-fuzz/$target.log" | tail -n 1 | tr -d '#' || true)
  printf '%-20s %10s inputs in %s s, %s findings (%s)\n' "$target" "${runs:-0}" "$seconds" \
    "$(find "$findings" -type f | wc -l)" "$findings"
done
exit $failed
