#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# What is said of input that cannot be taken: it names the file, quotes the value, and its command works.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

# ground RECIPE-LINE...: the bowl as base_dem, and what these lines release on it.
ground() {
  scene
  sed -i '/after_dem/d; s/before_dem/base_dem/; /postprocess/,$d' recipe.toml
  printf '%s\n' '' "$@" >>recipe.toml
}

# mended PATTERN: runs the command of this pattern that the message gives.
mended() {
  local command
  command=$(grep -o "$1" "$TALUS_SCRATCH/stderr" | head -n 1) || fail "no command $1"
  bash -c "$command" >/dev/null || fail "the command does not work: $command"
}

test_a_release_with_a_crs_on_a_model_without_names_the_model() {
  need_tool gdalsrsinfo
  ground '[[preprocess.release]]' 'thickness_raster = "thick.tif"'
  grid thick.asc "4 * $in_source"
  gdal_translate -q -a_srs EPSG:32611 thick.asc thick.tif
  expect_exit 3 preprocess --check
  expect_words "before.asc: has no CRS, while that of thick.tif is EPSG:32611"
  mended 'gdalsrsinfo.*'
  expect_exit 0 preprocess --check
  # a CRS without a code is taken from the file that names it
  gdal_translate -q -a_srs '+proj=tmerc +lon_0=10.5 +k=1 +x_0=500000 +ellps=GRS80 +units=m' thick.asc thick.tif
  rm before.prj
  expect_exit 3 preprocess --check
  mended 'gdalsrsinfo.*'
  expect_exit 0 preprocess --check
}

test_rasters_of_the_bed_name_the_model_too() {
  ground '[[preprocess.release]]' 'thickness_raster = "thick.asc"' '[[preprocess.bed.raster]]' \
    'number = "cohesion_Pa"' 'file = "bed.tif"'
  grid thick.asc "4 * $in_source"
  grid bed.asc 100
  gdal_translate -q -a_srs EPSG:32611 bed.asc bed.tif
  expect_exit 3 preprocess
  expect_words "before.asc: has no CRS, while that of bed.tif is EPSG:32611"
}

test_local_coordinates_are_as_none() {
  need_tool gdal_edit.py
  scene
  gdal_translate -q -a_srs EPSG:32611 before.asc before.tif
  gdal_translate -q -a_srs 'LOCAL_CS["Site",UNIT["metre",1]]' after.asc after.tif
  sed -i 's/before.asc/before.tif/; s/after.asc/after.tif/; /postprocess/,$d' recipe.toml
  expect_exit 3 preprocess --check
  expect_words "after.tif: has no CRS, while that of before.tif is EPSG:32611"
  mended 'gdal_edit.py.*'
  expect_exit 0 preprocess --check
}

test_a_text_in_place_of_a_number_is_quoted() {
  need_tool ogr2ogr
  ground '[[preprocess.release]]' 'polygons = "areas.geojson"'
  local value ring='500030 5000080,500070 5000080,500070 5000120,500030 5000120,500030 5000080'
  for value in '5,5' '4 m' 'drei'; do
    printf 'WKT,thickness\n"POLYGON((%s))","%s"\n' "$ring" "$value" >areas.csv
    rm -f areas.geojson
    ogr2ogr -q areas.geojson areas.csv
    expect_exit 3 preprocess --check
    expect_words "areas.geojson: feature 1: thickness = \"$value\" (it is a text and no number"
  done
}

test_files_of_other_kinds_say_what_they_are() {
  ground '[[preprocess.release]]' 'thickness_raster = "thick.asc"'
  grid thick.asc "4 * $in_source"
  mv before.asc kept.asc
  printf 'LASF%0400d' 0 >before.asc
  expect_exit 3 preprocess --check
  expect_words "before.asc: a point cloud (LAS or LAZ)" "pdal translate before.asc before.tif filters.range"
  gzip -c kept.asc >before.asc.gz
  sed -i 's/before.asc/before.asc.gz/' recipe.toml
  rm before.asc
  expect_exit 3 preprocess --check
  expect_words "before.asc.gz: packed by gzip"
  mended 'gunzip -k [^)]*'
  sed -i 's/before.asc.gz/before.asc/' recipe.toml
  expect_exit 0 preprocess --check
  /usr/bin/python3 -c 'import zipfile; zipfile.ZipFile("model.zip", "w").write("kept.asc")'
  sed -i 's/before.asc/model.zip/' recipe.toml
  expect_exit 3 preprocess --check
  expect_words "model.zip: a ZIP archive" "unzip model.zip"
}

test_a_topography_of_geoclaw_is_read() {
  ground '[[preprocess.release]]' 'thickness_raster = "thick.asc"'
  grid thick.asc "4 * $in_source"
  expect_exit 0 preprocess
  grep '^ *release-1\|^ *area\|working grid' "$TALUS_SCRATCH/stderr" >asc.txt
  awk 'NR == 1 {print $2 " mx"} NR == 2 {print $2 " my"} NR == 3 {print $2 + 5 "  xlower"}
    NR == 4 {print $2 + 5 "  ylower"} NR == 5 {print $2 " dx"} NR == 6 {print $2 " nodata_value"} NR > 6' \
    CONVFMT=%.3f OFMT=%.3f before.asc >topo.tt3
  awk 'NR < 5 || NR == 6 {print $1, $2} NR == 5 {print "10 10 cellsize"} NR > 6 {for (i = 1; i <= NF; ++i) print $i}' \
    topo.tt3 >topo.tt2
  local model
  for model in topo.tt3 topo.tt2; do
    sed -i "s/base_dem = .*/base_dem = \"$model\"/" recipe.toml
    expect_exit 0 preprocess
    grep '^ *release-1\|^ *area\|working grid' "$TALUS_SCRATCH/stderr" >other.txt
    cmp asc.txt other.txt || fail "$model: $(<other.txt)"
  done
}

test_a_backslash_in_a_path_is_explained() {
  scene
  mkdir data && mv before.asc data
  local path
  for path in 'data\before.asc' 'data\temp\before.asc' 'data\now.asc' 'data\fine.asc'; do
    sed -i "s|^before_dem = .*|before_dem = \"${path//\\/\\\\}\"|" recipe.toml
    expect_exit 2 preprocess --check
    expect_words 'recipe.toml:6' 'backslash in double quotes begins an escape' "single quotes"
  done
  sed -i 's|^before_dem = .*|before_dem = "data\\\\dem.asc"|' recipe.toml
  sed -i 's|data\\\\dem|data\\dem|' recipe.toml
  expect_exit 2 preprocess --check
  expect_words 'backslash in double quotes begins an escape'
  sed -i "s|^before_dem = .*|before_dem = 'data/before.asc'|" recipe.toml
  expect_exit 0 preprocess --check
}

test_small_scenes_have_digits() {
  ground '[[preprocess.release]]' 'thickness_raster = "thick.asc"'
  grid thick.asc "0.004 * $in_source"
  grid before.asc "0.001 * $bowl"
  sed -i 's/^cellsize.*/cellsize 0.01/; s/corner .*/corner 0/' before.asc thick.asc
  sed -i 's/layer_height_m = 2.0/layer_height_m = 0.002/; s/end_time_s = .*/end_time_s = 0.05/' recipe.toml
  expect_exit 0 preprocess
  expect_words "release-1: 6.4e-06 m3" "area 0.0016 m2 on the map" "thickness at most 0.004 m vertical"
}

# release_of CORNER THICKNESS LINE: a polygon with this corner and attribute, and a line for the release.
release_of() {
  cat >release.geojson <<JSON
{"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {"thickness": $2}, "geometry":
  {"type": "Polygon", "coordinates": [[[500030, 5000080], [500070, 5000080], [$1], [500030, 5000120],
  [500030, 5000080]]]}}]}
JSON
  printf '%s\n' '[scene]' 'name = "extreme"' '[preprocess]' 'base_dem = "before.asc"' '[[preprocess.release]]' \
    'polygons = "release.geojson"' "$3" >recipe.toml
}

test_extreme_numbers_are_refused_in_few_digits() {
  scene
  local corner=500070,5000120 number
  for number in 1e30 1e300 1.7e308; do
    for line in "thickness_m = $number" "volume_m3 = $number" \
      $'thickness_m = 4\n[preprocess.grid]\nspacing_m = 1e-300'; do
      release_of $corner 4 "$line"
      expect_exit 3 preprocess
      [[ ! $(<stderr) =~ [0-9]{19} ]] || fail "$line: many digits: $(<stderr)"
    done
    release_of $corner $number ''
    expect_exit 3 preprocess
    [[ ! $(<stderr) =~ [0-9]{19} ]] || fail "thickness $number: many digits: $(<stderr)"
    release_of $number,5000120 4 'thickness_m = 4'
    expect_exit 3 preprocess
    expect_words 'release.geojson: polygon reaches x '
    [[ ! $(<stderr) =~ [0-9]{19} ]] || fail "corner $number: many digits: $(<stderr)"
  done
}

test_a_release_at_the_edge_is_refused_before_the_solver_runs() {
  scene
  release_of 500070,5000120 4 'thickness_m = 4'
  expect_exit 0 preprocess
  sed -i 's/500030/500000/g' release.geojson
  expect_exit 3 preprocess
  expect_words 'cells of release at the edge of the known ground'
  sed -i 's/500000/500010/g' release.geojson
  expect_exit 0 preprocess
  expect_exit 0 solve
  sed -i '/^[ 0-9.-]*$/s/^[^ ]* [^ ]* [^ ]* /-9999 -9999 -9999 /' before.asc
  expect_exit 3 preprocess
}

run_test "$@"
