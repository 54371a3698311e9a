#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Folders are floors: a folder includes what lies below it, and itself (docs/explanation/architecture.md). Equations of
# docs/explanation/theory.md are named in the sources that compute them.
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

# The floors of a stage, the lowest first. Folders on one line do not include one another. A folder below another one is
# named by its path; '.' is the stage's own folder.
floors() {
  case $1 in
    common) printf '%s\n' . 'map recipe' stage 'domain run gis' 'ensemble qgis' ;;
    preprocess)
      printf '%s\n' 'options regions' 'terrain obstacle' 'survey release' particles laboratory scene output ensemble \
        slides .
      ;;
    solver)
      printf '%s\n' parallel state material grid transfer boundary water options elements linear/krylov \
        linear/operator \
        linear/preconditioner linear/direct integrator 'explicit column_implicit implicit' scene plan \
        run/recorders run ensemble .
      ;;
    postprocess)
      printf '%s\n' options survey fields hazard score writers maps 'picture three_d' report \
        'ensemble compare' .
      ;;
  esac
}

# violations STAGE: "file:line includes HEADER: FOLDER may use ..." for every include that goes up or across.
violations() {
  local stage=$1
  {
    floors "$stage"
    echo --
    grep -rnoE --include='*.hpp' --include='*.cpp' --include='*.cu' "^#include \"$stage/[^\"]+" "$stage" |
      sed 's/#include "//'
  } | awk -v stage="$stage" '
    function folder(path,   part) {            # the longest floor that holds the path
      sub("^" stage "/", "", path)
      sub("/?[^/]*$", "", path)
      for (part = path; part != ""; sub("/?[^/]*$", "", part)) if (part in level) return part
      return path == "" ? "." : path
    }
    $0 == "--" { table = 1; next }
    !table {
      for (i = 1; i <= NF; ++i) {
        level[$i] = NR
        below[$i] = NR > 1 ? lower : "nothing else"
        names = names ? names " " $i : $i
      }
      lower = names
      next
    }
    {
      n = split($0, piece, ":")
      from = folder(piece[1]); to = folder(piece[3])
      if (!(from in level)) { print piece[1] ": the folder " from " is on no floor"; next }
      if (!(to in level)) { print piece[1] ":" piece[2] " includes " piece[3] ", which is on no floor"; next }
      if (from == to || level[to] < level[from]) next
      print piece[1] ":" piece[2] " includes " piece[3] ": " stage "/" from " may use " below[from]
    }'
}

check() {
  cd "$TALUS_SOURCE"
  local found
  found=$(grep -rcE --include='*.hpp' "^#include \"$1/" "$1" | awk -F: '{ n += $2 } END { print n + 0 }')
  [[ $found -gt 10 ]] || fail "only $found includes were found in $1: this test looks at nothing"
  found=$(violations "$1")
  [[ -z $found ]] || fail "includes go down only:"$'\n'"$found"
}

test_common_includes_down_only() { check common; }
test_preprocess_includes_down_only() { check preprocess; }
test_solver_includes_down_only() { check solver; }
test_postprocess_includes_down_only() { check postprocess; }

# The test itself: an include that goes up is found, with its line and what the folder may use.
test_a_violation_names_file_line_and_floors() {
  mkdir -p solver/parallel solver/state
  printf '%s\n' '#pragma once' '#include "solver/state/clock.hpp"' >solver/parallel/loop.hpp
  printf '%s\n' '#include "solver/parallel/loop.hpp"' >solver/state/clock.hpp
  local found
  found=$(violations solver)
  [[ $found == 'solver/parallel/loop.hpp:2 includes solver/state/clock.hpp: solver/parallel may use nothing else' ]] ||
    fail "said: $found"
}

# headers_without_test: the headers of solver/ that no test includes directly. Two have nothing that a test could use:
# grid/instances.hpp and parallel/macros.hpp are macros for instantiating templates and marking functions; every kernel
# file of solver/ fails to compile or to link where they are wrong.
headers_without_test() {
  comm -23 <(find solver -name '*.hpp' | grep -vxE 'solver/(grid/instances|parallel/macros)\.hpp' | sort) \
    <(grep -rhoE --include='*.hpp' --include='*.cpp' --include='*.cu' '^#include "solver/[^"]+' tests/solver |
      sed 's/#include "//' | sort -u)
}

test_every_header_of_the_solver_is_included_by_a_test() {
  cd "$TALUS_SOURCE"
  local headers missing
  headers=$(find solver -name '*.hpp' | wc -l)
  [[ $headers -gt 50 ]] || fail "only $headers headers were found: this test looks at nothing"
  missing=$(headers_without_test)
  [[ -z $missing ]] || fail "no test includes these headers directly:"$'\n'"$missing"
}

# The test itself: a header that no test includes is found.
test_a_header_without_a_test_is_named() {
  mkdir -p solver/state solver/grid tests/solver/state
  touch solver/state/clock.hpp solver/state/loop.hpp solver/grid/instances.hpp
  printf '%s\n' '#include "solver/state/clock.hpp"' >tests/solver/state/clock_test.cpp
  local found
  found=$(headers_without_test)
  [[ $found == solver/state/loop.hpp ]] || fail "said: $found"
}

# (T12) at the end of a line of docs/explanation/theory.md is a number; in a source it names the equation that is
# computed there.
stated() { grep -oE '\(T[0-9]+[a-z]?\)$' "$TALUS_SOURCE/docs/explanation/theory.md" | tr -d '()'; }
named() {
  cd "$TALUS_SOURCE"
  grep -rhoE --include='*.hpp' --include='*.cpp' --include='*.cu' '\(T[0-9]+[a-z]?(, T[0-9]+[a-z]?)*\)' \
    common preprocess solver postprocess | tr -d '(),' | tr ' ' '\n' | sort -u
}

test_every_equation_has_one_number() {
  local twice
  [[ $(stated | wc -l) -gt 20 ]] || fail "only $(stated | wc -l) equations were found"
  twice=$(stated | sort | uniq -d)
  [[ -z $twice ]] || fail "docs/explanation/theory.md uses a number twice: $twice"
}

test_every_equation_is_named_where_it_is_computed() {
  local missing
  missing=$(comm -23 <(stated | sort -u) <(named))
  [[ -z $missing ]] || fail "no source names these equations of theory.md as (Tn): $(tr '\n' ' ' <<<"$missing")"
}

test_every_equation_that_a_source_names_is_stated() {
  local missing
  missing=$(comm -13 <(stated | sort -u) <(named))
  [[ -z $missing ]] || fail "sources name equations that theory.md does not state: $(tr '\n' ' ' <<<"$missing")"
}

run_test "$@"
