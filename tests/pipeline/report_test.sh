#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# report.html in a real browser: what it shows, what happens when it is clicked, and what comes out of its printer.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

# The small scene with its three stages run; the report is out/report.html.
test_is_made() {
  scene
  sed -i 's/^end_time_s.*/end_time_s = 3.0\nframe_interval_s = 0.5/' recipe.toml
  echo 'sigma_m = 0.2' >>recipe.toml   # of the survey: scores get a spread
  printf '[[solve.gauge]]\nname = "%s"\nat_m = [%s, 5000100.0]\n' source 500050.0 below 500090.0 >>recipe.toml
  expect_exit 0 preprocess
  expect_exit 0 solve
  expect_exit 0 postprocess
  [[ -f out/report.html ]] || fail "there is no out/report.html"
}

browse() { expect_exit 0 /usr/bin/python3 "$TALUS_SOURCE/tests/pipeline/report_browser.py" "$PWD/out" "$@"; }

test_opens_and_answers_to_clicks_in_a_browser() {
  need_browser
  made
  browse clicks
}

test_stands_without_its_view_in_3d_where_there_is_no_webgl() {
  need_browser
  made
  browse flat
}

test_leaves_its_view_in_3d_out_on_request() {
  made
  sed -i 's/^\[postprocess.survey\]/[postprocess]\noutputs = ["report"]\n\n&/' recipe.toml
  expect_exit 0 postprocess
  grep -q '"relief":false' out/report.html || fail "the page is to draw the view all the same"
}

# Nothing is too wide in any window, nor on paper.
test_fits_desktop_tablet_phone_and_paper() {
  need_browser
  made
  cp -r out other
  "$bin/talus-solve" recipe.toml --out other --on cpu --set solve.base.friction_angle_deg=9 2>/dev/null >stdout ||
    fail "no second run"
  "$bin/talus-postprocess" recipe.toml --out other --set solve.base.friction_angle_deg=9 >stdout 2>stderr ||
    fail "no second results"
  expect_exit 0 "$bin/talus" compare out other
  expect_exit 0 /usr/bin/python3 "$TALUS_SOURCE/tests/pipeline/page_widths.py" out/report.html out/comparison.html
  local page
  for page in report comparison; do
    expect_exit 0 pdftotext -bbox "out/$page.pdf" words.html
    awk -F'"' '/<page /  { width = $2 }
      /<word /  { ++count; if ($2 < 20 || $6 > width - 20) { print "beyond the margin on paper: " $0; bad = 1 } }
      END { exit bad || count < 100 }' words.html >beyond || fail "$page.html: $(head -5 beyond)"
  done
}

test_prints_to_a_pdf_with_all_its_maps() {
  need_browser
  need_tool pdfinfo
  made
  browse prints
  expect_exit 0 pdfinfo out/report.pdf
  local pages
  pages=$(sed -n 's/^Pages: *//p' stdout)
  [[ $pages -ge 4 && $pages -le 16 ]] || fail "the report prints on $pages pages instead of 4 to 16"
  grep -q '^Page size: .*A4' stdout || fail "the pages are not A4"
  expect_exit 0 pdftotext out/report.pdf -
  local words
  for words in 'Bowl' 'In three dimensions' 'Peak speed' 'Arrival time' 'Deposit CSI' 'SHA-256' 'How to cite'; do
    grep -qF "$words" stdout || fail "the printed report does not say: $words"
  done
}

# From the recipe to the history, and from there to the page; the rest is the browser's (series-thickness).
test_has_a_curve_for_each_gauge() {
  made
  local gauge column
  for gauge in source below; do
    for column in thickness_m speed_m_s surface_m; do
      head -1 out/history.csv | grep -qE "(^|,)gauge_${gauge}_$column(,|$)" ||
        fail "history.csv has no gauge_${gauge}_$column"
    done
    column="\"name\":\"gauge_${gauge}_thickness_m\",\"unit\":\"m\""
    grep -qF "{$column,\"quantity\":\"thickness\",\"place\":\"gauge $gauge\"}" out/report.html ||
      fail "the page does not know what gauge_${gauge}_thickness_m is"
  done
  # The block of 4 m starts under the first gauge; the bed there is 4 m below the bowl.
  awk -F, 'NR == 1 { for (c = 1; c <= NF; ++c) at[$c] = c; next }
    NR == 2 { h = $at["gauge_source_thickness_m"]; z = $at["gauge_source_surface_m"]; v = $at["gauge_below_thickness_m"]
      exit !(h > 3.9 && h < 4.1 && z - h > 5.9 && z - h < 6.4 && v < 0.1) }' out/history.csv ||
    fail "the gauges do not read the block at rest: $(head -2 out/history.csv)"
}

test_refuses_a_gauge_outside_the_domain() {
  scene
  printf '[[solve.gauge]]\nname = "far"\nat_m = [1.0, 2.0]\n' >>recipe.toml
  expect_exit 0 preprocess
  expect_exit 2 solve --check
  expect_words 'name = "far": (1, 2) lies outside the domain' 'Choose x from 500005'
}

# Neither address nor file beside it: the page must hold all it needs.
test_names_nothing_outside_itself() {
  made
  local report=out/report.html found
  grep -q "default-src 'none'" "$report" || fail "the page does not forbid its own requests"
  # The libraries' scripts hold links as text; what the page itself is made of must have none.
  found=$(sed '/^<script>/,/<\/script>/d' "$report" | grep -oE '(src|href|action|data)="[^"#][^"]*"' || true)
  [[ -z $found ]] || fail "the page refers to something outside itself: $found"
  found=$(grep -oE 'url\([^)]*\)|@import|sourceMappingURL[^ ]*' "$report" | grep -vE 'url\((#|["'"'"']?data:)' || true)
  [[ -z $found ]] || fail "the page's styles or scripts load something: $found"
  [[ $(stat -c %s "$report") -lt 2000000 ]] || fail "a report of 20 x 20 cells takes $(stat -c %s "$report") bytes"
}

test_says_which_stage_left_nothing_about_itself() {
  made
  rm out/preprocess.used.toml
  expect_exit 0 postprocess
  grep -q '"stage":"preprocess","missing":true' out/report.html ||
    fail "the report does not say that preprocess.used.toml is missing"
  grep -q '"stage":"solve","missing":false' out/report.html || fail "the report does not see solve.used.toml"
}

test_is_left_out_on_request() {
  made
  sed -i 's/^\[postprocess.survey\]/[postprocess]\noutputs = []\n\n&/' recipe.toml
  expect_exit 0 postprocess
  [[ ! -e out/report.html ]] || fail "not asked for, but the report of the run before is still there"
}

# frames FILE: how many there are, and how long they take.
frames() {
  expect_exit 0 ffprobe -v error -count_frames -select_streams v:0 -show_entries stream=nb_read_frames,duration \
    -of default=nw=1 "$1"
}

test_animation_has_every_frame_and_lingers_on_the_last() {
  need_tool ffmpeg
  need_tool ffprobe
  made
  local kind
  for kind in mp4 gif; do
    sed -i '/^outputs/d; /^\[postprocess\]$/d' recipe.toml
    sed -i "s/^\[postprocess.survey\]/[postprocess]\noutputs = [\"$kind\"]\n\n&/" recipe.toml
    expect_exit 0 postprocess
    grep -q "animation.$kind\$" stdout || fail "animation.$kind is not among the results"
    frames "out/animation.$kind"
    # 7 frames (0 to 3 s), two a second, and the last for two seconds more: 11 pictures, 5.5 s.
    grep -qx 'nb_read_frames=11' stdout || fail "animation.$kind: $(cat stdout)"
    grep -q '^duration=5.5' stdout || fail "animation.$kind: $(cat stdout)"
  done
  [[ ! -e out/animation.mp4 ]] || fail "the film of the run before is still there"
}

test_animation_asks_for_ffmpeg_where_it_is_missing() {
  made
  sed -i 's/^\[postprocess.survey\]/[postprocess]\noutputs = ["mp4"]\n\n&/' recipe.toml
  mkdir none
  PATH=$PWD/none expect_exit 3 postprocess
  expect_words 'ffmpeg was not found' 'apt-get install ffmpeg'
}

run_test "$@"
