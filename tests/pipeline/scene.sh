# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# A small scene for the tests of this folder: a bowl of 20 x 20 cells of 10 m in which a block of 4 x 4 cells, 4 m
# thick, fails.
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

# grid FILE EXPRESSION [WEST]: an ESRI ASCII grid of 20 x 20 cells of 10 m; EXPRESSION in awk's language, of the cell
# centre x, y [m from the grid's corner], column i and row j (row 0 southernmost).
grid() {
  awk -v west="${3:-500000}" "BEGIN {
    printf \"ncols 20\nnrows 20\nxllcorner %d\nyllcorner 5000000\ncellsize 10\nNODATA_value -9999\n\", west
    for (j = 19; j >= 0; --j) for (i = 0; i < 20; ++i) {
      x = 10 * i + 5; y = 10 * j + 5
      printf \"%s%s\", $2, i == 19 ? \"\n\" : \" \"
    }
  }" >"$1"
}

bowl='0.004 * ((x - 100)^2 + (y - 100)^2)'
in_source='(i >= 3 && i < 7 && j >= 8 && j < 12)'
in_deposit='(i >= 7 && i < 11 && j >= 8 && j < 12)'

# scene: before.asc, after.asc, survey.asc and recipe.toml in the current folder. It runs in about a second.
scene() {
  grid before.asc "$bowl"
  grid after.asc "$bowl - 4 * $in_source + 3 * $in_deposit"
  grid survey.asc "2 * $in_deposit"
  cat >recipe.toml <<'TOML'
[scene]
name = "bowl"
title = "Bowl"

[preprocess]
before_dem = "before.asc"
after_dem = "after.asc"

[preprocess.grid]
layer_height_m = 2.0

[solve]
end_time_s = 3.0

[solve.material]
friction_angle_deg = 30.0

[solve.base]
friction_angle_deg = 15.0

[postprocess.survey]
thickness = "survey.asc"
TOML
}

preprocess() { "$bin/talus-preprocess" recipe.toml --out out "$@"; }
solve() { "$bin/talus-solve" recipe.toml --out out --on cpu "$@"; }
postprocess() { "$bin/talus-postprocess" recipe.toml --out out "$@"; }

# interrupt SIGNAL PATTERN COMMAND...: start it, wait until a file of this pattern is there, send the signal, and expect
# exit code 130 (137 after KILL).
# Shells start background work with SIGINT ignored, hence env --default-signal.
interrupt() {
  local signal=$1 sign=$2 code=0
  shift 2
  env --default-signal=INT,TERM "$@" >stdout 2>stderr </dev/null &
  local process=$!
  while ! compgen -G "$sign" >/dev/null; do
    kill -0 $process 2>/dev/null || fail "it ended by itself before $sign was there: $*"
    sleep 0.02
  done
  kill -"$signal" $process 2>/dev/null || fail "it ended by itself before the signal: $*"
  wait $process || code=$?
  local expected=130
  [[ $signal != KILL ]] || expected=137
  [[ $code -eq $expected ]] || fail "exit code $code instead of $expected after SIG$signal"
}

# make_checkpoint DIR: preprocess into DIR and leave a checkpoint there, some 5 s into a run of 100 s.
make_checkpoint() {
  sed -i 's/^end_time_s.*/end_time_s = 100.0\ncheckpoint_interval_s = 5.0/' recipe.toml
  expect_exit 0 "$bin/talus-preprocess" recipe.toml --out "$1"
  interrupt INT "$1/checkpoint.h5" "$bin/talus-solve" recipe.toml --out "$1" --on cpu
}

# with_mounts COMMAND...: run it where it may mount (its own mount namespace; as root, or as root of a user namespace).
with_mounts() {
  if [[ $(id -u) -eq 0 ]]; then unshare --mount "$@"; else unshare --user --map-root-user --mount "$@"; fi
}

# Skips aloud where neither is allowed.
need_mounts() {
  mkdir -p mount_trial
  with_mounts mount -t tmpfs -o size=64k tmpfs mount_trial 2>/dev/null ||
    skip "this machine does not let the test mount a small disk"
}

# scene_of_members COUNT: the scene as an ensemble of so many members that differ in the friction of the bed.
scene_of_members() {
  scene
  cat >>recipe.toml <<TOML

[ensemble]
members = $1

[[ensemble.vary]]
key = "solve.base.friction_angle_deg"
low = 10.0
high = 20.0
TOML
}

# same_counts A B...: the counts of A are those of the other files together.
same_counts() {
  /usr/bin/python3 - "$@" <<'PYTHON' || fail "the counts of $1 are not those of ${*:2}"
import sys
import h5py
import numpy as np

whole, parts = h5py.File(sys.argv[1]), [h5py.File(name) for name in sys.argv[2:]]
compared = 0
for name, group in whole["maps"].items():
    fields = ["reached", "sum", "sum_of_squares"] + ["exceeded/" + n for n in group["exceeded"]]
    for field in fields:
        total = sum(part[f"maps/{name}/{field}"][()].astype(np.int64) for part in parts)
        if not np.array_equal(group[field][()], total):
            sys.exit(f"{name}/{field} differs in {np.sum(group[field][()] != total)} cells")
        compared += int(np.sum(total))
if compared == 0:
    sys.exit("nothing was counted")
PYTHON
}
