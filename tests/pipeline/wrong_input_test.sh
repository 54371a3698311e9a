#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Wrong input: the exit code, the whole message, and that nothing is left which looks like a result.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

# refused CODE PART...: talus-preprocess ends with that code and with this line, its parts one behind the other.
refused() {
  expect_exit "$1" preprocess
  expect_error "${@:2}"
  [[ ! -s stdout ]] || fail "a refused run names results on stdout"
  expect_no_file out
}

test_scene_itself_is_fine() {
  scene
  expect_exit 0 preprocess
  expect_stdout_paths
}

test_missing_recipe() {
  expect_exit 2 "$bin/talus-preprocess" nowhere.toml --out out
  expect_error "talus-preprocess: nowhere.toml: the recipe cannot be read (No such file or directory). Check the path"
}

test_missing_file() {
  scene
  rm after.asc
  refused 3 "talus-preprocess: after.asc: no such file. Check the path in the recipe"
}

test_geographic_crs() {
  scene
  printf '%s%s\n' 'GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,298.257223563]],' \
    'PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]]' >before.prj
  refused 3 "talus-preprocess: before.asc: CRS is WGS 84, in degrees (this stage needs metres). Reproject: " \
    "gdalwarp -t_srs EPSG:<a metric one> -r bilinear before.asc before_utm.tif; or set working_crs = \"utm\" in " \
    "[preprocess]"
}

test_no_overlap() {
  scene
  grid after.asc "$bowl - 4 * $in_source" 600000
  refused 3 "talus-preprocess: after.asc: covers x 600000..600200, y 5000000..5000200, while " \
    "before.asc covers x 500000..500200, y 5000000..5000200 (they do not overlap). Check the coordinates and " \
    "the CRS of both with gdalinfo"
}

test_all_nodata() {
  scene
  grid before.asc -9999
  refused 3 "talus-preprocess: before.asc: has no data at all in the working grid (all its cells there are " \
    "nodata). Check its coordinates and nodata value with gdalinfo"
}

# refused_void FILE: the cell at column 11, row 5 has no elevation.
refused_void() {
  refused 3 "talus-preprocess: $1: 1 cell without elevation, at x 500115.0, y 5000055.0 (nodata or NaN inside " \
    "the working area). Fill them: fill_m2 = 1e5 in [preprocess.voids], or beforehand (gdal_fillnodata.py $1 " \
    "out.tif); or crop the working grid (extent_m in [preprocess.grid]), or, where they " \
    "reach its edge, leave them outside the domain: edge_nodata = \"outside\""
}

test_nan_cells() {
  scene
  grid after.asc "i == 11 && j == 5 ? \"nan\" : $bowl - 4 * $in_source"
  refused_void after.asc
}

test_nodata_cells() {
  scene
  grid before.asc "i == 11 && j == 5 ? -9999 : $bowl"
  refused_void before.asc
}

test_empty_source() {
  scene
  cp before.asc after.asc
  refused 3 "talus-preprocess: after.asc: nowhere lies more than 0.5 m below the surface before (at most 0 m) " \
    "(the source is empty). Lower threshold_m in [preprocess.source], or give its outline as polygon"
}

test_negative_thickness() {
  scene
  grid release.asc "-3 * $in_source"
  sed -i '/^after_dem/d; s/^before_dem = "before.asc"/base_dem = "before.asc"/' recipe.toml
  printf '\n[[preprocess.release]]\nname = "A"\nthickness_raster = "release.asc"\n' >>recipe.toml
  refused 3 "talus-preprocess: release.asc: 16 cells of negative thickness (down to -3 m), the first at " \
    "x 500035.0, y 5000115.0 (a release has none). Is it an elevation difference, after - before? Then: " \
    "gdal_calc.py -A release.asc --calc \"maximum(-A,0)\" --outfile out.tif"
}

test_unknown_key() {
  scene
  sed -i 's/^layer_height_m/layer_hight_m/' recipe.toml
  refused 2 "talus-preprocess: recipe.toml:10:1: unknown key \"layer_hight_m\" in [preprocess.grid]. " \
    "Did you mean \"layer_height_m\"?"
}

test_value_out_of_range() {
  scene
  sed -i 's/^layer_height_m = 2.0/layer_height_m = -2.0/' recipe.toml
  refused 2 "talus-preprocess: recipe.toml:10:18: [preprocess.grid] layer_height_m = -2.0 (out of range). " \
    "It must be >= 0"
}

test_all_faults_are_reported_at_once() {
  scene
  sed -i 's/^layer_height_m = 2.0/layer_height_m = "two"\nspacing = 10/; s/^before_dem/befor_dem/' recipe.toml
  refused 2 "talus-preprocess: recipe.toml:6:1: unknown key \"befor_dem\" in [preprocess]. Did you mean \"before_dem\"?"
  expect_error "talus-preprocess: recipe.toml:10:18: [preprocess.grid] layer_height_m = \"two\" (it is text). " \
    "Give a number"
  expect_error "talus-preprocess: recipe.toml:11:1: unknown key \"spacing\" in [preprocess.grid]. " \
    "Did you mean \"spacing_m\"?"
}

test_not_a_recipe() {
  scene
  echo '[solve' >>recipe.toml
  expect_exit 2 preprocess
  expect_words "talus-preprocess: recipe.toml:23:7: this is not TOML (" "the format is described on https://toml.io"
}

test_output_folder_below_a_file() {
  scene
  touch file
  expect_exit 3 "$bin/talus-preprocess" recipe.toml --out file/out
  expect_error "talus-preprocess: file/out: the output folder cannot be written to (Not a directory). " \
    "Name another one with --out DIR"
}

test_output_folder_not_writable() {
  need_mounts   # a read-only disk: the super-user may write anywhere else
  scene
  cat >read_only.sh <<SCRIPT
mkdir out && mount -t tmpfs -o size=1m,ro tmpfs out && "$bin/talus-\$1" recipe.toml --out out
SCRIPT
  local stage
  for stage in preprocess solve postprocess; do
    rm -rf out
    expect_exit 3 with_mounts bash read_only.sh $stage
    expect_error "talus-$stage: out: the output folder cannot be written to (Read-only file system). " \
      "Name another one with --out DIR"
  done
}

# Nothing is waited for: nobody writes to the pipe.
test_pipes_instead_of_files() {
  scene
  rm after.asc
  mkfifo after.asc
  expect_exit 3 timeout 20 "$bin/talus-preprocess" recipe.toml --out out
  expect_error "talus-preprocess: after.asc: cannot be read (it is a pipe). Give a plain file: it is read from " \
    "several places, some of them twice"
  expect_no_file out
  mkdir -p out
  mkfifo out/domain.vdb
  expect_exit 3 timeout 20 "$bin/talus-solve" recipe.toml --out out --on cpu
  expect_words 'talus-solve: out/domain.vdb: cannot be read (it is a pipe)'
  mkfifo out/run.h5
  expect_exit 3 timeout 20 "$bin/talus-postprocess" recipe.toml --out out
  expect_words 'talus-postprocess: out/run.h5: cannot be read (it is a pipe)'
}

test_a_mosaic_too_large_for_memory() {
  scene
  cat >before.vrt <<'VRT'
<VRTDataset rasterXSize="2000000000" rasterYSize="2000000000">
<GeoTransform>500000,10,0,5000200,0,-10</GeoTransform>
<VRTRasterBand dataType="Float32" band="1"><SimpleSource><SourceFilename relativeToVRT="1">before.asc</SourceFilename>
<SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>
VRT
  sed 's/before.asc/before.vrt/' before.vrt >after.vrt
  sed -i 's/before.asc/after.asc/' after.vrt
  sed -i 's/before.asc/before.vrt/; s/after.asc/after.vrt/' recipe.toml
  expect_exit 3 timeout 60 "$bin/talus-preprocess" recipe.toml --out out
  expect_words 'before.vrt and after.vrt share 2000000000 x 2000000000 cells'
  expect_no_file out
  sed -i 's/^after_dem.*/sliding_surface = "after.vrt"/' recipe.toml
  expect_exit 3 timeout 60 "$bin/talus-preprocess" recipe.toml --out out
  expect_words 'the working grid: 2000000000 x 2000000000 cells (9.6e+08 TB are needed, this process may have'
  expect_no_file out
}

test_a_corner_at_which_cells_cannot_be_told_apart() {
  scene
  sed -i 's/xllcorner.*/xllcorner 1e17/' before.asc after.asc
  expect_exit 3 preprocess
  expect_words 'before.asc: west 1e+17, south 5e+06, cells of 10 m (coordinates that large are 16 m apart'
  expect_no_file out
}

# Nobody listens at the port: a request would show as a refused connection.
test_sources_on_a_network() {
  scene
  cat >before.vrt <<'VRT'
<VRTDataset rasterXSize="20" rasterYSize="20"><GeoTransform>500000,10,0,5000200,0,-10</GeoTransform>
<VRTRasterBand dataType="Float32" band="1"><SimpleSource>
<SourceFilename>/vsicurl/http://127.0.0.1:9/before.tif</SourceFilename><SourceBand>1</SourceBand>
</SimpleSource></VRTRasterBand></VRTDataset>
VRT
  sed -i 's/before.asc/before.vrt/' recipe.toml
  expect_exit 3 preprocess
  expect_error 'talus-preprocess: before.vrt: it names /vsicurl/http://127.0.0.1:9/before.tif (that is no file of ' \
    'this machine, and nothing is fetched unless it is asked for). Download it and name the file, or give --network'
  expect_exit 3 preprocess --network
  grep -q 'nothing is fetched' stderr && fail "--network fetches nothing"
  expect_no_file out
}

test_all_faults_of_a_scene_at_once() {
  scene
  printf '[[solve.load]]\nextent_m = [0.0, 0.0, 1.0, 1.0, 0.0, 1.0]\nforce_N = [1.0, 0.0, 0.0]\n' >>recipe.toml
  printf '[[solve.part]]\nrelease = "x"\n' >>recipe.toml
  expect_exit 0 preprocess
  expect_exit 2 solve --check
  expect_words '[[solve.load]] number 1: no material point starts inside its box' \
    '[[solve.part]] release = "x": no material point is of that release'
}

test_threads_are_a_number() {
  scene
  expect_exit 2 preprocess --threads 0
  expect_words '--threads'
  expect_exit 0 preprocess --threads 1
  expect_exit 0 solve --threads 1
  expect_exit 0 postprocess --threads 2
}

test_solver_without_domain() {
  scene
  expect_exit 3 solve
  expect_error "talus-solve: out/domain.vdb: no such file. Run talus-preprocess first, with the same --out"
  expect_no_file out
}

test_postprocess_without_run() {
  scene
  expect_exit 3 postprocess
  expect_error "talus-postprocess: out/run.h5: no such file. Run talus-solve again"
  expect_no_file out
}

run_test "$@"
