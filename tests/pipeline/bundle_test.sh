#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# The relocatable bundle: it stands alone, wherever it lies.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

# bundle [OPTION]: the bundle of this build, as a folder beside the test's other files.
bundle() {
  local options=("$@" --to "$TALUS_SCRATCH" --no-archive)
  (cd "$TALUS_SOURCE" && tools/make-bundle.sh "$TALUS_BUILD" "${options[@]}") >stdout 2>stderr ||
    fail "make-bundle.sh failed"
}

# Every library a program of the bundle names is in the bundle, or belongs to glibc or to GCC's run-time.
stands_alone() {
  local program soname path own='^(lib(c|m|mvec|dl|pthread|rt|resolv|util|anl|stdc\+\+|gcc_s|cuda)\.so)'
  for program in "$1"/bin/*; do
    if ! head -c 4 "$program" | grep -q ELF; then continue; fi
    while read -r soname path; do
      [[ $path == "$1"/bin/../lib/* || $soname =~ $own ]] ||
        fail "$program takes $soname from '$path'"
    done < <(env -i ldd "$program" | awk '$2 == "=>" { print $1, $3 }')
  done
}

test_whole_pipeline_runs_from_a_bundle_that_was_moved() {
  need_tool patchelf
  scene
  bundle
  grep -qE 'bundle: [0-9.]+M, [0-9]+ programs, [0-9]+ libraries' stdout || fail "no sizes were printed"
  mv bundle moved
  stands_alone "$PWD/moved"
  local stage
  for stage in preprocess solve postprocess; do
    expect_exit 0 env -i moved/bin/talus-$stage recipe.toml --out out
  done
  [[ -s out/score.json && -s out/map.png ]] || fail "no results"
  printf '%s\n' '[ensemble]' 'members = 2' '[[ensemble.vary]]' 'key = "solve.base.friction_angle_deg"' \
    'low = 20.0' 'high = 30.0' >>recipe.toml
  expect_exit 0 env -i moved/bin/talus-preprocess recipe.toml --out ensemble   # it loads OpenTURNS of the bundle
  carries_what_people_need moved
}

# carries_what_people_need BUNDLE: recipes, styles, a README, no tests, and the licence of each library.
carries_what_people_need() {
  local file library notices=$1/share/doc/notices list
  for file in README.md LICENSE share/talus/pipelines/synthetic-valley/recipe.toml \
    share/talus/data_samples/valley/before_dem.tif share/talus/styles/thick/deposit_thickness.qml; do
    [[ -s $1/$file ]] || fail "the bundle has no $file"
  done
  if compgen -G "$1/bin/talus-tests-*" >/dev/null; then fail "the bundle holds tests"; fi
  list=$(<"$notices/README.md")
  for library in "$1"/lib/*; do
    library=${library##*/}
    [[ $library == libtalus-* || $list == *[\|,]" $library"[,\ ]* ]] || fail "no notice names $library"
  done
  while IFS= read -r file; do
    [[ -s $notices/$file ]] || fail "the list of notices names $file, which is not there"
  done < <(grep -oE '\([^)]+\.txt\)' "$notices/README.md" | tr -d '()')
  grep -q 'libjs-leaflet' "$notices/README.md" || fail "nothing is said of what is compiled in"
}

test_solver_bundle_holds_the_solver_without_gdal() {
  need_tool patchelf
  bundle --solver
  stands_alone "$PWD/bundle-solver"
  [[ -x bundle-solver/bin/talus-solve && ! -e bundle-solver/bin/talus-preprocess ]] ||
    fail "in the bundle: $(ls bundle-solver/bin)"
  if compgen -G 'bundle-solver/lib/libgdal*' >/dev/null; then fail "the solver's bundle holds GDAL"; fi
  # OpenVDB takes 57 MB, the BLAS and LAPACK behind CHOLMOD 45 MB; GDAL and its company would add 100 MB. Executables
  # grow with the kernels.
  [[ $(du -sm bundle-solver/lib | cut -f 1) -lt 140 ]] || fail "its libraries are large: $(<stdout)"
}

run_test "$@"
