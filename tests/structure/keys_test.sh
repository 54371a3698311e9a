#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Keys of recipes and the members that hold them (docs/explanation/architecture.md).
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

# As published: a key is its member and the unit. A list may be called by the plural of its key; a key whose name
# without unit is another key of the same file may keep the unit; a word of C++ ends in an underscore.
test_a_key_is_its_member_and_the_unit() {
  cd "$TALUS_SOURCE"
  grep -rlE --include='*.[ch]pp' '::describe\(|void describe\(' preprocess solver postprocess | sort |
    xargs /usr/bin/python3 -c '
import re, sys
visit = r"v\.(?:number|optional_number|integer|flag|text|path|numbers|pairs|integers)\(|(choice|list|table)\(\s*v,"
call = re.compile(rf"(?:{visit})\s*\"([A-Za-z0-9_]+)\",\s*([A-Za-z_][A-Za-z0-9_.]*)")
unit = re.compile("_(kg_m3|per_m|m3_s|m2_s|m_s2|m_s|m3|m2|m|s|deg|Pa_sn|Pa_s|kPa|Pa|N|MB)$")
count, wrong = 0, []
for name in sys.argv[1:]:
    text = open(name, encoding="utf-8").read()
    members = [(m.start(), m[1], m[2], m[3].split(".")[-1].removesuffix("_")) for m in call.finditer(text)]
    keys = {key for _, _, key, _ in members}
    for at, kind, key, member in members:
        count += 1
        plain = unit.sub("", key)
        if member == plain or kind == "list" and member == plain + "s" or member == key and plain in keys:
            continue
        line = text.count("\n", 0, at) + 1
        wrong.append(f"{name}:{line}: key \"{key}\" is read into {member}, not {plain}")
if count <= 150:
    wrong = [f"only {count} keys were found: this test looks at nothing"]
sys.exit("\n".join(wrong) or None)' || fail "keys and members differ"
}

run_test "$@"
