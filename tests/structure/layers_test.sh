#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Who may include whom, and which library stands where (docs/explanation/architecture.md).
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"
cd "$TALUS_SOURCE"

# includes FOLDER...: "file: header" of every #include below, tests left out.
includes() {
  grep -rHoE --include='*.hpp' --include='*.cpp' --include='*.cu' --include='*.cuh' --include='*.h' \
    '^[[:space:]]*#[[:space:]]*include[[:space:]]*[<"][^>"]+' "$@" 2>/dev/null | sed -E 's/:.*[<"]/: /' || true
}

# refuse WHY: fails when stdin holds anything.
refuse() {
  local found
  found=$(cat)
  [[ -z $found ]] || fail "$1:"$'\n'"$found"
}

some_includes() {
  [[ $(includes "$1" | wc -l) -gt 5 ]] || fail "no includes were found in $1: this test looks at nothing"
}

test_stages_include_common_and_never_one_another() {
  cd "$TALUS_SOURCE"
  local stage other
  for stage in preprocess solver postprocess; do
    some_includes $stage
    for other in preprocess solver postprocess data_samples tests; do
      [[ $stage == "$other" ]] || includes $stage | grep -E ": $other/" || true
    done
  done | refuse "a stage includes another (they meet only in files)"
}

test_talus_includes_of_each_stage_its_stage_hpp_alone() {
  cd "$TALUS_SOURCE"
  some_includes talus
  local stage
  for stage in preprocess solver postprocess; do
    includes talus | grep -qF ": $stage/stage.hpp" || fail "talus/ does not include $stage/stage.hpp"
  done
  includes talus | { grep -E ': (preprocess|solver|postprocess|data_samples|tests)/' || true; } |
    { grep -vE ': (preprocess|solver|postprocess)/stage\.hpp$' || true; } |
    refuse "talus/ includes more of a stage than its stage.hpp"
}

test_library_stands_on_top() {
  cd "$TALUS_SOURCE"
  some_includes library
  includes common preprocess solver postprocess talus | { grep -E ': library/' || true; } |
    refuse "a folder below includes the library"
}

test_programs_of_the_stages_are_one_call() {
  cd "$TALUS_SOURCE"
  local stage
  for stage in preprocess solver postprocess; do
    [[ $(wc -l <$stage/main.cpp) -lt 20 ]] || fail "$stage/main.cpp holds more than its call of run_stage()"
  done
}

test_common_knows_no_stage() {
  cd "$TALUS_SOURCE"
  some_includes common
  includes common | { grep -E ': (preprocess|solver|postprocess|data_samples|tests)/' || true; } |
    refuse "common/ includes a stage"
}

# No way round through ../: includes name their file from the project's root.
test_includes_start_at_the_root() {
  cd "$TALUS_SOURCE"
  includes common preprocess solver postprocess talus | { grep -F '../' || true; } |
    refuse "an include climbs out of its folder"
}

# private_headers PATTERN FOLDER...: headers that include what matches PATTERN may be included by sources of their own
# folder only.
private_headers() {
  local pattern=$1 header
  shift
  for header in $(includes "$@" | sed -nE "s#\.(hpp|h|cuh): $pattern.*#.\1#p" | sort -u); do
    includes common preprocess solver postprocess data_samples | grep -E ": $header$" |
      grep -vE "^$(dirname "$header")/[a-z_0-9]+\.cpp:" || true
  done
}

test_gdal_stands_behind_gis_and_the_outer_stages() {
  cd "$TALUS_SOURCE"
  local gdal='(gdal|ogr|cpl_|vrt)'
  includes common solver | { grep -E ": $gdal" || true; } | { grep -vE '^common/q?gis/' || true; } |
    refuse "GDAL is included outside common/gis and common/qgis"
  private_headers "$gdal" common preprocess postprocess | { grep -v '^common/qgis/' || true; } |
    refuse "a header that includes GDAL is included outside its folder's sources"
  includes solver | { grep -E ': common/(gis|qgis)/' || true; } |
    refuse "the solver includes common/gis, which stands for GDAL"
}

test_solver_does_not_link_gdal() {
  [[ -x $bin/talus-solve ]] || fail "$bin/talus-solve is not built"
  ldd "$bin/talus-solve" >"$TALUS_SCRATCH/stdout"
  grep -q libopenvdb "$TALUS_SCRATCH/stdout" || fail "ldd shows no OpenVDB in talus-solve: is this the right file?"
  { grep -E 'libgdal|libproj|libnetcdf' "$TALUS_SCRATCH/stdout" || true; } |
    refuse "talus-solve links GDAL or what belongs to it"
}

# OpenVDB's headers do not compile under nvcc, and are slow.
test_openvdb_stands_in_sources_only() {
  cd "$TALUS_SOURCE"
  includes common preprocess solver postprocess | { grep -E '\.(cu|cuh): openvdb/' || true; } |
    refuse "OpenVDB is included in a kernel file"
  private_headers 'openvdb/' common preprocess solver postprocess talus |
    refuse "a header that includes OpenVDB is included outside its folder's sources"
}

test_only_parallel_names_cuda_tbb_and_thrust() {
  cd "$TALUS_SOURCE"
  local words='\b(cuda[A-Z][A-Za-z]*|cub::|tbb::|thrust::|__global__|__device__|__host__|__shared__|__CUDACC__'
  words+='|__CUDA_ARCH__)|<<<|[<"](tbb|oneapi|thrust|cub|cuda)[/_a-z]*\.?h?'
  grep -rnE --include='*.hpp' --include='*.cpp' --include='*.cu' --include='*.cuh' "$words" solver | sed -E 's#//.*##' |
    { grep -E "$words" || true; } | { grep -v '^solver/parallel/' || true; } |
      refuse "CUDA, TBB or Thrust is named outside solver/parallel/"
  grep -rqE 'tbb::' solver/parallel || fail "solver/parallel/ does not name TBB: this test looks at nothing"
}

run_test "$@"
