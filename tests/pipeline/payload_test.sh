#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Names that would run, close or climb if anything took them for more than text: in titles, releases, surveys, files and
# coordinate systems, on the page in a real browser, in maps, styles and tables.
source "$(dirname "${BASH_SOURCE[0]}")/hostile_scene.sh"

test_is_made() { hostile_scene; }
hostile() { made && cd in*; }

test_nothing_of_them_runs_on_the_page() {
  need_browser
  hostile
  mkdir -p "$TALUS_SCRATCH/page"
  cp out/report.html "$TALUS_SCRATCH/page/"
  TITLE=$title INSTITUTION="$image $shell" expect_exit 0 /usr/bin/python3 \
    "$TALUS_SOURCE/tests/pipeline/report_browser.py" "$TALUS_SCRATCH/page" payload
}

# opened PAGE WORDS...: a page of results, used in a browser as a person would; it says the words as text.
opened() {
  local page=$1
  shift
  mkdir -p "$TALUS_SCRATCH/page"
  cp "$page" "$TALUS_SCRATCH/page/"
  expect_exit 0 /usr/bin/python3 "$TALUS_SOURCE/tests/pipeline/payload_browser.py" \
    "$TALUS_SCRATCH/page/${page##*/}" "$@"
}

test_nothing_of_them_runs_on_the_page_of_an_ensemble() {
  need_browser
  hostile_ensemble
  opened out/ensemble.html "$title" "$image"
}

test_nothing_of_them_runs_on_the_page_of_slides() {
  need_browser
  hostile_slides
  opened out/slides.html "$title" "../../$script" "$image"
}

test_nothing_of_them_runs_on_the_page_of_a_comparison() {
  need_browser
  hostile
  local other="$image\"'&<svg onload=window.pwned=1>"
  sed -i "s|^friction_angle_deg.*||; s|^institution.*|institution = $(quoted "<iframe src=x>$image")|" recipe.toml
  expect_exit 0 "$bin/talus-preprocess" recipe.toml --out "$other"
  expect_exit 0 "$bin/talus-solve" recipe.toml --out "$other" --on cpu
  expect_exit 0 "$bin/talus-postprocess" recipe.toml --out "$other"
  expect_exit 0 postprocess --against "$other"
  opened out/comparison.html "$title" "$other" "<iframe src=x>$image"
}

test_the_page_holds_no_path_of_this_machine() {
  hostile
  sed -n 's/.*id="data">\(.*\)<\/script>.*/\1/p' out/report.html >data.json
  [[ -s data.json ]] || fail "the page holds no data"
  ! grep -qF "${is_made%/*}" out/report.html || fail "the page names $is_made"
  ! grep -qE '"(/|[^"]* /)(home|tmp|root|work|usr|build)/' data.json || fail "the page holds an absolute path"
  ! grep -q "unsafe-" out/report.html || fail "the page allows inline scripts or styles"
}

test_nothing_is_written_outside_the_output_folder() {
  (cd "$TALUS_SCRATCH" && find . -type f | sort >"$TALUS_SCRATCH.before")
  hostile_scene
  cd "$TALUS_SCRATCH"
  find . -name '*pwned*' -newer "$TALUS_SCRATCH.before" | grep -v -e "^./in" -e '.asc$' -e '.prj$' >found || true
  [[ ! -s found ]] || fail "something ran: $(<found)"
  # The scene's own files, and what this test writes.
  find . -type f -newer "$TALUS_SCRATCH.before" | grep -vE '^\./(before|after|survey)\.asc$|^\./recipe.toml$' |
    grep -vE '^\./std(out|err)$|^\./found$' | grep -vE "^\./in <b>&'\"x/(out/|[^/]*$)" >found || true
  [[ ! -s found ]] || fail "written outside --out: $(<found)"
  rm -f "$TALUS_SCRATCH.before"
}

test_styles_and_projects_are_well_formed_and_say_the_names_as_text() {
  hostile
  /usr/bin/python3 - "$title" <<'PYTHON' || fail "styles, projects, maps or tables are not as they should be"
import csv, pathlib, sys, xml.etree.ElementTree as tree
from osgeo import gdal
gdal.UseExceptions()
files = [f for f in pathlib.Path("out").rglob("*") if f.suffix in (".qgs", ".qml")]
assert len(files) > 5, files
texts = [text for f in files for text in tree.parse(f).getroot().itertext()]
attributes = [v for f in files for node in tree.parse(f).getroot().iter() for v in node.attrib.values()]
assert any(sys.argv[1] in text for text in texts + attributes), "the title does not stand in the project"
for map in pathlib.Path("out/maps").glob("*.tif"):
    assert gdal.Open(str(map)).GetMetadata()["TITLE"] == sys.argv[1], f"{map} does not say its title as it is"
assert len({len(row) for row in csv.reader(open("out/history.csv"))}) == 1, "history.csv has rows of several lengths"
PYTHON
  [[ $(ls out/maps/deposit_thickness_*.tif | wc -l) -eq 2 ]] || fail "there are not two deposits: $(ls out/maps)"
  ogrinfo -al -q out/maps/outlines.gpkg >outlines
  grep -qF "$image" outlines || fail "outlines.gpkg does not say the survey's name as it is"
}

run_test "$@"
