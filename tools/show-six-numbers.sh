#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# The six numbers by which a run is first judged, from its score.txt.
# usage: tools/show-six-numbers.sh SCORE.txt
set -euo pipefail
score=${1:?usage: tools/show-six-numbers.sh SCORE.txt}
wanted=('released' 'run-out L, straight' 'H/L' 'largest peak speed' 'thickest deposit' 'deposit CSI')
for name in "${wanted[@]}"; do
  line=$(grep -m 1 -E "^  $name {2,}" "$score" || echo 'not scored')
  case $name in
    released) shown='released volume' ;;
    'deposit CSI') shown='deposit CSI (overlap with the survey; 1 = the same)' ;;
    *) shown=$name ;;
  esac
  printf '  %-52s %s\n' "$shown" "$(sed -E "s|^ +$name +||" <<<"$line")"
done
