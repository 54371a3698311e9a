#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# What `cmake --install` lays where, and what is made of the programs' own descriptions: man pages and completions.
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"
manuals=$TALUS_BUILD/manuals
programs=(talus-preprocess talus-solve talus-postprocess talus-make-terrain)
if [[ -x $bin/talus ]]; then programs+=(talus); fi

need_manuals() {
  [[ -d $manuals/man ]] || skip "no manuals were made (a build with sanitizers, or without Python)"
}

# options PROGRAM: those that its --help, and that of its subcommands, names at the start of a line.
options() {
  local word
  {
    "$bin/$1" --help
    for word in $("$bin/$1" --help | sed -nE '1,/^Subcommands:/d; s/^  ([a-z-]+) .*/\1/p'); do
      "$bin/$1" "$word" --help
    done
  } | sed -nE 's/^ {1,4}(-[^ ]+).*/\1/p' | tr ',' '\n' | grep -E '^--?[a-zA-Z]' | sort -u
}

# installed: everything, in a folder of this test.
installed() {
  cmake --install "$TALUS_BUILD" --prefix "$TALUS_SCRATCH/prefix" >stdout 2>stderr || fail "cmake --install failed"
}

test_every_option_stands_in_man_page_and_completions() {
  need_manuals
  local program option found=0 page bash zsh
  for program in "${programs[@]}"; do
    page=$(gzip -dc "$manuals/man/$program.1.gz" | sed 's/\\-/-/g') bash=$(<"$manuals/bash/$program")
    zsh=$(<"$manuals/zsh/_$program")
    while read -r option; do
      found=$((found + 1))
      [[ $page == *"\\fB$option\\fR"* ]] || fail "the man page of $program does not know $option"
      [[ $bash == *[\'\ ]"$option"[\'\ ]* ]] || fail "bash does not complete $option of $program"
      [[ $zsh == *"$option["* ]] || fail "zsh does not complete $option of $program"
    done < <(options "$program")
  done
  [[ $found -gt 50 ]] || fail "only $found options were found in --help: this test looks at nothing"
}

# completed PROGRAM WORD...: what bash offers for the last word.
completed() {
  bash -c 'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); "_${1//-/_}"
    printf "%s\n" "${COMPREPLY[@]}"' completed "$manuals/bash/$1" "$@"
}

test_bash_completes_options_words_and_recipes() {
  need_manuals
  touch slide.toml notes.txt
  mkdir folder
  [[ $(completed talus-solve --thr) == --threads ]] || fail "--thr: $(completed talus-solve --thr)"
  [[ $(completed talus-solve recipe.toml --on '' | paste -sd ' ') == 'auto cpu gpu gpus' ]] || fail "the words of --on"
  [[ $(completed talus-solve '' | paste -sd ' ') == 'slide.toml folder' ]] || fail "$(completed talus-solve '')"
  [[ $(completed talus-solve --out '') == folder ]] || fail "--out offers $(completed talus-solve --out '')"
  [[ -z $(completed talus-solve --threads '') ]] || fail "--threads offers $(completed talus-solve --threads '')"
}

test_manuals_do_not_depend_on_the_machine() {
  need_manuals
  local program
  for program in "${programs[@]}"; do
    if grep -qE '[0-9]+ here|/(usr|tmp|hom[e])/' <(gzip -dc "$manuals/man/$program.1.gz"); then
      fail "the man page of $program names this machine"
    fi
  done
}

# Every key that a template names stands in the man page of the recipe.
test_recipe_page_holds_every_key() {
  need_manuals
  local stage key page found=0
  page=$'\n'$(gzip -dc "$manuals/man/talus-recipe.5.gz" | sed 's/\\-/-/g')
  for stage in preprocess solve postprocess; do
    while read -r key; do
      found=$((found + 1))
      [[ $page == *[^a-z_]"$key "* ]] || fail "talus-recipe(5) does not know $key of [$stage]"
    done < <("$bin/talus-$stage" --template | sed -nE 's/^#? ?([a-z][A-Za-z0-9_]*) = .*/\1/p' | sort -u)
  done
  [[ $found -gt 100 ]] || fail "only $found keys were found in the templates: this test looks at nothing"
}

test_man_pages_are_understood_by_man() {
  need_manuals
  command -v man >/dev/null || skip "man is not installed"
  local page said
  for page in "$manuals"/man/*.gz; do
    said=$(man --warnings=mac,syntax,escape -l "$page" 2>&1 >/dev/null || true)
    [[ -z $said ]] || fail "$page: $said"
  done
}

test_installed_programs_run_the_installed_recipe() {
  installed
  local program recipe=prefix/share/talus/pipelines/synthetic-valley/recipe.toml
  for program in "${programs[@]}"; do
    expect_exit 0 "prefix/bin/$program" --version
  done
  expect_exit 0 prefix/bin/talus-preprocess "$recipe" --out out --check
  expect_exit 0 make -C prefix/share/talus/pipelines list
  grep -qx synthetic-valley stdout || fail "the installed pipelines are: $(<stdout)"
  # The installed Makefile knows where the programs are, and leaves results where the user stands.
  expect_exit 0 make -C prefix/share/talus/pipelines -pn list
  grep -q "^BIN = .*/\.\./.*bin$" stdout || fail "BIN is $(grep '^BIN' stdout)"
  grep -qx "OUT = talus-out" stdout || fail "OUT is $(grep '^OUT' stdout)"
}

# Every recipe of the project is installed, and so is what it names by a path to the samples.
test_recipes_find_their_samples() {
  installed
  local recipe sample found=0
  for recipe in "$TALUS_SOURCE"/pipelines/*/recipe.toml; do
    recipe=${recipe#"$TALUS_SOURCE"/}
    [[ -f prefix/share/talus/$recipe ]] || fail "$recipe was not installed"
    while read -r sample; do
      found=$((found + 1))
      [[ -f prefix/share/talus/${recipe%/*}/$sample ]] || fail "$recipe names $sample, which was not installed"
    done < <(grep -hoE '\.\./\.\./data_samples/[^"]+' "prefix/share/talus/$recipe" | sort -u)
  done
  [[ $found -gt 10 ]] || fail "only $found samples are named: this test looks at nothing"
}

test_styles_documents_and_licences_are_installed() {
  installed
  local file
  if [[ -d $manuals/man ]]; then
    for file in man/man1/talus-solve.1.gz bash-completion/completions/talus-solve zsh/site-functions/_talus-solve; do
      [[ -s prefix/share/$file ]] || fail "share/$file was not installed"
    done
  fi
  for file in share/talus/styles/thick/deposit_thickness.qml share/talus/styles/thin/peak_speed.qml \
    share/talus/styles/thick/terrain.qml share/talus/python/talus/__init__.py \
    share/talus/python/examples/read_a_run.py share/doc/talus/LICENSE share/doc/talus/docs/how-to/user-guide.md; do
    [[ -s prefix/$file ]] || fail "$file was not installed"
  done
  compgen -G 'prefix/share/doc/talus*/copyright' >/dev/null || fail "no copyright file was installed"
  file=prefix/share/talus/styles/thick/deposit_thickness.qml
  grep -q '100 m' "$file" || fail "$file has no class above 100 m"
  file=prefix/share/talus/styles/thin/deposit_thickness.qml
  if grep -q '100 m' "$file"; then fail "$file has the classes of thick deposits"; fi
}

# Libraries whose scripts the report holds say their names in their own first lines.
test_report_names_the_licence_of_every_library_in_it() {
  local page=$TALUS_BUILD/postprocess/report/report_page.html name found=0
  local licences=$TALUS_SOURCE/postprocess/report/page/licences.txt
  while IFS= read -r name; do
    found=$((found + 1))
    grep -qF "$name" "$licences" || fail "$licences does not name $name, which the report holds"
    grep -qF "$name" "$TALUS_SOURCE/packaging/copyright" || fail "packaging/copyright does not name $name"
  done < <(sed -nE 's/^ \* (@?[A-Za-z][A-Za-z./-]*) v?[0-9]+\.[0-9]+.*/\1/p' "$page" | sort -u)
  [[ $found -ge 2 ]] || fail "only $found libraries were found in the report: this test looks at nothing"
}

# Not the dependencies as such, but that they are those of the programs: without GDAL nothing would start.
test_packages_ask_for_the_libraries_of_the_programs() {
  need_tool dpkg-shlibdeps
  expect_exit 0 "$TALUS_SOURCE/tools/make-packages.sh" "$TALUS_BUILD" packages -D CPACK_DEBIAN_COMPRESSION_TYPE=none
  local package library held
  package=$(compgen -G 'packages/talus_*.deb' || compgen -G 'packages/talus-gpu_*.deb') || fail "made: $(ls packages)"
  for library in gdal hdf5 openvdb netcdf cairo tbb cholmod openturns; do
    dpkg-deb -f "$package" Depends | grep -q "lib$library" || fail "it does not ask for lib$library"
  done
  held=$(dpkg-deb -c "$package" | awk '{ print $6 }')
  for file in usr/bin/talus-solve usr/lib/talus/libtalus-openturns.so usr/share/man/man1/talus-solve.1.gz \
    usr/share/doc/talus/copyright usr/share/zsh/vendor-completions/_talus-solve \
    usr/share/talus/pipelines/ensemble.py usr/share/talus/pipelines/ensemble.sbatch \
    usr/share/talus/pipelines/synthetic-valley/recipe.toml usr/share/talus/styles/thick/deposit_thickness.qml; do
    grep -qE "^\./${file/doc\/talus/doc/talus(-gpu)?}$" <<<"$held" || fail "$package holds no $file"
  done
  if grep -qE 'talus-(tests|validate|bench)' <<<"$held"; then fail "$package holds tests"; fi
  dpkg-deb -x "$package" tree
  ! readelf -d tree/usr/bin/talus-solve | grep -iE 'r(un)?path' | grep -qvF ': [$ORIGIN/../lib:$ORIGIN/../lib/talus]' ||
    fail "a path of this machine is in it"
  dpkg-deb -c packages/talus-doc_*.deb | grep 'usr/share/doc/talus/docs/explanation/theory.md' >found ||
    fail "talus-doc has no documents"
}

# The package with kernels for GPUs takes the place of the one without.
test_packages_by_name_exclude_one_another() {
  local rules=$TALUS_SOURCE/cmake/package_names.cmake
  expect_exit 0 cmake -DPROJECT_VERSION=1.2.3 -DTALUS_WITH_CUDA=OFF -P "$rules"
  grep -qx -- '-- Package: talus, conflicts with talus-gpu, provides: ' stdout || fail "$(<stdout)"
  expect_exit 0 cmake -DPROJECT_VERSION=1.2.3 -DTALUS_WITH_CUDA=ON -P "$rules"
  grep -qx -- '-- Package: talus-gpu, conflicts with talus, provides: talus (= 1.2.3)' stdout || fail "$(<stdout)"
}

run_test "$@"
