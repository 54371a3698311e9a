#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# The memory that talus-preprocess takes: no more than it asks for beforehand, and little of a large model of which
# little is wanted.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

# slope_model FILE CELLS [OPTION...]: a plane of cells of 5 m, west of it the highest.
slope_model() {
  local file=$1 cells=$2
  printf '%s\n' 'ncols 2' 'nrows 2' 'xllcorner 500000' 'yllcorner 5000000' "cellsize $((5 * cells / 2))" \
    '2000 1000' '2000 1000' >corners.asc
  gdal_translate -q -a_srs EPSG:32611 -ot Float32 -r bilinear -outsize "$cells" "$cells" "${@:3}" corners.asc "$file"
}

# release_at X Y: release.geojson, 100 x 100 m around a place.
release_at() {
  local w=$(($1 - 50)) e=$(($1 + 50)) s=$(($2 - 50)) n=$(($2 + 50))
  cat >release.geojson <<JSON
{"type": "FeatureCollection", "crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::32611"}},
 "features": [{"type": "Feature", "properties": {}, "geometry": {"type": "Polygon",
  "coordinates": [[[$w,$s],[$e,$s],[$e,$n],[$w,$n],[$w,$s]]]}}]}
JSON
}

# recipe NAME DEM [LINE...]: a release of 4 m on that model.
recipe_on() {
  {
    printf '[scene]\nname = "%s"\n\n[preprocess]\naccept = ["steep-ground"]\n' "$1"
    printf '%s\n' "${@:2}" '' '[[preprocess.release]]' 'polygons = "release.geojson"' 'thickness_m = 4.0'
  } >"$1.toml"
}

# peak_of NAME: the most memory that talus-preprocess had on NAME.toml [MB].
peak_of() {
  /usr/bin/python3 - "$bin/talus-preprocess" "$1.toml" --out "out/$1" <<'PYTHON'
import resource, subprocess, sys
subprocess.run(sys.argv[1:], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss // 1024)
PYTHON
}

# asked_of NAME: what it asks for beforehand [MB]; a limit of the process makes it say so.
asked_of() {
  (ulimit -d 300000 && expect_exit 3 "$bin/talus-preprocess" "$1.toml" --out "out/$1" --check) || exit 1
  local words
  words=$(grep -oE '[0-9.]+ [MG]B are needed' "$TALUS_SCRATCH/stderr") || fail "nothing is asked for"
  awk '{ print ($2 == "GB" ? 1000 : 1) * $1 }' <<<"$words"
}

test_is_no_more_than_is_asked_for() {
  need_tool gdal_translate
  slope_model small.tif 50
  recipe_on small 'base_dem = "small.tif"'
  local cells base peak asked
  release_at 500125 5000125
  base=$(peak_of small)
  for cells in 1200 1800; do
    slope_model "$cells.tif" "$cells"
    gdal_translate -q -scale 0 3000 0.3 0.4 "$cells.tif" mu.tif
    release_at 501000 5002000
    recipe_on "model-$cells" "base_dem = \"$cells.tif\""
    recipe_on "bed-$cells" "base_dem = \"$cells.tif\"" '[[preprocess.bed.raster]]' \
      'number = "friction_coefficient"' 'file = "mu.tif"'
    recipe_on "zone-$cells" "base_dem = \"$cells.tif\"" '[[preprocess.bed.zone]]' 'friction_coefficient = 0.3' \
      'turbulence_m_s2 = 2000.0'
    local kind
    for kind in model bed zone; do
      asked=$(asked_of "$kind-$cells")
      peak=$(peak_of "$kind-$cells")
      echo "$kind of $cells x $cells cells: asked $asked MB, taken $((peak - base)) MB besides $base MB"
      ((peak - base <= ${asked%.*})) || fail "$kind of $cells cells takes more than it asks for"
      ((peak - base >= ${asked%.*} / 2)) || fail "$kind of $cells cells asks for more than twice what it takes"
    done
  done
}

test_of_a_large_model_with_a_small_part_wanted_is_that_of_the_part() {
  need_tool gdal_create
  release_at 540000 5030000
  gdal_create -q -of GTiff -ot Float32 -outsize 10000 10000 -bands 1 -a_ullr 500000 5060000 560000 5000000 \
    -a_srs EPSG:32611 -burn 700 -co TILED=YES -co COMPRESS=ZSTD large.tif
  gdal_create -q -of GTiff -ot Float32 -outsize 10000 10000 -bands 1 -a_ullr 500000 5060000 560000 5000000 \
    -a_srs EPSG:32611 -a_nodata -1 -co TILED=YES -co SPARSE_OK=TRUE thickness.tif
  gdal_rasterize -q -burn 5 release.geojson thickness.tif
  recipe_on polygons 'base_dem = "large.tif"' '[preprocess.grid]' \
    'extent_m = [539000.0, 5029000.0, 541000.0, 5031000.0]'
  sed 's/^polygons.*/thickness_raster = "thickness.tif"/; s/^thickness_m.*//; s/"polygons"/"raster"/' polygons.toml \
    >raster.toml
  local name peak
  for name in polygons raster; do
    peak=$(peak_of "$name")
    echo "$name: $peak MB"
    ((peak < 500)) || fail "$name: $peak MB for 333 x 333 of 10^8 cells"
  done
}

run_test "$@"
