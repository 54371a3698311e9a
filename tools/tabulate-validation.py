#!/usr/bin/env python3
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes all rows of a run of `make validate` as one table, from its validation.json, which names commit and day.

usage: tools/tabulate-validation.py JSON... [MARKDOWN]        (default: validation-table.md beside the first JSON)
Several files hold cases of their own, made at one commit; files of different commits are refused.
"""
import json
import pathlib
import re
import sys
import textwrap


def number(value, digits=4):
    return "-" if value is None else f"{value:.{digits}g}"


def verdict(row):
    if "fault" in row:
        return "**failed**"
    if not row["judged"]:
        return ""
    return "met" if row["pass"] else "**missed**"


def table(rows):
    lines = ["| quantity | computed | reference | error | tolerance | | steps |", "|" + " --- |" * 7]
    for r in rows:
        if r["judged"]:
            edge = " (edge)" if r["tolerance"] == 0 else ""  # of the band that the value must lie in
            claims = [number(r["reference"], 5) + edge, number(r["error"], 2), number(r["tolerance"], 2)]
        else:
            claims = ["-", "-", "noted"]
        cells = [r["quantity"], number(r["computed"], 5), *claims, verdict(r), number(r["steps"], 6)]
        lines.append("| " + " | ".join(cells).replace("|  |", "| |") + " |")
    return lines


def read(files):
    """The sittings of the files; ends where they are of different commits, or name a case twice."""
    sittings = [json.loads(pathlib.Path(file).read_text()) for file in files]
    commits = {s["commit"] for s in sittings}
    if len(commits) > 1:
        sys.exit(f"tabulate-validation: the files are of different commits ({', '.join(sorted(commits))}): one table "
                 "shows one state. Run `make validate` again for the cases of the older one")
    cases = [case for s in sittings for case in s["cases"]]
    twice = sorted({case for case in cases if cases.count(case) > 1})
    if twice:
        sys.exit(f"tabulate-validation: {', '.join(twice)} in more than one file. Leave one of them out")
    return sittings


def heading(sittings, rows):
    """When and with what the rows were made, and how many there are of each kind."""
    days = sorted({s["date"] for s in sittings})
    places = sorted({re.sub(r", \d+ threads?$", "", r["place"]) for r in rows if r["place"]})
    kind = ("with the long runs" if all(s["complete"] for s in sittings) else
            "on coarse grids" if all(s["coarse"] for s in sittings) else
            "the quick runs" if not any(s["complete"] or s["coarse"] for s in sittings) else "some with the long runs")
    judged = [r for r in rows if r["judged"]]
    missed = [r for r in judged if not r["pass"]]
    noted = [r for r in rows if not r["judged"]]
    lost = [r for r in noted if "fault" in r]
    words = [f"Commit {sittings[0]['commit']}, {' and '.join(days)}, {kind}, on {'; '.join(places) or 'nothing'}.", "",
             *textwrap.wrap(f"Cases: {', '.join(case for s in sittings for case in s['cases'])}.", 120,
                            break_on_hyphens=False), "",
             f"{len(rows)} rows: {len(judged)} are judged, {len(missed)} of these miss their tolerance; "
             f"{len(noted)} are noted",
             f"and claim nothing, {len(lost)} of these without a result. Cases: docs/explanation/validation.md."]
    return words, len(missed)


def main():
    files = [a for a in sys.argv[1:] if a.endswith(".json")]
    others = [a for a in sys.argv[1:] if not a.endswith(".json")]
    if not files or len(others) > 1 or any(not a.endswith(".md") for a in others):
        sys.exit(__doc__)
    target = pathlib.Path(others[0]) if others else pathlib.Path(files[0]).with_name("validation-table.md")
    sittings = read(files)
    rows = [row for s in sittings for row in s["rows"]]
    words, missed = heading(sittings, rows)
    lines = ["# Rows of the validation", "", *words]
    name = None
    for r in rows:
        if r["case"] != name:
            name = r["case"]
            lines += ["", f"**{name}**", ""] + table([s for s in rows if s["case"] == name])
    target.write_text("\n".join(lines) + "\n")
    print(f"{target}: {len(rows)} rows, {missed} missed")


main()
