#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Keys of recipes and the members that hold them (docs/explanation/architecture.md).
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

unit='_(kg_m3|m3_s|m2_s|m_s2|m_s|m3|m2|m|s|deg|Pa_sn|kPa|Pa|N|MB)$'

# described FILE: "line kind key member" of every key that the file describes with a member.
described() {
  local file=$1 at text
  local visit='v\.(number|optional_number|integer|flag|text|path|numbers|pairs|integers)\('
  local call="($visit|(choice|list|table)\\(\\s*v,)"'\s*"[A-Za-z0-9_]+",\s*[A-Za-z_][A-Za-z0-9_.]*'
  { grep -zobP "$call" "$file" || true; } | tr '\n' ' ' | tr '\0' '\n' | while IFS=: read -r at text; do
    printf '%s %s\n' "$(($(head -c "$at" "$file" | wc -l) + 1))" \
      "$(sed -E 's/^(v\.)?([a-z_]+)\( *(v, *)?"([A-Za-z0-9_]+)", *([A-Za-z0-9_.]+) *$/\2 \4 \5/' <<<"$text")"
  done
}

# As published: a key is its member and the unit. A list may be called by the plural of its key; a key whose name
# without unit is another key of the same file may keep the unit; a word of C++ ends in an underscore.
test_a_key_is_its_member_and_the_unit() {
  cd "$TALUS_SOURCE"
  local file line kind key member plain count=0 wrong=""
  while IFS= read -r file; do
    described "$file" >"$TALUS_SCRATCH/keys"
    while read -r line kind key member; do
      count=$((count + 1))
      plain=$(sed -E "s/$unit//" <<<"$key")
      member=${member##*.}
      member=${member%_}
      [[ $member != "$plain" ]] || continue
      [[ $kind != list || $member != "${plain}s" ]] || continue
      if [[ $member == "$key" ]] && awk '{ print $3 }' "$TALUS_SCRATCH/keys" | grep -qx "$plain"; then continue; fi
      wrong+="$file:$line: key \"$key\" is read into $member, not $plain"$'\n'
    done <"$TALUS_SCRATCH/keys"
  done < <(grep -rlE --include='*.[ch]pp' '::describe\(|void describe\(' preprocess solver postprocess | sort)
  [[ $count -gt 150 ]] || fail "only $count keys were found: this test looks at nothing"
  [[ -z $wrong ]] || fail "keys and members differ:"$'\n'"$wrong"
}

run_test "$@"
