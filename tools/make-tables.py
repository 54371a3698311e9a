#!/usr/bin/env python3
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the tables of figures into the pages that show them, from the files that the measuring commands have left.

usage: tools/make-tables.py                        the tables of docs/benchmarks
       tools/make-tables.py --validation TABLE.md  the tables of the validation too, from what `make validate` writes
       tools/make-tables.py --scores OUT...        first read the scores of scenes from these folders of results

TABLE.md                               build/validation-table.md of `make validate LONG=1`: all rows of one commit
docs/benchmarks/speed-against-error.csv, kernels-h200.csv   of `make -C pipelines/benchmarks`
docs/benchmarks/scores.csv             of the scenes of pipelines/, by --scores
A page holds "<!-- table: NAME -->" and "<!-- end of table -->"; what stands between them is written here.
"""
import csv
import datetime
import json
import pathlib
import re
import sys
import textwrap
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGES = ["README.md", "docs/explanation/validation.md", "docs/explanation/performance.md"]
BLOCK = re.compile(r"(<!-- table: ([\w-]+) -->\n).*?(<!-- end of table -->)", re.S)
SCORES = ROOT / "docs/benchmarks/scores.csv"
REAL_EVENTS = ("ryggfonn2021", "cascade2021", "frank-slide")
DAY = "2026-11-26"  # of the rows of speed-against-error.csv, which name their commit alone
# What a case is, and what holds it; the cases in full are on the page of the validation.
CASES = {
    "A1": ("column under its own weight, implicit", "closed form"),
    "A2": ("cantilever, large deflection, implicit", "elastica"),
    "A3": ("sand column collapse, run-out and height", "Lube et al., Lajeunesse et al. (2005)"),
    "A3b": ("sand columns of seven aspect ratios", "the same experiments; the coarsest grid halved"),
    "A3c": ("round sand columns", "Lube et al. (2004)"),
    "A4": ("memory of the implicit scheme", "the reference paper's tables"),
    "B1": ("block on an incline, any direction", "Newton's law"),
    "B2": ("block on a bed that weakens with speed", "the integrated law"),
    "B3": ("heap on a parabola and a bend", "point with Coulomb friction"),
    "B4": ("granular cap on a plane", "Hutter et al. (1993)"),
    "B5": ("layer with a step (dam break)", "Mangeney et al. (2000)"),
    "B6": ("vibration, free fall, patch test", "exact"),
    "B7": ("block on a shaken plane", "Newmark (1965)"),
    "B8": ("blocks of unknown friction, an ensemble", "the closed form's distribution"),
    "C1": ("long implicit steps in a flow", "explicit steps of 0.1 CFL"),
    "D1": ("factor of safety, homogeneous slope", "Bishop & Morgenstern (1960)"),
    "D2": ("factor of safety with foundation", "Griffiths & Lane (1999)"),
    "D3": ("factor of safety, weak seam", "Giam & Donald (1989)"),
    "D4": ("factor of safety, wedge", "Hoek & Bray (1981)"),
    "D5": ("factor of safety, undrained vertical cut", "Martin (2011)"),
}


def rows_of_validation(table):
    """(case, quantity, error, tolerance, met) of every judged row that is no cost; and (commit, day, place)."""
    text, rows, case = table.read_text(encoding="utf-8"), [], ""
    heading = re.search(r"^Commit (\w+), ([\d-]+), .*? on (.*)\.$", text, re.M)
    for line in text.splitlines():
        name = re.match(r"\*\*([A-D]\d[a-z]?(?:-\w+)?) ?.*\*\*$", line)
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if name:
            case = name.group(1)
        elif len(cells) == 7 and cells[5].strip("*") in ("met", "missed", "failed") and not cells[0].startswith("cost"):
            error = None if cells[3] == "-" else float(cells[3])  # none: the run failed
            rows.append((case, cells[0], error, float(cells[4]), cells[5] == "met"))
    if not rows or not heading:
        sys.exit(f"tools/make-tables.py: {table} holds no judged rows. Write it: make validate LONG=1")
    return rows, heading.groups()


def percent(part):
    return "0" if part == 0 else f"{100 * part:.2g} %" if part >= 1e-4 else f"{part:.0e}"


def missed_first(cases, rows):
    missed = {row[0] for row in rows if not row[4]}
    return sorted(cases, key=lambda case: case not in missed)


def validated(table, cases, order=lambda cases, _: cases):
    rows, (commit, day, place) = rows_of_validation(table)
    lines = ["| case | against | met | median error | largest |", "| --- | --- | --- | --- | --- |"]
    for case in order(cases, rows):
        mine = [row for row in rows if row[0] == case]
        if not mine:
            continue
        errors = sorted(row[2] for row in mine if row[2] is not None)
        met = sum(row[4] for row in mine)
        middle, most = (percent(errors[len(errors) // 2]), percent(errors[-1])) if errors else ("-", "-")
        lines.append(f"| {case}: {CASES[case][0]} | {CASES[case][1]} | {met} of {len(mine)} | {middle} | {most} |")
    return [*lines, "", f"Commit {commit[:7]}, {day}, on {' and '.join(place.split('; '))}, by",
            "`make validate LONG=1`. The error of a quantity that must lie in a band is its distance from the band."]


def speed():
    """Least time of each method below bounds of the error, on the Frank Slide at one modulus and on one GPU."""
    with (ROOT / "docs/benchmarks/speed-against-error.csv").open(encoding="utf-8") as table:
        rows = [r for r in csv.DictReader(table) if r["set"] == "Frank Slide" and r["loop_s"] and
                r["elsewhere_than_finest_percent"] and float(r["spacing_m"]) > 10]
    names = {"column-implicit": "implicit along columns", "explicit": "explicit", "newton": "Newton (Newmark)",
             "reference preset": "the reference paper's scheme, as read here"}
    bounds = [6.0, 3.0, 2.1, 1.5]
    lines = ["| steps | " + " | ".join(f"error below {bound:g} %" for bound in bounds) + " | least error |",
             "|" + " --- |" * (len(bounds) + 2)]
    for method, name in names.items():
        mine = [(float(r["elsewhere_than_finest_percent"]), float(r["loop_s"])) for r in rows if r["method"] == method]
        times = [min((t for e, t in mine if e < bound), default=None) for bound in bounds]
        lines.append(f"| {name} | " + " | ".join("not reached" if t is None else f"{t:.2g} s" for t in times) +
                     f" | {min(e for e, _ in mine):.1f} % |")
    commit, machine = next((r["commit"], r["machine"].split(",")[0]) for r in rows if r["commit"])
    text = (f"Frank Slide, 100 s, Young's modulus 1e9 Pa for all, double precision, one {machine}, commit "
            f"{commit[:7]}, {DAY}, by `make -C pipelines/benchmarks speed-against-error`. Error: share of the deposit "
            "that lies elsewhere than on the finest grid. All methods were run on cells of 40 m; all but the "
            "reference paper's scheme on cells of 20 m too.")
    return [*lines, "", *textwrap.wrap(text, 120, break_on_hyphens=False)]


def kernels():
    with (ROOT / "docs/benchmarks/kernels-h200.csv").open(encoding="utf-8") as table:
        rows = [r for r in csv.DictReader(table) if r["method"] == "explicit"]
    lines = ["| shape, precision | points | step [ms] | s a point and step | memory [B a point] |",
             "| --- | --- | --- | --- | --- |"]
    for shape in ("linear", "quadratic"):
        for precision in ("single", "double"):
            mine = [r for r in rows if r["shape"] == shape and r["precision"] == precision]
            for wanted in (1e5, 1e6, 1e8):
                near = min(mine, key=lambda r: abs(int(r["points"]) / wanted - 1), default=None)
                if near and 0.5 < int(near["points"]) / wanted < 2:
                    lines.append(f"| {shape}, {precision} | {int(near['points']):,} | "
                                 f"{float(near['step_us']) / 1e3:.3g} "
                                 f"| {float(near['seconds_per_point_and_step']):.1e} | {near['bytes_per_point']} |")
    commits, days = sorted({r["commit"][:7] for r in rows}), sorted({r["date"] for r in rows})
    return [*lines, "", f"{rows[0]['place']}, explicit steps, commit {', '.join(commits)}, {', '.join(days)}, by "
            "`make -C pipelines/benchmarks kernels`."]


def scores():
    with SCORES.open(encoding="utf-8") as table:
        return list(csv.DictReader(table))


def number(text, digits, unit=""):
    return f"{float(text):,.{digits}f}{unit}" if text else "-"


def made(rows, words):
    return f"Commit {rows[0]['version'][:7]}, {rows[0]['day']}, {words}"


def events():
    rows = sorted((row for row in scores() if row["scene"] in REAL_EVENTS),
                  key=lambda row: REAL_EVENTS.index(row["scene"]))
    lines = ["| event | against | footprint | deposit | thickness RMSE | run-out | volume |",
             "|" + " --- |" * 7]
    for r in rows:
        event = f"[{r['title'].partition(',')[0]}](ROOTpipelines/{r['scene']}/README.md)"
        lines.append(f"| {event} | {r['survey']} | {number(r['footprint_csi'], 2)} | {number(r['deposit_csi'], 2)} | "
                     f"{number(r['thickness_rmse_m'], 1, ' m')} | {number(r['runout_difference_m'], 0, ' m')} | "
                     f"{number(r['deposit_volume_ratio'], 2)} |")
    return [*lines, "", made(rows, "by `make scores`. Friction: of Ryggfonn what RAMMS assigns, of the others chosen"),
            "with the reference in hand. Footprint and deposit: CSI, 1 is the same area. Run-out and volume of the "
            "deposit:", "simulated less, and over, surveyed."]


def scenes():
    rows = scores()
    lines = ["| scene | points | steps | released [m3] | run-out | fastest | footprint | deposit | packing | checks |",
             "|" + " --- |" * 10]
    for r in rows:
        lines.append(f"| `{r['scene']}` | {number(r['particles'], 0)} | {number(r['steps'], 0)} | "
                     f"{number(r['volume_released_m3'], 0)} | {number(r['runout_m'], 0, ' m')} | "
                     f"{number(r['max_peak_speed_m_s'], 1, ' m/s')} | {number(r['footprint_csi'], 2)} | "
                     f"{number(r['deposit_csi'], 2)} | {number(r['sanity_packing_p99'], 1)} | "
                     f"{'passed' if r['sanity'] == 'sane' else 'warned'} |")
    return [*lines, "", made(rows, f"on one {rows[0]['on']}, by `make scores`. Footprint and deposit: CSI against the"),
            "scene's survey or other model, where it has one. Packing: 99 % of the volume is packed no denser. Checks: "
            "last line", "of a run."]


def take_scores(folders):
    keys = ["scene", "title", "survey", "version", "day", "on", "particles", "steps", "volume_released_m3", "runout_m",
            "max_peak_speed_m_s", "footprint_csi", "deposit_csi", "thickness_rmse_m", "runout_difference_m",
            "deposit_volume_ratio", "sanity_packing_p99", "sanity"]
    rows = []
    for folder in map(pathlib.Path, folders):
        score = json.loads((folder / "score.json").read_text(encoding="utf-8"))
        used = tomllib.loads((folder / "postprocess.used.toml").read_text(encoding="utf-8"))
        score |= {"scene": folder.name, "survey": used["postprocess"].get("survey", {}).get("name", "")}
        version = re.search(r"\((\w+)\)", score["version"])
        rows.append({key: score.get(key, "") for key in keys} |
                    {"version": version.group(1) if version else score["version"], "day": day_of(folder)})
    for what in ("version", "on"):
        if len({row[what] for row in rows}) > 1:
            sys.exit(f"tools/make-tables.py: the scenes are of different commits or machines "
                     f"({', '.join(sorted({row[what] for row in rows}))}): one table shows one state. Run them again: "
                     "make scores")
    with SCORES.open("w", encoding="utf-8", newline="") as table:
        writer = csv.DictWriter(table, keys, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def day_of(folder):
    return datetime.date.fromtimestamp((folder / "score.json").stat().st_mtime).isoformat()


OF_VALIDATION = {
    "validated": lambda table: validated(table, ["A3", "A3b", "A3c", "B1", "B2", "B3", "B4", "B5", "B7", "C1", "D1",
                                                 "D4"]),
    "validation-cases": lambda table: validated(table, list(CASES), missed_first),
}
TABLES = {
    "speed": speed,
    "kernels": kernels,
    "events": events,
    "scenes": scenes,
}


def filled(path, validation):
    """The page's text with every table as the files have it now; those of the validation only where its rows are."""
    root = "../" * (len(path.relative_to(ROOT).parts) - 1)

    def block(match):
        name = match.group(2)
        if name in OF_VALIDATION and not validation:
            return match.group(0)
        lines = OF_VALIDATION[name](validation) if name in OF_VALIDATION else TABLES[name]()
        return match.group(1) + "\n".join(lines).replace("ROOT", root) + "\n" + match.group(3)
    return BLOCK.sub(block, path.read_text(encoding="utf-8"))


def main():
    kind, *rest = sys.argv[1:] or [""]
    if kind == "--scores":
        take_scores(rest)
    elif kind and (kind != "--validation" or len(rest) != 1):
        sys.exit(__doc__)
    validation = pathlib.Path(rest[0]) if kind == "--validation" else None
    if validation and not validation.is_file():
        sys.exit(f"tools/make-tables.py: {validation} was not found. Write it: make validate LONG=1")
    for name in PAGES:
        text = filled(ROOT / name, validation)
        if text != (ROOT / name).read_text(encoding="utf-8"):
            (ROOT / name).write_text(text, encoding="utf-8")
            print(ROOT / name)


if __name__ == "__main__":
    main()
