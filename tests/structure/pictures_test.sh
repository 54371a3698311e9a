#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Pictures of the documents are those of what they are made of (tools/make-pictures.py).
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

test_no_picture_is_stale() {
  expect_exit 0 python3 "$TALUS_SOURCE/tools/make-pictures.py" --check
  grep -qE '^[1-9][0-9]+ pictures' stdout || fail "fewer than ten pictures were looked at: $(cat stdout)"
}

# The test itself: a recipe that has changed since, a picture that nobody lists, a picture that is gone.
test_a_stale_picture_is_named() {
  mkdir -p tree/docs/pictures tree/tools
  cp "$TALUS_SOURCE/tools/make-pictures.py" tree/tools
  echo 'h = 1' >tree/recipe.toml
  touch tree/docs/pictures/a.png tree/docs/pictures/b.png
  echo '{"a.png": {"by": "scene a", "from": ["recipe.toml"], "stamp": "0123"}, "c.png": {"by": "", "from": [],
    "stamp": ""}}' >tree/docs/pictures/pictures.json
  expect_exit 1 python3 tree/tools/make-pictures.py --check
  expect_words 'docs/pictures/a.png is stale: one of recipe.toml has changed' 'make pictures PICTURES=a.png' \
    'docs/pictures/b.png has no entry' 'docs/pictures/c.png is missing'
}

run_test "$@"
