#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# The site of documents: made without a warning, complete, and searched in Chromium from file://.
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

# Those of the distribution, whatever Python comes first in PATH.
python=/usr/bin/python3
need_sphinx() {
  "$python" -c 'import sphinx, myst_parser, furo' 2>/dev/null && return
  [[ -z ${TALUS_REQUIRE_TOOLS:-} ]] ||
    fail "Sphinx, MyST or Furo is missing, but TALUS_REQUIRE_TOOLS is set (make setup-tests installs them)"
  skip "Sphinx, MyST or Furo is not installed (make setup-tests installs them)"
}

make_site() {
  need_sphinx
  expect_exit 0 "$python" "$TALUS_SOURCE/tools/make-site.py" --out "$TALUS_SCRATCH/site" --bin "$bin" "$@"
  html=$TALUS_SCRATCH/site/html
  [[ $(<"$TALUS_SCRATCH/stdout") == "$html/index.html" ]] || fail "stdout does not name the first page"
}

# What a reader looks for: keys with default and meaning, options of each program, the four parts; and a search that
# finds words of prose, of keys and of options from file://, without one request that leaves the folder.
test_site_holds_keys_and_options_and_its_search_works_from_files() {
  make_site
  local page
  for page in tutorials/index how-to/index reference/index explanation/index explanation/theory reference/keys-solve \
    reference/keys-preprocess reference/keys-postprocess reference/talus reference/talus-solve; do
    [[ -s $html/docs/$page.html ]] || fail "the site has no page docs/$page.html"
  done
  grep -q 'youngs_modulus_Pa' "$html/docs/reference/keys-solve.html" || fail "a key of [solve.material] is missing"
  grep -q -- '--restart' "$html/docs/reference/talus-solve.html" || fail "an option of talus-solve is missing"
  need_browser
  "$python" "$TALUS_SOURCE/tests/documents/site_browser.py" "$html" || fail "the browser test failed"
}

# A link of the pages that leads nowhere, and a program that is not there, end the making with a message.
test_a_program_that_is_missing_is_named() {
  need_sphinx
  expect_exit 1 "$python" "$TALUS_SOURCE/tools/make-site.py" --out "$TALUS_SCRATCH/site" --bin "$TALUS_SCRATCH"
  expect_words "talus-preprocess was not found" "make build"
}

run_test "$@"
