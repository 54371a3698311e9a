#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# talus: one command over the stages.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

run() { "$bin/talus" run recipe.toml --out out --on cpu "$@"; }

# runs STAGES...: talus runs exactly these stages, and says of the others that they are up to date.
runs() {
  local stage expected
  expect_exit 0 run "${arguments[@]}"
  for stage in preprocess solve postprocess; do
    expected=up
    [[ " $* " != *" $stage "* ]] || expected=runs
    if grep -qE "^$stage: [a-z0-9./]+ is up to date$" stderr; then
      [[ $expected == up ]] || fail "$stage did not run"
    else
      [[ $expected == runs ]] || fail "$stage ran: $(grep "^$stage: " stderr)"
    fi
  done
  expect_stdout_paths
}
arguments=()
change() { sed -i "$1" recipe.toml; }

test_runs_a_scene_from_any_folder_and_skips_what_is_up_to_date() {
  scene
  mkdir elsewhere
  cd elsewhere
  expect_exit 0 "$bin/talus" run ../recipe.toml --on cpu
  cd ..
  [[ -f out/report.html && -f out/score.json ]] || fail "no report beside the recipe"
  expect_words 'preprocess: there is no domain.vdb' 'solve: there is no run.h5' 'postprocess: there is no score.json'
  runs
  touch recipe.toml
  runs
}

test_each_part_of_the_recipe_reruns_its_stage_and_those_after_with_the_reason() {
  scene
  expect_exit 0 run
  change 's/^friction_angle_deg = 15.0/friction_angle_deg = 16.0/'
  runs solve postprocess
  expect_words 'solve: [solve] has changed: base.friction_angle_deg' 'run.h5 has changed'
  change 's/^thickness = .*/&\nname = "drawn"/'
  runs postprocess
  change 's/layer_height_m = 2.0/layer_height_m = 1.0/'
  runs preprocess solve postprocess
  expect_words 'preprocess: [preprocess] has changed: grid.layer_height_m' 'domain.vdb has changed'
  touch survey.asc before.asc "$bin/talus-solve"
  change 's/^\[solve\]/# a remark\n\n[solve]/'
  runs
  sed -i '6s/ 0$/ 0.5/; 6s/^0 /0.5 /; 7s/^[^ ]*/1/' survey.asc
  runs postprocess
  expect_words "postprocess: survey.asc has changed"
  sed -i '7s/^[^ ]*/99/' before.asc
  runs preprocess solve postprocess
  expect_words "preprocess: before.asc has changed"
  rm out/run.h5
  runs solve postprocess
  expect_words 'solve: there is no run.h5'
  rm out/maps/deposit_thickness.tif
  runs postprocess
  expect_words 'postprocess: there is no maps/deposit_thickness.tif'
  change 's/^title = .*/title = "Another"/'
  runs preprocess solve postprocess
  expect_words 'preprocess: [scene] has changed'
}

# The stages by themselves go by the same rule.
test_the_stages_do_nothing_where_they_are_up_to_date_if_asked() {
  scene
  expect_exit 0 preprocess --if-outdated
  expect_words 'preprocess: there is no domain.vdb'
  expect_exit 0 solve --if-outdated
  expect_exit 0 postprocess --if-outdated
  local stage
  for stage in preprocess solve postprocess; do
    expect_exit 0 $stage --if-outdated
    expect_words "$stage: " ' is up to date'
    expect_stdout_paths
  done
  arguments=()
  runs
  expect_exit 0 solve --set solve.end_time_s=2 --if-outdated
  expect_words 'solve: [solve] has changed: end_time_s'
}

# What GDAL reads beside a file that a recipe names is an input as well.
test_files_beside_an_input_count() {
  need_tool gdalbuildvrt
  scene
  gdal_translate -q -of GTiff before.asc west.tif
  gdalbuildvrt -q mosaic.vrt west.tif
  change 's|^before_dem.*|before_dem = "mosaic.vrt"|'
  expect_exit 0 preprocess
  local name
  for name in mosaic.vrt west.tif after.asc; do
    grep -qF "# input: $TALUS_SCRATCH/$name  sha256 $(sha256sum $name | cut -d' ' -f1)" out/preprocess.used.toml ||
      fail "$name is not noted"
  done
  expect_exit 0 preprocess --if-outdated
  expect_words 'is up to date'
  gdal_translate -q -of GTiff -co COMPRESS=LZW before.asc west.tif
  expect_exit 0 preprocess --if-outdated
  expect_words 'preprocess: west.tif has changed'
  touch mosaic.prj
  expect_exit 0 preprocess --if-outdated
  expect_words 'preprocess: mosaic.prj is new'
}

test_the_plan_is_of_a_domain_that_is_up_to_date() {
  scene
  expect_exit 0 run --plan
  expect_words 'preprocess: there is no domain.vdb'
  [[ -f out/domain.vdb && ! -e out/run.h5 ]] || fail "$(ls out)"
  expect_exit 0 run --plan
  expect_words 'preprocess: domain.vdb is up to date'
  expect_exit 0 solve --plan
  grep -q 'steps' stderr || fail "no plan: $(<stderr)"
}

test_all_stages_run_in_one_process() {
  need_tool strace
  scene
  expect_exit 0 strace -f -o trace -e trace=execve "$bin/talus" run recipe.toml --out out --on cpu
  [[ $(grep -c 'execve(' trace) -eq 1 ]] || fail "processes: $(grep 'execve(' trace)"
}

test_set_values_count_like_the_recipes_and_are_checked_before_anything_runs() {
  scene
  arguments=(--set solve.end_time_s=2)
  runs preprocess solve postprocess
  grep -qF 'end_time_s = 2.0' out/solve.used.toml || fail "the run has another end"
  runs
  arguments=()
  runs solve postprocess
  expect_exit 2 run --set postprocess.deposit_threshold_m=-1 --set preprocess.grid.spacing_m=-1
  expect_error 'talus: --set postprocess.deposit_threshold_m=-1: [postprocess] deposit_threshold_m = -1' \
    ' (out of range). It must be > 0'
  expect_words '--set preprocess.grid.spacing_m=-1: [preprocess.grid] spacing_m = -1 (out of range)'
}

# What the stages made by themselves, or make, counts as well: their used recipes tell.
test_results_of_the_stages_themselves_count() {
  scene
  expect_exit 0 preprocess
  expect_exit 0 solve
  runs postprocess
  runs
  # A domain of another recipe, made behind the command's back.
  expect_exit 0 preprocess --set preprocess.grid.layer_height_m=1
  runs preprocess solve postprocess
  expect_words 'preprocess: [preprocess] has changed: grid.layer_height_m'
  # Nor is a run of another recipe taken, whatever its time.
  expect_exit 0 solve --set solve.end_time_s=2
  runs solve postprocess
  expect_words 'solve: [solve] has changed: end_time_s'
  # Nor is a file from elsewhere, which carries another id.
  expect_exit 0 "$bin/talus-solve" recipe.toml --out other --on cpu --set 'solve.domain="out/domain.vdb"'
  cp other/run.h5 out/run.h5
  runs solve postprocess
  expect_words 'solve: run.h5 is not the one noted: its id is '
}

test_a_stale_domain_without_its_data_is_refused_with_the_reason() {
  scene
  expect_exit 0 run
  rm before.asc
  runs
  expect_words "warning: domain.vdb: recipe unchanged; inputs are missing and could not be checked: before.asc"
  change 's/layer_height_m = 2.0/layer_height_m = 1.0/'
  expect_exit 3 run
  expect_words 'preprocess: [preprocess] has changed: ' 'before.asc: '
  [[ -f out/run.h5 && -f out/score.json ]] || fail "the results of before are gone"
}

test_a_checkpoint_of_the_run_is_taken_up_and_said() {
  scene
  make_checkpoint out
  expect_exit 3 solve
  expect_words 'it holds this very run at t = ' 'Go on from it with --restart'
  expect_exit 0 run
  expect_words 'going on from out/checkpoint.h5 at t = '
}

test_a_signal_reaches_the_stage_and_the_next_call_goes_on() {
  scene
  change 's/^end_time_s.*/end_time_s = 100.0\ncheckpoint_interval_s = 5.0/'
  expect_exit 0 preprocess
  interrupt TERM out/checkpoint.h5 "$bin/talus" run recipe.toml --out out --on cpu
  [[ -f out/checkpoint.h5 && ! -f out/run.h5 ]] || fail "no checkpoint was left"
  expect_words 'talus: the same command goes on'
  expect_exit 0 run
  expect_words 'preprocess: domain.vdb is up to date' 'going on from out/checkpoint.h5 at t = '
}

test_a_failing_stage_ends_the_command_with_its_exit_code() {
  scene
  expect_exit 2 run --set 'solve.gauge=[{name = "far", at_m = [0, 0]}]'
  expect_words 'talus-solve: ' 'far'
  [[ ! -f out/score.json ]] || fail "scores of no run"
}

test_two_commands_in_one_folder_are_refused() {
  scene
  mkdir -p out
  exec {held}>out/.talus.lock
  echo 'talus run (process 1 on here, since today)' >&"$held"
  flock "$held"
  expect_exit 3 run
  expect_words 'out: in use by talus run (process 1 on here, since today)'
  exec {held}>&-
}

test_make_and_talus_go_by_one_rule() {
  need_tool make
  scene
  mkdir -p pipelines/bowl
  cp "$TALUS_SOURCE"/pipelines/Makefile pipelines/
  mv recipe.toml before.asc after.asc survey.asc pipelines/bowl/
  expect_exit 0 make -C pipelines bowl BIN="$bin" OUT=out ON=cpu
  expect_exit 0 "$bin/talus" run pipelines/bowl/recipe.toml --out out/bowl --on cpu
  [[ $(grep -c 'is up to date$' stderr) -eq 3 ]] || fail "talus ran what make had made"
  sed -i 's/end_time_s = 3.0/end_time_s = 2.0/' pipelines/bowl/recipe.toml
  expect_exit 0 "$bin/talus" run pipelines/bowl/recipe.toml --out out/bowl --on cpu
  expect_exit 0 make -C pipelines bowl BIN="$bin" OUT=out ON=cpu
  [[ $(grep -c 'is up to date$' stderr) -eq 3 ]] || fail "make ran what talus had made: $(<stderr)"
}

# pack: before.asc into every kind of file that a recipe names otherwise than by a path.
pack() {
  gdal_translate -q -of netCDF -a_srs EPSG:32633 before.asc place/dem.nc
  gdal_translate -q -of GPKG -a_srs EPSG:32633 -ot Float32 before.asc place/dem.gpkg
  gdal_translate -q -a_srs EPSG:32633 before.asc dem.tif
  python3 -m zipfile -c place/dem.zip dem.tif
  tar -cf place/dem.tar dem.tif
  gzip -nc dem.tif >place/dem.tif.gz
}

# Their paths count from the recipe's folder, and their bytes decide what is up to date.
test_inputs_that_only_gdal_can_name_are_found_and_watched() {
  need_tool gdal_translate
  scene
  mkdir place
  gdal_translate -q -a_srs EPSG:32633 after.asc place/after.tif
  pack
  cat >place/part.vrt <<'XML'
<VRTDataset rasterXSize="20" rasterYSize="20"><SRS>EPSG:32633</SRS>
<GeoTransform>500000, 10, 0, 5000200, 0, -10</GeoTransform><VRTRasterBand dataType="Float32" band="1"><SimpleSource>
<SourceFilename relativeToVRT="1">NETCDF:"dem.nc":Band1</SourceFilename><SourceBand>1</SourceBand>
</SimpleSource></VRTRasterBand></VRTDataset>
XML
  sed -i '/^\[postprocess/,$d; s/after.asc/after.tif/' recipe.toml
  # The ground rises from run to run, the outline of the source stays.
  sed -i 's/^\[preprocess.grid\]/[preprocess.source]\npolygon = "source.csv"\n\n&/' recipe.toml
  cat >place/source.csv <<'CSV'
name,WKT
slide,"POLYGON ((500030 5000080, 500070 5000080, 500070 5000120, 500030 5000120, 500030 5000080))"
CSV
  local name again='is up to date' number=0 lift=0
  for name in 'NETCDF:"dem.nc":Band1' 'GPKG:dem.gpkg:dem' '/vsizip/dem.zip/dem.tif' \
    '/vsitar/dem.tar/dem.tif' '/vsigzip/dem.tif.gz' "/vsizip/$PWD/place/dem.zip/dem.tif" part.vrt; do
    out=out$((number += 1))
    sed "s#^before_dem = .*#before_dem = '$name'#" recipe.toml >place/recipe.toml
    expect_exit 0 "$bin/talus-preprocess" place/recipe.toml --out $out --if-outdated
    (cd place && expect_exit 0 "$bin/talus-preprocess" recipe.toml --out ../$out --if-outdated)
    expect_words "$again"
    grid before.asc "$bowl + $((lift += 1))"
    pack
    expect_exit 0 "$bin/talus-preprocess" place/recipe.toml --out $out --if-outdated
    expect_words 'has changed'
    mv place moved
    if [[ $name != *"$PWD"* ]]; then
      expect_exit 0 "$bin/talus-preprocess" moved/recipe.toml --out $out-moved --if-outdated
    fi
    mv moved place
    rm -rf $out $out-moved
  done
}

test_check_lists_the_faults_of_all_tables_and_writes_nothing() {
  scene
  change 's/layer_height_m = 2.0/layer_height_m = -2.0/; s/end_time_s = 3.0/end_tme_s = 3.0/'
  change 's/^thickness = .*/thicknes = 1/'
  expect_exit 2 "$bin/talus" check recipe.toml
  expect_error 'preprocess: recipe.toml:10:18: [preprocess.grid] layer_height_m = -2.0 (out of range). It must be >= 0'
  expect_words 'solve: recipe.toml:13:1: unknown key "end_tme_s" in [solve]' \
    'postprocess: recipe.toml:22:1: unknown key "thicknes" in [postprocess.survey]' 'recipe.toml: 3 faults, no warnings'
  [[ ! -e out ]] || fail "talus check made the output folder"
}

test_check_looks_at_physics_and_data_too() {
  scene
  expect_exit 0 "$bin/talus" check recipe.toml
  expect_words 'recipe.toml: no faults'
  [[ ! -e out ]] || fail "talus check made the output folder"
  # Weaker than its bed: a warning of the solver, which has to see the domain.
  expect_exit 0 "$bin/talus" check recipe.toml --set solve.base.friction_angle_deg=35
  expect_words 'warning: solve: the mass gives way inside before it slides on its bed'
  # A gauge off the map, and a survey that is not there: two stages, one listing.
  rm survey.asc
  expect_exit 3 "$bin/talus" check recipe.toml --set 'solve.gauge=[{name = "far", at_m = [0, 0]}]'
  expect_words 'solve: ' '"far"' 'survey.asc: no such file' 'recipe.toml: 2 faults'
}

# talus new on the shipped samples: four layers or more, and the recipe runs through to a score.
test_new_writes_a_recipe_that_runs_through() {
  local sample
  for sample in valley rock-slope raw-valley; do
    mkdir "$sample"
    local new=("$bin/talus" new "$TALUS_SOURCE/data_samples/$sample/before_dem.tif"
      "$TALUS_SOURCE/data_samples/$sample/after_dem.tif" --recipe "$sample/recipe.toml")
    if [[ $sample == rock-slope ]]; then  # two scars and no deposit
      expect_exit 3 "${new[@]}"
      expect_words 'nothing rose below it' '4,212,182 m3 at [400475.0, 5200785.0]' '--at X,Y'
      new+=(--at 400475,5200785)
    fi
    expect_exit 0 "${new[@]}"
    expect_stdout_paths
    awk '/ layers over its median thickness/ { if ($5 >= 4) found = 1 } END { exit !found }' "$sample/recipe.toml" ||
      fail "$sample: fewer than four layers: $(grep layers "$sample/recipe.toml")"
    expect_exit 0 "$bin/talus" check "$sample/recipe.toml"
    expect_words 'recipe.toml: no faults'
    # To the end in seconds: the first stretch of it, on cells twice as wide.
    local spacing
    spacing=$(sed -n 's/^spacing_m = \([0-9]*\).*/\1/p' "$sample/recipe.toml")
    expect_exit 0 "$bin/talus" run "$sample/recipe.toml" --on cpu --set "preprocess.grid.spacing_m=$((2 * spacing))" \
      --set solve.end_time_s=5
    grep -qF '"deposit_csi"' "$sample/out/score.json" || fail "$sample: no score against the survey"
  done
}

# One model and an outline: by its area, a volume, a depth or a thickness; with doubts that an ensemble draws from.
test_new_writes_a_recipe_of_a_slope_that_may_fail() {
  local samples=$TALUS_SOURCE/data_samples/valley
  local new=("$bin/talus" new "$samples/before_dem.tif" "$samples/source.geojson" --recipe one/recipe.toml --overwrite)
  local amount
  for amount in "--volume 150000" "--depth 20" "--thickness 8" ""; do
    # shellcheck disable=SC2086  # an option and its value
    expect_exit 0 "${new[@]}" $amount
    expect_words 'friction is the usual one for the volume'
    expect_exit 0 "$bin/talus" check one/recipe.toml
    expect_words 'recipe.toml: no faults'
    [[ $amount != *volume* ]] || expect_words 'no faults, no warnings'
  done
  grep -q 'Released: 131105 m3' one/recipe.toml || fail "the volume is not that of the area: $(head -4 one/recipe.toml)"
  expect_exit 0 "$bin/talus" run one/recipe.toml --on cpu --set ensemble.members=3 --set solve.end_time_s=2
  [[ -s one/out/probability.nc ]] || fail "no probabilities"
  head -1 one/out/members.csv | grep -q 'solve.base.friction_coefficient.*preprocess.thickness_factor' ||
    fail "friction and volume do not vary: $(head -1 one/out/members.csv)"
  expect_exit 2 "${new[@]}" --volume 150000 --depth 3
  expect_words '--thickness, --volume, --depth: more than one'
  expect_exit 2 "${new[@]}" --at 1,2
  expect_words '--at, --outline and --ignore say which change between two models is the slide'
  expect_exit 2 "$bin/talus" new "$samples/before_dem.tif" "$samples/after_dem.tif" --recipe two.toml --depth 3
  expect_words 'it holds no polygons, or is not there'
}

test_new_refuses_politely_what_is_no_slide() {
  scene
  expect_exit 3 "$bin/talus" new --recipe new.toml before.asc before.asc
  expect_words 'before.asc and before.asc: no slide was found between them, so that no recipe was written ('
  expect_exit 3 "$bin/talus" new --recipe new.toml after.asc before.asc      # the wrong way round
  expect_words 'no slide was found between them'
  # Noise alone, of 1 m.
  grid noisy.asc "$bowl + 2 * rand() - 1"
  expect_exit 3 "$bin/talus" new --recipe new.toml before.asc noisy.asc
  expect_words 'no slide was found between them'
  expect_exit 3 "$bin/talus" new --recipe new.toml before.asc none.asc
  expect_words 'none.asc'
  [[ ! -e new.toml ]] || fail "a recipe was written"
  expect_exit 3 "$bin/talus" new before.asc after.asc
  expect_error 'talus: recipe.toml: it is there already (nothing is written over). Name another file with --recipe' \
    ' FILE, or give --overwrite'
}

test_compare_puts_two_runs_on_one_page() {
  scene
  expect_exit 0 "$bin/talus" run recipe.toml --out a --on cpu
  expect_exit 0 "$bin/talus" run recipe.toml --out b --on cpu --set preprocess.grid.spacing_m=5 \
    --set solve.base.friction_angle_deg=10 --set 'scene.title=A <b> title'
  expect_exit 0 "$bin/talus" compare a b
  expect_stdout_paths
  local page=a/comparison.html word
  for word in 'data:image/png;base64,iVBOR' '<h2>Volumes</h2>' '<h2>Run-out and extent</h2>' \
    '<h2>Against the survey</h2>' '<h2>Cost</h2>' 'fahrboeschung' '[solve.base] friction_angle_deg' \
    'The grids differ (20 x 20 cells of 10 m and 40 x 40 of 5 m)' 'A &lt;b&gt; title'; do
    grep -qF -- "$word" $page || fail "the page does not show: $word"
  done
  ! grep -qE "<script|https?://|$TALUS_SCRATCH" $page || fail "the page runs scripts, loads something or names folders"
  # The same run is the same deposit.
  cp -r a c
  expect_exit 0 "$bin/talus" compare a c
  grep -qF '<td class="n">0 %</td>' $page || fail "a run differs from itself"
  grep -qF 'The deposits are the same.' $page || fail "a deposit differs from itself"
  grep -qF 'The two were computed with the same values.' $page || fail "its recipe differs from itself"
  expect_exit 3 "$bin/talus" compare a none
  expect_error 'talus: none: there is no run.h5 in it. Name the folder of results of a run: what --out was, or out' \
    ' beside its recipe'
  expect_exit 2 "$bin/talus" compare a a
  expect_words 'this is the run itself'
}

# A made-up source: what was fetched is checked, added up and compared with what it must be.
made_up_table() {
  grid one.asc 'i == 0 ? -9999 : 100 + i'
  grid two.asc 'j == 0 ? -9999 : -1'
  mkdir sources
  mv one.asc two.asc sources/
  cat >table.toml <<TOML
[made-up]
title = "a slope that sinks by a metre"
folder = "made_up"
licence = "none needed"
repository = "https://example.org/made-up"
commit = "0123456789abcdef"
url = "file://$PWD/sources"
crs = "EPSG:32633"
sources = [{ name = "one.asc", sha256 = "$(sha256sum sources/one.asc | cut -d' ' -f1)" }, { name = "two.asc" }]
file = [
  { name = "before_dem.tif", sum = ["one.asc"], cells = 380, smallest = 101, largest = 119, mean = 110 },
  { name = "after_dem.tif", sum = ["one.asc", "two.asc"], cells = 380, smallest = 100, largest = 119, mean = 109.05 },
]
TOML
}

test_data_makes_a_made_up_example_from_its_sources() {
  made_up_table
  expect_exit 0 "$bin/talus" data --table table.toml
  local word
  for word in 'made-up: a slope' 'licence: none needed' 'commit: 0123' 'made: after_dem.tif = one.asc + two.asc' \
    'sha256 '; do
    grep -qF -- "$word" stdout || fail "the list does not show: $word"
  done
  expect_exit 0 "$bin/talus" data made-up --table table.toml --out data --from sources
  expect_stdout_paths
  gdalinfo data/made_up/after_dem.tif >info
  grep -qF '32633' info || fail "the CRS is missing"
  grep -qF 'url: file://' data/made_up/SOURCE.md || fail "SOURCE.md names no source"
  # Files already made are taken as they are.
  expect_exit 0 "$bin/talus" data made-up --table table.toml --out again --from data/made_up
  cmp data/made_up/after_dem.tif again/made_up/after_dem.tif || fail "the file that was there is another one"
  if command -v curl >/dev/null; then
    expect_exit 0 "$bin/talus" data made-up --table table.toml --out fetched
    [[ -f fetched/made_up/after_dem.tif ]] || fail "nothing was made of what was fetched"
  fi
}

# What is known of a file to the byte is told, and --exact insists on it; the same values in other bytes will do else.
test_data_compares_checksums_and_insists_on_them_when_asked() {
  made_up_table
  expect_exit 0 "$bin/talus" data made-up --table table.toml --out data --from sources
  local before=data/made_up/before_dem.tif after=data/made_up/after_dem.tif
  grep -qF "here: after_dem.tif  sha256 $(sha256sum $after | cut -d' ' -f1)" data/made_up/SOURCE.md ||
    fail "SOURCE.md does not say the checksum of what was made"
  grep -qF 'source: two.asc  sha256 not known' data/made_up/SOURCE.md || fail "SOURCE.md hides what is not known"
  expect_exit 3 "$bin/talus" data made-up --table table.toml --out exact --from data/made_up --exact
  expect_words 'before_dem.tif: no SHA-256 of it is known (--exact was asked for)'
  expect_exit 3 "$bin/talus" data made-up --table table.toml --out exact --from sources --exact
  expect_words 'two.asc: no SHA-256 of it is known'
  local name digest
  for name in before_dem.tif after_dem.tif; do
    digest=$(sha256sum data/made_up/$name | cut -d' ' -f1)
    sed -i "s/\"$name\",/& sha256 = \"$digest\",/" table.toml
  done
  expect_exit 0 "$bin/talus" data made-up --table table.toml --out exact --from data/made_up --exact
  ! grep -q warning stderr || fail "the same bytes are warned of: $(cat stderr)"
  gdal_translate -q -co COMPRESS=NONE $before other.tif
  mv other.tif $before
  expect_exit 0 "$bin/talus" data made-up --table table.toml --out other --from data/made_up
  expect_words 'before_dem.tif: other bytes than the file of the example (its SHA-256 is '
  expect_words 'number of cells, extremes and mean are the same. --exact refuses it'
  expect_exit 3 "$bin/talus" data made-up --table table.toml --out exact --from data/made_up --exact
  expect_words 'before_dem.tif: other bytes than the file of the example (its SHA-256 is '
  expect_words 'Leave --exact out'
}

# What is no raster comes along as it is, from a folder below those of the sources too.
test_data_copies_what_is_no_raster_and_refuses_other_bytes_of_it() {
  made_up_table
  mkdir sources/outlines
  echo 'an outline' >sources/outlines/release.shp
  local digest
  digest=$(sha256sum sources/outlines/release.shp | cut -d' ' -f1)
  sed -i 's/{ name = "two.asc" }/&, { name = "release.shp", folder = "outlines" }/' table.toml
  sed -i "s/^file = \[/&\n  { name = \"release.shp\", copy = \"release.shp\", sha256 = \"$digest\" },/" table.toml
  expect_exit 0 "$bin/talus" data made-up --table table.toml --out data --from sources
  cmp sources/outlines/release.shp data/made_up/release.shp || fail "the copy is another file"
  if command -v curl >/dev/null; then
    expect_exit 0 "$bin/talus" data made-up --table table.toml --out fetched
    cmp sources/outlines/release.shp fetched/made_up/release.shp || fail "what was fetched is another file"
  fi
  echo 'another outline' >sources/outlines/release.shp
  expect_exit 3 "$bin/talus" data made-up --table table.toml --out data --from sources
  expect_words 'release.shp: other bytes than the example was made of'
  echo 'another outline' >data/made_up/release.shp
  expect_exit 3 "$bin/talus" data made-up --table table.toml --out again --from data/made_up
  expect_words 'release.shp: other bytes than the file of the example'
}

test_data_refuses_other_sources_and_other_files() {
  made_up_table
  echo >>sources/one.asc
  expect_exit 3 "$bin/talus" data made-up --table table.toml --from sources
  expect_words 'one.asc: other bytes than the example was made of (its SHA-256 is '
  sed -i 's/, sha256 = "[0-9a-f]*"//; s/mean = 109.05/mean = 109.06/' table.toml
  expect_exit 3 "$bin/talus" data made-up --table table.toml --from sources
  expect_words 'after_dem.tif: what was made of its sources is not that file of the example (it has 380 cells'
  rm sources/two.asc
  expect_exit 3 "$bin/talus" data made-up --table table.toml --from sources
  expect_words 'two.asc: no such file'
  expect_exit 2 "$bin/talus" data made-pu --table table.toml --from sources
  expect_error 'talus: made-pu: no such example. Did you mean "made-up"?'
}

# The examples of this program, as somebody has them here.
test_data_knows_the_public_examples() {
  expect_exit 0 "$bin/talus" data
  [[ $(grep -c '^  licence: ' stdout) == 4 && $(grep -cE '^  commit: [0-9a-f]{40}$' stdout) == 4 ]] ||
    fail "an example has no licence or no commit"
  ! grep -E '^  made: .*sha256 not known' stdout || fail "no checksum is known of what is made"
  local data=$TALUS_SOURCE/../shared/data
  [[ -d $data ]] || skip "$data is not there: the public examples are not looked at"
  local name
  for name in cascade2021:cascade2021 frank-slide:frank_slide iseesnow:iseesnow_coulomb \
    iseesnow-realtopo:iseesnow_realtopo; do
    expect_exit 0 "$bin/talus" data "${name%:*}" --from "$data/${name#*:}" --out data --exact
    [[ -f $TALUS_SOURCE/pipelines/${name%:*}/recipe.toml ]] || fail "${name%:*} has no recipe"
  done
  expect_exit 3 "$bin/talus" data frank-slide --from "$data/cascade2021" --out data
}

# What a recipe could do better: said by check, by --plan, and in the report.
test_advice_is_said_before_the_run_and_in_the_report() {
  scene
  local set=(--set solve.end_time_s=0.5 --set solve.material.youngs_modulus_Pa=1e9)
  expect_exit 0 "$bin/talus" check recipe.toml "${set[@]}"
  expect_words 'advice: solve: end_time_s = 0.5 is likely before rest' 'stiffness = "auto"' \
    'advice: solve: youngs_modulus_Pa = 1e+09 makes'
  expect_exit 0 run "${set[@]}"
  expect_words 'advice: end_time_s = 0.5 is likely before rest'
  expect_exit 0 solve --plan "${set[@]}"
  expect_words 'advice: end_time_s = 0.5 is likely before rest'
  local word
  for word in 'end_time_s = 0.5 is likely before rest' 'the run ended before rest, at 0.5 s with ' \
    'the grid is coarse for this release'; do
    grep -qF -- "$word" out/report.html || fail "the report does not say: $word"
    grep -qF -- "$word" out/score.json || fail "the score does not say: $word"
  done
  # At rest, with a stiffness that is needed, there is nothing to say.
  expect_exit 0 run --set solve.end_time_s=60 --set solve.stop_kinetic_fraction=0.001
  ! grep -q 'advice: ' stderr || fail "advice without need: $(grep 'advice: ' stderr)"
  ! grep -q 'ended before rest' out/score.json || fail "a run that came to rest is said to have ended before"
}

test_without_a_command_or_with_a_wrong_one_it_says_how() {
  expect_exit 2 "$bin/talus"
  expect_error 'talus: no command was given. See talus --help'
  expect_exit 2 "$bin/talus" rum recipe.toml
  expect_exit 2 "$bin/talus" run
  expect_exit 0 "$bin/talus" --help
  grep -qF 'run' stdout || fail "--help names no command"
  expect_exit 0 "$bin/talus" run --help
  grep -qF -- '--set' stdout || fail "run --help names no option"
  expect_exit 0 "$bin/talus" --version
  grep -qE '^talus [0-9]+\.[0-9]+\.[0-9]+ \(' stdout || fail "no version"
}

run_test "$@"
