#!/usr/bin/env python3
"""Writes docs/validation-table.md, all rows of one run of `make validate`, from its validation.json.

usage: tools/tabulate-validation.py JSON... "where, when, commit" [MARKDOWN]
Several files are of one sitting, each with cases of its own. A row without tolerance is noted, not judged.
"""
import json
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent


def number(value, digits=4):
    return "-" if value is None else f"{value:.{digits}g}"


def table(rows):
    lines = ["| quantity | computed | reference | error | tolerance | | steps |", "|" + " --- |" * 7]
    for r in rows:
        judged = r["tolerance"] is not None
        verdict = ("met" if r["pass"] else "**missed**") if judged else "" if r["pass"] else "**failed**"
        edge = " (edge)" if r["tolerance"] == 0 else ""  # of the band that the value must lie in
        error = number(r["error"], 2) if judged else "-"
        cells = [r["quantity"], number(r["computed"], 5), number(r["reference"], 5) + edge, error,
                 number(r["tolerance"], 2) if judged else "noted", verdict, number(r["steps"], 6)]
        lines.append("| " + " | ".join(cells).replace("|  |", "| |") + " |")
    return lines


def main():
    arguments = sys.argv[1:]
    files = [a for a in arguments if a.endswith(".json")]
    words = [a for a in arguments if not a.endswith((".json", ".md"))]
    target = next((pathlib.Path(a) for a in arguments if a.endswith(".md")), ROOT / "docs/validation-table.md")
    if not files or len(words) != 1:
        sys.exit(__doc__)
    rows = [row for file in files for row in json.loads(pathlib.Path(file).read_text())]
    judged = [r for r in rows if r["tolerance"] is not None]
    missed = [r for r in judged if not r["pass"]]
    lines = ["# Rows of the validation", "", f"{words[0]}.", "",
             f"{len(rows)} rows: {len(judged)} are judged, {len(missed)} of these miss their tolerance, the others are",
             "noted. Cases and what they mean: [validation.md](validation.md). Written by",
             "`tools/tabulate-validation.py`."]
    name = None
    for r in rows:
        if r["case"] != name:
            name = r["case"]
            lines += ["", f"**{name}**", ""] + table([s for s in rows if s["case"] == name])
    target.write_text("\n".join(lines) + "\n")
    print(f"{target}: {len(rows)} rows, {len(missed)} missed")


main()
