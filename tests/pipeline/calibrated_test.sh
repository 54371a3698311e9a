#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# A slide whose friction is known is calibrated on cells twice as large: the interval holds the truth.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

test_the_calibrated_valley_holds_the_truth() {
  mkdir tree
  cp -r "$TALUS_SOURCE/pipelines" tree/pipelines
  ln -s "$TALUS_SOURCE/data_samples" tree/data_samples
  expect_exit 0 make -C tree/pipelines synthetic-valley-calibrated OUT="$PWD/out" BIN="$TALUS_BUILD/bin" ON=cpu
  [[ -s tree/pipelines/synthetic-valley-calibrated/fitted.toml ]] || fail "there is no fitted.toml"
  python3 - out/synthetic-valley-calibrated/calibration.json <<'PYTHON' || fail "the interval is not what was expected"
import json, sys
friction, thickness = json.load(open(sys.argv[1]))["summary"]["keys"]
low, median, high = friction["after"]
assert low < 20 < high and high - low < 2, friction
assert 1.05 < thickness["after"][1] < 1.45 and thickness["left"] < 0.6, thickness
PYTHON
  grep -q '"calibration":{"prior":' out/synthetic-valley-calibrated/ensemble.html || fail "the page shows no posterior"
  [[ -s out/synthetic-valley-calibrated/probability/residual_sigma.tif ]] || fail "there is no map of residuals"
}

run_test "$@"
