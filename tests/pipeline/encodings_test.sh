#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Names in encodings other than UTF-8: whatever reads them, every result is UTF-8.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

# in_latin1 FILE: the marks AA, BB, CC and DD of a file become o, u and a with two dots and the euro sign of CP1252.
in_latin1() { LC_ALL=C sed -i 's/AA/\xf6/g; s/BB/\xfc/g; s/CC/\xe4/g; s/DD/\x80/g' "$1"; }

# encoded_scene FORMAT: the bowl with a release, a section and a building from areas.FORMAT and lines.csv, whose names
# are in CP1252. FORMAT: shp (without .cpg), geojson, gpkg, csv.
encoded_scene() {
  need_tool ogr2ogr
  scene
  rm -rf out areas.* lines.csv
  local area='"POLYGON((500030 5000080,500070 5000080,500070 5000120,500030 5000120,500030 5000080))"'
  printf 'WKT,name,grBBAAsse\n%s,HAAlle,4\n' "$area" >areas.csv
  printf 'WKT,name\n"LINESTRING(500080 5000020,500080 5000180)",BCCche DD\n' >lines.csv
  case $1 in
    csv) in_latin1 areas.csv ;;
    geojson) ogr2ogr -q -oo AUTODETECT_TYPE=YES areas.geojson areas.csv && in_latin1 areas.geojson ;;
    shp)
      ogr2ogr -q -oo AUTODETECT_TYPE=YES -lco ENCODING= areas.shp areas.csv
      # two letters became one byte: names and values of a table have fixed widths
      LC_ALL=C sed -i 's/HAAlle/H\xf6lle /; s/grBBAAsse/gr\xfc\xf6sse\x00\x00/' areas.dbf
      printf '\0' | dd of=areas.dbf bs=1 seek=29 conv=notrunc status=none
      ;;
    gpkg)
      encoded_scene shp
      ogr2ogr -q areas.gpkg areas.shp
      scene # a recipe of its own
      ;;
  esac
  in_latin1 lines.csv
  sed -i '/after_dem/d; s/before_dem/base_dem/' recipe.toml
  cat >>recipe.toml <<TOML

[[preprocess.release]]
polygons = "areas.$1|subset=name = 'Hölle'"
thickness_m = 4.0

[[preprocess.place]]
name = "lines"
file = "lines.csv"

[[solve.section]]
place = "lines"

[postprocess.buildings]
polygons = "areas.$1"
TOML
}

# texts FILE: the text in a result.
texts() {
  case $1 in
    *.csv | *.html | *.json | *.qgs | *.qml | *.toml | *.txt | *.vtp | *.pvd) sed 's/_<AppendedData.*//' "$1" ;;
    *.nc) ncdump -h "$1" ;;
    *.h5) h5dump -A "$1" ;;
    *.gpkg) ogrinfo -al -q "$1" 2>/dev/null ;;
    *.tif) gdalinfo "$1" ;;
  esac
}

expect_utf8_results() {
  local file
  while read -r file; do
    [[ $file == *.vtp ]] && continue # its data are bytes
    texts "$file" >text || fail "$file cannot be read"
    iconv -f UTF-8 -t UTF-8 text >/dev/null || fail "$file is not UTF-8"
  done < <(find out -type f)
}

test_names_in_cp1252_become_utf8_in_every_result() {
  local format
  for format in shp geojson gpkg csv; do
    encoded_scene $format
    expect_exit 0 preprocess
    expect_words "areas.$format: its text is not UTF-8 and is taken as CP1252"
    expect_words "lines.csv: its text is not UTF-8"
    expect_exit 0 solve
    expect_words 'section B-che'
    expect_exit 0 postprocess
    grep -q '^Hölle,' out/buildings.csv || fail "$format: the building is called $(<out/buildings.csv)"
    expect_utf8_results
  done
}

test_slides_of_a_declared_and_an_undeclared_encoding() {
  local codes=('' CP1252 CP1250) code
  for code in "${codes[@]}"; do
    encoded_scene shp
    [[ -n $code ]] && echo "$code" >areas.cpg
    sed -i '/^\[\[preprocess.release/,$d' recipe.toml
    cat >>recipe.toml <<'TOML'
[slides]
outlines = "areas.shp"
name_from = "name"
margin_m = 50.0
[[slides.set]]
key = "preprocess.release[0].thickness_m"
attribute = "grüösse"
TOML
    expect_exit 0 "$bin/talus" run recipe.toml
    grep -q ',Hölle,' out/slides.csv || fail "$code: $(<out/slides.csv)"
    [[ -z $code ]] || ! grep -q 'not UTF-8' "$TALUS_SCRATCH/stderr" || fail "a declared encoding is not taken as it is"
    expect_utf8_results
  done
}

test_utf16_is_refused_with_the_command_that_converts_it() {
  local as bytes
  for as in UTF-16 UTF-16LE UTF-16BE UTF-32; do
    encoded_scene csv
    iconv -f CP1252 -t $as areas.csv >wide.csv
    sed -i 's/areas.csv|subset=[^"]*/wide.csv/; s/areas.csv/wide.csv/' recipe.toml
    expect_exit 3 preprocess
    expect_words "wide.csv: its text is $as"
    bytes=$(grep -o 'iconv -f [^>]*> [^ ]*\.csv' "$TALUS_SCRATCH/stderr") || fail "no command"
    bash -c "$bytes" || fail "the command does not work: $bytes"
    sed -i 's/wide.csv/wide-utf8.csv/' recipe.toml
    expect_exit 0 preprocess
  done
}

test_a_recipe_or_a_folder_in_another_encoding_is_refused() {
  scene
  sed -i 's/"Bowl"/"Bäche"/' recipe.toml
  local as folder
  for as in CP1252 UTF-16 UTF-16BE; do
    iconv -f UTF-8 -t $as recipe.toml >other.toml
    expect_exit 2 "$bin/talus-preprocess" other.toml --check
    expect_words "the recipe is not UTF-8"
    expect_words "iconv -f $as -t UTF-8 other.toml > other-utf8.toml"
    bash -c "$(grep -o 'iconv -f .*toml' "$TALUS_SCRATCH/stderr")" || fail "the command does not work"
    cmp other-utf8.toml recipe.toml || fail "the command makes another recipe"
  done
  folder=$(printf 'H\xf6lle')
  expect_exit 2 "$bin/talus-preprocess" recipe.toml --out "$folder"
  expect_words "Hölle: the name of this file or of a folder above it is not UTF-8"
  mkdir "$folder" && cp ./*.asc recipe.toml "$folder"
  expect_exit 2 "$bin/talus-preprocess" "$folder/recipe.toml" --check
  expect_words "not UTF-8"
}

run_test "$@"
