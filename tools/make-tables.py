#!/usr/bin/env python3
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the tables of figures into the pages that show them, from the files that the measuring commands have left.

usage: tools/make-tables.py                        the tables of docs/benchmarks
       tools/make-tables.py --validation JSON...   first read the rows of `make validate` from its validation.json
       tools/make-tables.py --scores OUT...        first read the scores of scenes from these folders of results

docs/benchmarks/speed-against-error.csv, kernels.csv   of `make -C pipelines/benchmarks`
docs/benchmarks/gpu-tests.csv          of `make test-gpu`
docs/benchmarks/validation.csv         all rows of `make validate LONG=1`, by --validation; files of different cases
                                       made at one commit are put together, others are refused
docs/benchmarks/scores.csv             of the scenes of pipelines/, by --scores
Then every section of README, docs/explanation and pipelines/*/README.md whose prose states a figure with a unit has to
name its source: a commit, a day, a publication by its year, a table of these, a case, a test, a command, or the page
where that stands. The exit status is 1 where one does not, and each is named.

A page holds "<!-- table: NAME -->" and "<!-- end of table -->"; what stands between them is written here.
"""
import csv
import datetime
import json
import math
import pathlib
import re
import sys
import textwrap
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGES = ["README.md", *(f"docs/explanation/{page}.md" for page in ("validation", "performance", "architecture"))]
BLOCK = re.compile(r"(<!-- table: ([\w-]+) -->\n).*?(<!-- end of table -->)", re.S)
SCORES = ROOT / "docs/benchmarks/scores.csv"
VALIDATION = ROOT / "docs/benchmarks/validation.csv"
REAL_EVENTS = ("ryggfonn2021", "cascade2021", "frank-slide")
# What a case is, and what holds it; the cases in full are on the page of the validation.
CASES = {
    "A1": ("column under its own weight", "closed form"),
    "A1b": ("column compacted to a third", "closed form, order"),
    "A2": ("cantilever, large deflection", "elastica"),
    "A2-loads": ("cantilever, growing load", "elastica"),
    "A3": ("sand column", "laboratories (2005)"),
    "A3-paper": ("sand column, the paper's scheme", "laboratories (2005)"),
    "A3b": ("sand columns, low to tall", "the same; cells halved"),
    "A3c": ("round sand columns", "the same; cells halved"),
    "B1": ("block on an incline", "Newton's law"),
    "B2": ("block on a weakening bed", "integrated law"),
    "B3": ("heap on a parabola and a bend", "point with Coulomb friction"),
    "B4": ("granular cap on a plane", "Hutter et al. (1993)"),
    "B5": ("dam break on a slope", "Mangeney et al. (2000)"),
    "B6": ("vibration, fall, patch test", "exact"),
    "B7": ("block on a shaken plane", "Newmark (1965)"),
    "B8": ("blocks of unknown friction", "distribution in closed form"),
    "C1": ("long implicit steps in a flow", "explicit steps of 0.1 CFL"),
    "D1": ("factor of safety, slope", "Bishop & Morgenstern (1960)"),
    "D2": ("the same with foundation", "Griffiths & Lane (1999)"),
    "D3": ("the same with weak seam", "Giam & Donald (1989)"),
    "D4": ("factor of safety, wedge", "Hoek & Bray (1981)"),
    "D5": ("factor of safety, vertical cut", "Martin (2011)"),
    "E1": ("columns of beads in a fluid", "Webb (2024)"),
    "E2": ("debris-flow flume", "noted"),
}


def take_validation(files):
    """validation.csv from the files of `make validate`: of one commit, and every case once."""
    sittings = [json.loads(pathlib.Path(file).read_text(encoding="utf-8")) for file in files]
    commits = sorted({sitting["commit"] for sitting in sittings})
    if len(commits) != 1:
        sys.exit(f"tools/make-tables.py: the files are of different commits ({', '.join(commits)}): one table shows "
                 "one state. Run `make validate` again for the cases of the older one")
    cases = [case for sitting in sittings for case in sitting["cases"]]
    if twice := sorted({case for case in cases if cases.count(case) > 1}):
        sys.exit(f"tools/make-tables.py: {', '.join(twice)} in more than one file. Leave one of them out")
    keys = ("case quantity judged computed lowest highest error tolerance pass steps place").split()
    with VALIDATION.open("w", encoding="utf-8", newline="") as table:
        writer = csv.DictWriter(table, [*keys, "commit", "date"], lineterminator="\n", extrasaction="ignore")
        writer.writeheader()
        for sitting in sittings:
            writer.writerows(row | {"commit": commits[0], "date": sitting["date"]} for row in sitting["rows"])


def rows_of_validation():
    """The judged rows that are no cost, by case."""
    with VALIDATION.open(encoding="utf-8") as table:
        rows = [row for row in csv.DictReader(table)
                if row["judged"] == "True" and not row["quantity"].startswith("cost")]
    cases = {}
    for row in rows:
        case = re.match(r"[A-Z]\d[a-z]?(?:-\w+)?", row["case"]).group()
        if case not in CASES:
            sys.exit(f"tools/make-tables.py: {VALIDATION.name} has rows of {case}, which CASES does not describe")
        cases.setdefault(case, []).append(row)
    return cases


def value(text):
    return float(text) if text else math.nan


def used(row):
    """Which part of what it may err a number has used up: 1 at the tolerance or at the end of a band."""
    computed, low, high, tolerance = (value(row[key]) for key in ("computed", "lowest", "highest", "tolerance"))
    if math.isnan(computed):
        return math.inf  # the run failed
    if low == high:
        return value(row["error"]) / tolerance if tolerance else 0 if row["pass"] == "True" else math.inf
    if math.isnan(low) or math.isnan(high):
        return computed / high if math.isnan(low) else low / computed if computed else math.inf
    low, high = low - tolerance * abs(low), high + tolerance * abs(high)
    return abs(computed - (low + high) / 2) / ((high - low) / 2)


def percent(part):
    return f"{100 * part:.2g} %"


def beside(row):
    """"7.5 (5.0 to 7.1)": a number with what is wanted of it."""
    computed, low, high, tolerance = (value(row[key]) for key in ("computed", "lowest", "highest", "tolerance"))
    if math.isnan(computed):
        return "no result"
    if low == high == 0:
        return f"{computed:.2g} (at most {tolerance:.2g})"
    if math.isnan(low) or math.isnan(high):
        return f"{computed:.4g} ({f'at most {high:.4g}' if math.isnan(low) else f'at least {low:.4g}'})"
    wanted = f"{low:.4g}" if low == high else f"{low:.3g} to {high:.3g}"
    return f"{computed:.4g} ({wanted}{f', {percent(tolerance)}' if tolerance else ''})"


def validation():
    """Cases with missed rows first, and of each the row that is furthest beyond or nearest to what it may be."""
    cases = rows_of_validation()
    lines = ["| case | against | missed | close | worst row: computed (wanted, tolerance) |", "|" + " --- |" * 5]
    for case, rows in sorted(cases.items(), key=lambda item: -max(map(used, item[1]))):
        missed, worst = sum(row["pass"] == "False" for row in rows), max(rows, key=used)
        name = textwrap.shorten(worst["quantity"].partition(",")[0], 22, placeholder=" ...")
        close = sum(row["pass"] == "True" and used(row) <= 0.1 for row in rows)
        lines.append(f"| {case}: {CASES[case][0]} | {CASES[case][1]} | {f'**{missed}**' if missed else 0} of "
                     f"{len(rows)} | {close} | {name} {beside(worst)} |")
    rows = [row for mine in cases.values() for row in mine]
    places = sorted({re.sub(r", \d+ threads?$", "", row["place"]) for row in rows if row["place"]})
    days = sorted({row["date"] for row in rows})
    text = (f"Commit {rows[0]['commit'][:7]}, {' and '.join(days)}, on {' and '.join(places)}, by `make validate "
            "LONG=1`. "
            "Close: met with at most a tenth of the tolerance, or of the way from the middle of a band to its end. "
            "Laboratories: Lube et al. (2004, 2005) and Lajeunesse et al. (2005), of both what lies within a tenth.")
    return [*lines, "", *textwrap.wrap(text, 120, break_on_hyphens=False)]


def commits_and_days(rows, commit, day):
    """"commit 1a2b3c4, 2026-11-26" of the rows; tables made before they had a column of days name none."""
    commits, days = ({r.get(column) for r in rows} - {None, ""} for column in (commit, day))
    return ", ".join([f"commit {', '.join(sorted(c[:7] for c in commits))}", *sorted(days)])


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
    machine = next(r["machine"].split(",")[0] for r in rows if r["machine"])
    text = (f"Frank Slide, 100 s, Young's modulus 1e9 Pa for all, double precision, one {machine}, "
            f"{commits_and_days(rows, 'commit', 'date')}, by `make -C pipelines/benchmarks speed-against-error`. "
            "Error: share of the deposit that lies elsewhere than on the finest grid. All methods were run on cells of "
            "40 m; all but the reference paper's scheme on cells of 20 m too.")
    return [*lines, "", *textwrap.wrap(text, 120, break_on_hyphens=False)]


def kernels():
    with (ROOT / "docs/benchmarks/kernels.csv").open(encoding="utf-8") as table:
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
    return [*lines, "", f"{rows[0]['place']}, explicit steps, {commits_and_days(rows, 'commit', 'date')}, by "
            "`make -C pipelines/benchmarks kernels`."]


def gpu_tests():
    with (ROOT / "docs/benchmarks/gpu-tests.csv").open(encoding="utf-8") as table:
        rows = list(csv.DictReader(table))
    passed = sum(row["result"] == "passed" for row in rows)
    text = (f"Of {len(rows)} cases of `tests/solver` that use a GPU {passed} passed on one {rows[0]['machine']}, "
            f"{commits_and_days(rows, 'commit', 'date')} (`make test-gpu`).")
    return textwrap.wrap(text, 120, break_on_hyphens=False)


def scores():
    with SCORES.open(encoding="utf-8") as table:
        return list(csv.DictReader(table))


def number(text, digits, unit=""):
    return f"{float(text):,.{digits}f}{unit}" if text else "-"


def made(rows, words):
    return f"C{commits_and_days(rows, 'version', 'day')[1:]}, {words}"


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
            "with the reference in hand; that of Frank is another model's run, and Cascade's source is 4 cells across.",
            "Footprint and deposit: CSI of what is thicker than 0.1 m, 1 is the same area. Run-out and volume of the",
            "deposit: simulated less, and over, surveyed."]


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


TABLES = {
    "validation": validation,
    "speed": speed,
    "kernels": kernels,
    "gpu-tests": gpu_tests,
    "events": events,
    "scenes": scenes,
}


def filled(path):
    """The page's text with every table as the files have it now."""
    root = "../" * (len(path.relative_to(ROOT).parts) - 1)
    return BLOCK.sub(lambda match: match.group(1) + "\n".join(TABLES[match.group(2)]()).replace("ROOT", root) + "\n" +
                     match.group(3), path.read_text(encoding="utf-8"))


FIGURE = re.compile(r"(?<![\w.-])\d+(?:[.,]\d+)*(?: to \d+(?:\.\d+)?)? ?(?:%|m/s|ms\b|s\b|µs|GB|MB|min(?:utes)?\b)")
SOURCE = re.compile(r"\b(?=[0-9a-f]*\d)[0-9a-f]{7,9}\b|\b(?:18|19|20)\d\d\b|<!-- table|\]\(|\b[A-D]\d[a-z]?\b|`make |"
                    r"tests?\b.*`")


def without_source():
    """Sections with figures in their prose and no source, "page: heading (first figures)". The theory defines."""
    pages = ["README.md", *ROOT.glob("docs/explanation/*.md"), *ROOT.glob("pipelines/*/README.md")]
    for page in sorted(ROOT / page for page in pages):
        text = re.sub(r"^(```.*?^```|    [^\n]*)$", "", page.read_text(encoding="utf-8"), flags=re.S | re.M)
        for section in re.split(r"^(?=#)", text, flags=re.M):
            prose = "\n".join(line for line in section.splitlines() if not line.startswith("|"))
            figures = FIGURE.findall(prose)
            if figures and not SOURCE.search(section) and page.name != "theory.md":
                heading = section.partition("\n")[0].lstrip("# ")
                yield f"{page.relative_to(ROOT)}: {heading} ({', '.join(figures[:3])})"


def main():
    kind, *files = sys.argv[1:] or [""]
    take = {"": None, "--scores": take_scores, "--validation": take_validation}
    if kind not in take or bool(kind) != bool(files):
        sys.exit(__doc__)
    for file in files:
        if not pathlib.Path(file).exists():
            sys.exit(f"tools/make-tables.py: {file} was not found. It is written by make "
                     f"{'scores' if kind == '--scores' else 'validate LONG=1'}")
    if kind:
        take[kind](files)
    for name in PAGES:
        text = filled(ROOT / name)
        if text != (ROOT / name).read_text(encoding="utf-8"):
            (ROOT / name).write_text(text, encoding="utf-8")
            print(ROOT / name)
    if unsaid := list(without_source()):
        sys.exit("tools/make-tables.py: these sections name no source of their figures:\n" + "\n".join(unsaid))


if __name__ == "__main__":
    main()
