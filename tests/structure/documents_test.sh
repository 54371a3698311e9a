#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Documents that drift from the tree: commands, links, packages, paths.
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

# The project's text files: what git tracks or would track; outside a git checkout, all but the build folders.
project_files() {
  cd "$TALUS_SOURCE"
  if git rev-parse --is-inside-work-tree >/dev/null 2>&1; then
    git ls-files --cached --others --exclude-standard
  else
    find . -type f -not -path './build*' -not -path './pipelines/out/*' -printf '%P\n'
  fi | { xargs -d '\n' grep -lsI '' || true; }   # text that is there
}
documents() { project_files | grep -E '\.md$'; }

# Lines of code blocks and `inline code`, without prompts.
code_of() {
  awk '/^ *```/ { block = !block; next }
    block { print; next }
    { n = split($0, part, "`"); for (i = 2; i <= n; i += 2) print part[i] }' "$1"
}

test_readme_commands_are_makefile_targets() {
  cd "$TALUS_SOURCE"
  local found=0 document word
  for document in README.md CONTRIBUTING.md docs/how-to/user-guide.md; do
    while read -r word; do
      found=$((found + 1))
      grep -qE "^$word:" Makefile || fail "$document names 'make $word', which is no target of the Makefile"
    done < <(code_of "$document" | grep -oE '(^|[ ;&])make +[a-z][a-z-]*' | awk '{ print $NF }' | sort -u)
  done
  [[ $found -ge 4 ]] || fail "only $found make commands were found in the documents: this test looks at nothing"
  for word in demo test; do
    code_of README.md | grep -qE "^make $word( |$)" || fail "README.md does not show 'make $word'"
  done
}

test_pipelines_named_in_documents_exist() {
  cd "$TALUS_SOURCE"
  local found=0 document scene
  while read -r document; do
    while read -r scene; do
      found=$((found + 1))
      [[ $scene =~ ^(help|list|clean)$ || -f pipelines/$scene/recipe.toml ]] ||
        fail "$document names the scene '$scene', which has no recipe"
    done < <(code_of "$document" | { grep -oE 'make -C pipelines +[a-z][a-z0-9-]*' || true; } | awk '{ print $NF }')
  done < <(documents | xargs -d '\n' grep -l 'make -C pipelines')
  [[ $found -ge 2 ]] || fail "only $found pipeline commands were found in the documents: this test looks at nothing"
}

test_programs_named_in_readme_are_built() {
  cd "$TALUS_SOURCE"
  local program
  local documents=(README.md docs/how-to/user-guide.md docs/explanation/architecture.md docs/reference/formats.md)
  for program in $(grep -ohE '\btalus-[a-z-]*[a-z]' "${documents[@]}" | sort -u); do
    [[ $program =~ ^talus-(bundle|doc|gpu|recipe|run|seal|stage|tests).*$ || -x $bin/$program ]] ||
      fail "the documents name $program, which the build does not make"
  done
}

test_relative_links_lead_somewhere() {
  cd "$TALUS_SOURCE"
  local found=0 document link
  while read -r document link; do
    [[ -n $link && ! $link =~ ^(https?|mailto): && $link != '#'* ]] || continue
    found=$((found + 1))
    [[ -e ./${document%"${document##*/}"}${link%%#*} ]] || fail "$document links to $link, which does not exist"
  done < <(documents | xargs -d '\n' awk 'FNR == 1 { block = 0 } /^ *```/ { block = !block } !block {
    while (match($0, /^\[[^\]]+\]: [^ ]+|\]\([^) ]+/)) {
      if (substr($0, RSTART, 1) == "[") sub(/\]: /, "](")   # a definition of a reference
      match($0, /\]\([^) ]+/)
      print FILENAME, substr($0, RSTART + 2, RLENGTH - 2)
      $0 = substr($0, RSTART + RLENGTH)
    } }')
  [[ $found -ge 5 ]] || fail "only $found links were found in the documents: this test looks at nothing"
  found=$(documents | xargs -d '\n' grep -nE '^\[[^]]+\]: [^ ]+ +[^"]' || true)
  [[ -z $found ]] || fail "a definition of a link is none unless it stands alone on its line:"$'\n'"$found"
}

test_install_script_holds_every_package_named_in_cmake() {
  cd "$TALUS_SOURCE"
  local package packages named='s/.*talus_missing\((".*"|[^ ]*) +"?([^")]*)"?\).*/\2/p'
  packages=$(tools/install-dependencies.sh tests --list)
  for package in $(sed -nE "$named" cmake/dependencies.cmake | grep -v package); do
    grep -qx "$package" <<<"$packages" ||
      fail "cmake/dependencies.cmake asks for $package, which tools/install-dependencies.sh does not install"
  done
  grep -qx libgdal-dev <<<"$packages" || fail "no packages were found"
}

# A path of one person's machine in the sources works nowhere else.
test_no_file_names_a_machine() {
  cd "$TALUS_SOURCE"
  local found
  local patterns=(-e '/hom[e]/[a-z]' -e '/roo[t]/' -e '/User[s]/[a-z]' -e '(^|[^a-z0-9.}])/wor[k]/')
  # The folder of this very checkout, unless its name is as short as /src.
  if [[ $TALUS_SOURCE == /*/* ]]; then patterns+=(-e "$TALUS_SOURCE/"); fi
  found=$(project_files | xargs -d '\n' grep -nE "${patterns[@]}" || true)
  [[ -z $found ]] || fail "files name a place on one machine:"$'\n'"$found"
}

# lines_over COLUMNS: "file:line" of what is wider in the files named on stdin. Tables of figures, data and the licence
# are as they came.
lines_over() {
  local wider="^.{$(($1 + 1))}"
  { grep -vE '(^|/)LICENSE$|\.(csv|geojson)$' || true; } |
    { LC_ALL=C xargs -d '\n' grep -lE "$wider" || true; } |   # in bytes, which is faster
    LC_ALL=C.UTF-8 xargs -r -d '\n' grep -nHoE "$wider" | cut -d : -f 1,2 || true
}

test_no_line_is_over_120_columns() {
  cd "$TALUS_SOURCE"
  local found
  [[ $(project_files | lines_over 100 | wc -l) -gt 100 ]] || fail "no line is over 100 columns: this looks at nothing"
  found=$(project_files | lines_over 120)
  [[ -z $found ]] || fail "lines of more than 120 columns:"$'\n'"$found"
}

# The test itself: the one line that is too long is named; letters count, not bytes.
test_a_line_over_120_columns_is_named() {
  local line umlauts
  line=$(printf 'x%.0s' {1..120})
  umlauts=${line//x/ö}
  printf '%s\n' "$line" "$umlauts" >fits.sh
  printf '%s\n' "$line" "${umlauts}ö" "$line" >wide.md
  [[ $(printf '%s\n' fits.sh wide.md | lines_over 120) == wide.md:2 ]] ||
    fail "said: $(printf '%s\n' fits.sh wide.md | lines_over 120)"
}

# The code of the page on extension is that of sources which tests compile and run.
test_code_of_the_page_on_extension_is_tested() {
  cd "$TALUS_SOURCE"
  /usr/bin/python3 - docs/how-to/extend.md tests/postprocess/writers/profile.cpp \
    tests/solver/boundary/laws/speed_power.hpp python/examples/study_in_memory.py \
    <<'END' || fail "docs/how-to/extend.md shows code that no test runs"
import re, sys
page, *sources = [open(name).read() for name in sys.argv[1:]]
blocks = re.findall(r"```(?:cpp|python)\n(.*?)```", page, re.S)
sys.exit(len(blocks) != len(sources) or any(not s.endswith(b) for s, b in zip(sources, blocks)))
END
}

test_licence_is_the_gpl_3() {
  cd "$TALUS_SOURCE"
  grep -q 'GNU GENERAL PUBLIC LICENSE' LICENSE && grep -q 'Version 3, 29 June 2007' LICENSE ||
    fail "LICENSE is not the GNU General Public License, version 3"
}

run_test "$@"
