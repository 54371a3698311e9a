#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# The demo, from the valley's two elevation models to its score, and its results, read by tools that are not ours.
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"
out=$is_made/synthetic-valley

pipeline() { make -C "$TALUS_SOURCE/pipelines" synthetic-valley OUT="$is_made" BIN="$bin"; }

test_is_made() {
  expect_exit 0 pipeline
  local file files=(domain.vdb preprocess.used.toml run.h5 solve.used.toml postprocess.used.toml score.json score.txt
    map.png history.csv maps/deposit_thickness.tif maps/peak_thickness.tif maps/peak_speed.tif maps/peak_pressure.tif
    maps/arrival_time.tif maps/results.nc maps/deposit_thickness.qml maps/terrain.tif maps/outlines.gpkg
    maps/synthetic-valley.qgs)
  for file in "${files[@]}"; do
    [[ -s $out/$file ]] || fail "$file is missing"
    grep -qF "$out/$file" stdout || fail "no program named $file on stdout"
  done
  [[ -z $(find "$out" -name '*.partial') ]] || fail "a file is still pending: $(find "$out" -name '*.partial')"
}

shows() { grep -qE -- "$1" stdout || fail "not shown: $1"; }

test_second_make_does_nothing() {
  local before after
  before=$(find "$out" -type f -not -name lock -printf '%p %T@\n' | sort)
  expect_exit 0 pipeline
  after=$(find "$out" -type f -not -name lock -printf '%p %T@\n' | sort)
  [[ $before == "$after" ]] || fail "files changed: $(diff <(echo "$before") <(echo "$after"))"
  if grep -q 'talus-' stdout; then fail "a program ran again"; fi
}

test_gdalinfo_reads_the_maps() {
  need_tool gdalinfo
  local name
  for name in deposit_thickness:m peak_thickness:m 'peak_speed:m s-1' peak_pressure:kPa arrival_time:s; do
    expect_exit 0 gdalinfo -stats "$out/maps/${name%%:*}.tif"
    shows 'LAYOUT=COG'
    shows 'COMPRESSION=DEFLATE'
    shows 'NoData Value=-9999'
    shows 'PROJCRS\['
    shows "Unit Type: ${name#*:}"
    shows 'STATISTICS_MAXIMUM=[0-9.]*[1-9]'
  done
  expect_exit 0 gdalinfo "$out/maps/deposit_thickness.tif"
  shows 'vertical'
}

test_maps_pass_gdals_own_cog_validator() {
  /usr/bin/python3 -c 'import osgeo_utils.samples.validate_cloud_optimized_geotiff' 2>/dev/null ||
    need_tool python3-gdal
  local map
  for map in "$out"/maps/*.tif; do
    expect_exit 0 /usr/bin/python3 -m osgeo_utils.samples.validate_cloud_optimized_geotiff --full-check=yes "$map"
    shows 'is a valid cloud optimized GeoTIFF'
    if grep -qi warning stdout; then fail "the validator warns"; fi   # on stderr, GDAL's Python warns of its own future
  done
}

# Points that gather within cells are denser than points that lie by chance.
test_points_do_not_drift_together() {
  PYTHONPATH=$TALUS_SOURCE/tests/pipeline /usr/bin/python3 -B - "$out" >stdout 2>stderr <<'PYTHON' ||
import sys
import packing
sys.exit(", ".join(packing.faults(sys.argv[1])) or None)
PYTHON
    fail "the points of the valley are packed"
}

# The volume on the map, summed up by GDAL, against the solver's own count of its points.
test_map_volume_is_the_volume_of_the_points() {
  need_tool h5dump
  /usr/bin/python3 -c 'from osgeo import gdal' 2>/dev/null || need_tool python3-gdal
  cat >volume.py <<'PYTHON'
import array, math, re, subprocess, sys
from osgeo import gdal
gdal.UseExceptions()
out = sys.argv[1]
command = ["h5dump", "-m", "%.17g", "-a", "/volume_final_m3", out + "/run.h5"]
dumped = subprocess.run(command, check=True, capture_output=True, text=True).stdout
points = float(re.search(r"\(0\): ([0-9.e+-]+)", dumped).group(1))
file = gdal.Open(out + "/maps/deposit_thickness.tif")
band = file.GetRasterBand(1)
values = array.array("d", band.ReadRaster(buf_type=gdal.GDT_Float64))
_, dx, _, _, _, dy = file.GetGeoTransform()
volume = math.fsum(v for v in values if v != band.GetNoDataValue()) * dx * -dy
print(f"map {volume} points {points} relative difference {volume / points - 1:.2e}")
assert points > 1000 and abs(volume / points - 1) < 1e-9
PYTHON
  expect_exit 0 /usr/bin/python3 volume.py "$out"
  shows 'relative difference'
}

test_ncdump_reads_the_netcdf() {
  need_tool ncdump
  expect_exit 0 ncdump -h "$out/maps/results.nc"
  shows ':Conventions = "CF-1\.'
  shows 'double deposit_thickness\(y, x\)'
  shows 'double thickness\(time, y, x\)'
  shows 'x:standard_name = "projection_x_coordinate"'
  shows 'peak_thickness:cell_methods = "area: mean time: maximum"'
  shows 'deposit_thickness:grid_mapping = "crs"'
  shows 'crs:crs_wkt = "PROJCRS'
  shows 'time:units = "seconds since 1970-01-01 00:00:00"'
  shows '_FillValue = -9999'
  expect_exit 0 ncdump -v time "$out/maps/results.nc"
  shows 'time = 0, [0-9.]+'
}

test_netcdf_follows_cf() {
  /usr/bin/python3 -c 'import netCDF4, osgeo.gdal, ctypes; ctypes.CDLL("libudunits2.so.0")' 2>/dev/null ||
    need_tool python3-netcdf4
  expect_exit 0 /usr/bin/python3 "$TALUS_SOURCE/tests/postprocess/maps/check_cf.py" "$out/maps/results.nc"
  need_tool cdo
  expect_exit 0 cdo -s infon "$out/maps/results.nc"
  if grep -qiE 'warning|error' stdout stderr; then fail "cdo complains: $(<stderr)"; fi
}

test_outlines_are_valid_and_stand_where_the_maps_do() {
  /usr/bin/python3 -c 'from osgeo import gdal, ogr' 2>/dev/null || need_tool python3-gdal
  cat >outlines.py <<'PYTHON'
import sys
from osgeo import gdal, ogr
gdal.UseExceptions()
file = ogr.Open(sys.argv[1] + "/outlines.gpkg")
map = gdal.Open(sys.argv[1] + "/deposit_thickness.tif")
west, dx, _, north, _, dy = map.GetGeoTransform()
assert file.GetLayerCount() == 5, [layer.GetName() for layer in file]
for layer in file:
    assert layer.GetSpatialRef().IsSame(map.GetSpatialRef()), layer.GetName()
    for feature in layer:
        shape = feature.GetGeometryRef()
        assert shape.IsValid() and abs(shape.GetArea() - feature["area_m2"]) < 1e-6 * shape.GetArea(), feature["name"]
        x0, x1, y0, y1 = shape.GetEnvelope()
        inside = west <= x0 <= x1 <= west + map.RasterXSize * dx and north + map.RasterYSize * dy <= y0 <= y1 <= north
        assert inside or layer.GetName() == "survey", feature["name"]
deposit = file.GetLayerByName("deposit")
areas = [feature["area_m2"] for feature in deposit]
assert len(areas) > 2 and areas == sorted(areas, reverse=True), f"a higher threshold encloses more: {areas}"
print("all valid")
PYTHON
  expect_exit 0 /usr/bin/python3 outlines.py "$out/maps"
  shows 'all valid'
}

test_vdb_print_lists_the_domain() {
  need_tool vdb_print
  expect_exit 0 vdb_print -l "$out/domain.vdb"
  local grid
  for grid in points terrain before release_thickness active; do shows "$grid"; done
  shows 'EPSG|PROJCRS'
}

test_h5dump_reads_the_run() {
  need_tool h5dump
  expect_exit 0 h5dump -H "$out/run.h5"
  local name names=(VTKHDF Steps Points Connectivity Offsets Types NumberOfPoints velocity maps deposit_thickness frames
    history)
  for name in "${names[@]}"; do
    shows "\"$name\""
  done
  expect_exit 0 h5dump -a /VTKHDF/Type "$out/run.h5"
  shows 'UnstructuredGrid'
  expect_exit 0 h5dump -d /maps/deposit_thickness "$out/run.h5"
}

test_score_holds_every_promised_number() {
  cat >score.py <<'PYTHON'
import json, math, sys
score = json.load(open(sys.argv[1]))
promised = """volume_released_m3 volume_final_m3 volume_outflow_m3 footprint_csi deposit_csi thickness_rmse_m
thickness_bias_m runout_m h_over_l particles steps wall_time_s on""".split()
for name in promised:
    assert name in score, f"score.json has no {name}"
    assert isinstance(score[name], str) or math.isfinite(score[name]), f"{name} = {score[name]}"
closed = score["volume_final_m3"] + score["volume_outflow_m3"]
released = score["volume_released_m3"]
assert abs(closed / released - 1) < 1e-9, f"released {released}, accounted for {closed}"
assert 0 < score["deposit_csi"] <= 1 and 0 < score["footprint_csi"] <= 1
print("all there")
PYTHON
  expect_exit 0 /usr/bin/python3 score.py "$out/score.json"
  shows 'all there'
}

test_picture_is_a_picture() {
  need_tool gdalinfo
  expect_exit 0 gdalinfo "$out/map.png"
  shows 'Driver: PNG'
}

test_demo_ends_on_six_numbers() {
  expect_exit 0 "$TALUS_SOURCE/tools/show-six-numbers.sh" "$out/score.txt"
  [[ $(wc -l <stdout) -eq 6 ]] || fail "these are not six: $(<stdout)"
  [[ $(grep -cE ' {2,}[0-9]' stdout) -eq 6 ]] || fail "a line has no number: $(<stdout)"
}

run_test "$@"
