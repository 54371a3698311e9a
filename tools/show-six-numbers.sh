#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# The six numbers by which a run is first judged, from its score.txt.
# usage: tools/show-six-numbers.sh SCORE.txt
set -euo pipefail
score=${1:?usage: tools/show-six-numbers.sh SCORE.txt}
wanted=('released' 'run-out L, straight' 'H/L' 'largest peak speed' 'thickest deposit' 'deposit CSI')
for name in "${wanted[@]}"; do
  line=$(grep -m 1 -E "^  $name(, (to )?> [0-9.]+ m)? {2,}" "$score" || echo "  $name  not scored")
  shown=$(sed -E 's|^ +||; s| {2,}.*||' <<<"$line")
  if [[ $name == 'deposit CSI' ]]; then shown+=' (overlap; 1 = the same)'; fi
  printf '  %-58s %s\n' "$shown" "$(sed -E 's|^ +.* {2,}||' <<<"$line")"
done
