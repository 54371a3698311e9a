#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# The QGIS plugin without QGIS: what it reads of a run, how it runs and ends the command, and its zip file.
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

test_parts_that_need_no_qgis() {
  PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=$TALUS_SOURCE/qgis TALUS_BIN=$bin \
    expect_exit 0 /usr/bin/python3 "$TALUS_SOURCE/tests/qgis/parts_test.py" -v
}

test_zip_is_the_same_twice_and_holds_what_qgis_asks_for() {
  expect_exit 0 "$TALUS_SOURCE/tools/make-qgis-plugin.py" --version 1.2.3 --to a.zip
  expect_exit 0 "$TALUS_SOURCE/tools/make-qgis-plugin.py" --version 1.2.3 --to b.zip
  cmp a.zip b.zip || fail "the same sources give another zip file"
  /usr/bin/python3 -c 'import zipfile; zipfile.ZipFile("a.zip").extractall(".")'
  local name
  for name in __init__.py metadata.txt plugin.py provider.py icon.svg LICENSE algorithms/run_recipe.py; do
    [[ -s talus_provider/$name ]] || fail "the zip file holds no $name"
  done
  grep -qx 'version=1.2.3' talus_provider/metadata.txt || fail "the version is not filled in"
  find . -name '*.pyc' | grep -q . && fail "compiled files are in it"
  for name in name qgisMinimumVersion description about author category hasProcessingProvider; do
    /usr/bin/python3 -c 'import configparser, sys
c = configparser.ConfigParser()
c.read("talus_provider/metadata.txt")
assert c["general"][sys.argv[1]].strip()' "$name" || fail "metadata.txt has no $name"
  done
}

run_test "$@"
