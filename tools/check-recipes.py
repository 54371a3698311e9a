#!/usr/bin/python3
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Random recipes within the ranges that the reader allows, on a tiny scene: --bin build/bin --out DIR [--count N]

Keys, defaults, ranges and words come from `--template` of each program, so that new keys are drawn by themselves. Each
recipe changes 1 to 8 keys (uniform). A number is drawn

    with 1/2   log-uniform from a tenth to ten times its default (or of 1 where that is 0),
    with 3/10  log-uniform over twelve decades around it,
    with 1/5   from what hurts: bounds of its range, just inside them, 1e-300, 1e300, 0, the negative, huge integers,

is brought into its range, and words and flags are uniform. Everything follows from --seed and the recipe's number.

Each recipe ends in one of these ways, and anything else is a fault:

    result   exit 0 of all stages; maps finite, volume kept, nothing faster than its energy allows, within
             --time (of processor time)
    refused  exit 2 or 3 (before the run) or 4 (the computation failed), with words that name a key, a file or a mend
    stopped  still going at --time, which it had said before (the number of steps and points: more than a thousand steps
             of the scene's 128 points; implicit steps and the search for the factor of safety announce none); ended by
             SIGTERM within 5 s and the time of the steps between sorts, with 130 and a word on how to go on

Written to OUT: table.csv, and the folder of each recipe that is a fault. Exit 1 where there is one.
"""
import argparse
import collections
import concurrent.futures
import csv
import json
import math
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import time

STAGES = ("preprocess", "solve", "postprocess")
SECONDS_A_POINT = 10e-6  # of processor time that talus-preprocess may take to make and write a point it announced
# Keys that name files, places or other items of a recipe: a random text says nothing about numbers.
LEFT_OUT = {"end_time_s", "accept", "working_crs", "classes_m"}
# Tables that nothing can be said in without a file.
LEFT_OUT_TABLES = {"solve.shaking"}
Key = collections.namedtuple("Key", "table name default words low high open_low open_high whole")


def template_keys(binary):
    """Keys of plain tables with their defaults and ranges; lists of tables are left out."""
    text = subprocess.run([binary, "--template"], capture_output=True, text=True, check=True).stdout
    keys, table, help_line = [], "", ""
    for line in text.splitlines():
        if line.startswith("["):
            table = line.strip("[]")
        elif line.startswith("# # ") or line.startswith("# [["):
            table = ""  # an example of a list
        elif line.startswith("# "):
            help_line = line
        elif " = " in line and table and not line.startswith("#"):
            name, value = line.split(" = ", 1)
            key = parsed(table, name, value, help_line)
            if key:
                keys.append(key)
    return keys


def parsed(table, name, value, help_line):
    found = re.search(r"\[([^\[\]]*)\]$", help_line)
    inside = found.group(1) if found else ""
    default = json.loads(value.replace("'", '"')) if not value.startswith('"') else value[1:-1]
    words = re.findall(r'"([^"]*)"', inside)
    curve = isinstance(default, list) and any(isinstance(item, list) for item in default)
    if name in LEFT_OUT or table in LEFT_OUT_TABLES or curve or (isinstance(default, str) and not words):
        return None
    low, high, open_low, open_high = -math.inf, math.inf, False, False
    for sign, number in re.findall(r"(>=|<=|>|<) (-?[0-9.e+-]+)", inside):
        if sign[0] == ">":
            low, open_low = float(number), sign == ">"
        else:
            high, open_high = float(number), sign == "<"
    both = re.fullmatch(r"(-?[0-9.e+-]+) to (-?[0-9.e+-]+)", inside)
    if both:
        low, high = float(both.group(1)), float(both.group(2))
    whole = "." not in value and "e" not in value and not words
    return Key(table, name, default, words, low, high, open_low, open_high, whole)


def within(key, value):
    low = math.nextafter(key.low, math.inf) if key.open_low else key.low
    high = math.nextafter(key.high, -math.inf) if key.open_high else key.high
    value = min(max(value, low), high)
    if key.whole:
        value = int(min(max(value, -2**31), 2**31 - 1))
        if key.low > -math.inf:
            value = max(value, math.ceil(key.low))
        return int(min(value, key.high)) if key.high < math.inf else value
    return value


def number(rng, key, default):
    scale = abs(default) if default else 1.0
    sign = -1 if default < 0 or (key.low < 0 and rng.random() < 0.2) else 1
    way = rng.random()
    if way < 0.5:
        return within(key, sign * scale * 10 ** rng.uniform(-1, 1))
    if way < 0.8:
        return within(key, sign * scale * 10 ** rng.uniform(-6, 6))
    hurts = [0.0, 1e-300, 1e300, -1e300, 1e-9, 1e9, -scale, 2**31 - 1, 1e17]
    for bound in (key.low, key.high):
        if math.isfinite(bound):
            hurts += [bound, bound + 1e-6, bound - 1e-6]
            hurts += [math.nextafter(bound, math.inf), math.nextafter(bound, -math.inf)]
    return within(key, rng.choice(hurts))


def drawn(rng, key):
    if key.words:
        return json.dumps(rng.choice(key.words))
    if isinstance(key.default, bool):
        return "true" if rng.random() < 0.5 else "false"
    if isinstance(key.default, list):
        return "[%s]" % ", ".join(toml(number(rng, key, d)) for d in key.default)
    return toml(number(rng, key, key.default))


def toml(value):
    text = repr(value)
    return text if isinstance(value, int) or any(c in text for c in ".e") else text + ".0"


def ascii_grid(path, value):
    rows = ["ncols 20\nnrows 20\nxllcorner 500000\nyllcorner 5000000\ncellsize 10\nNODATA_value -9999\n"]
    for j in range(19, -1, -1):
        rows.append(" ".join("%.6g" % value(10 * i + 5, 10 * j + 5, i, j) for i in range(20)) + "\n")
    path.write_text("".join(rows))


def bowl(x, y):
    return 0.004 * ((x - 100) ** 2 + (y - 100) ** 2)


def scar(i, j):
    return 3 <= i < 7 and 8 <= j < 12


def make_scene(folder):
    """A bowl of 20 x 20 cells of 10 m in which 4 x 4 cells, 4 m thick, fail: 128 points at the start."""
    ascii_grid(folder / "before.asc", lambda x, y, i, j: bowl(x, y))
    lobe = lambda i, j: 7 <= i < 11 and 8 <= j < 12
    ascii_grid(folder / "after.asc", lambda x, y, i, j: bowl(x, y) - 4 * scar(i, j) + 3 * lobe(i, j))
    ascii_grid(folder / "survey.asc", lambda x, y, i, j: 2.0 * lobe(i, j))


FIXED = {
    "preprocess": 'before_dem = "../before.asc"\nafter_dem = "../after.asc"\n',
    "solve": "end_time_s = 3.0\n",
    "postprocess": "",
    "postprocess.survey": 'thickness = "../survey.asc"\n',
}
USUAL = {"preprocess.grid": {"layer_height_m": "2.0"}, "solve": {"frame_interval_s": "1.0"}}


def recipe_text(changes):
    tables = {name: {} for name in ("preprocess", "solve", "postprocess", "postprocess.survey")}
    for table, values in USUAL.items():
        tables.setdefault(table, {}).update(values)
    for key, value in changes:
        tables.setdefault(key.table, {})[key.name] = value
    text = '[scene]\nname = "drawn"\n'
    for table, values in tables.items():
        text += f"\n[{table}]\n" + FIXED.get(table, "") + "".join(f"{k} = {v}\n" for k, v in values.items())
    return text


class Fault(Exception):
    pass


def processor_time(pid):
    """Seconds of processor time that a process has taken, which other processes do not lengthen; None: it is gone."""
    try:
        fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    except (OSError, IndexError):
        return None
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def wait(process, limit):
    """True where it ended within so many seconds of processor time, or fifty times that on the clock."""
    begun = time.monotonic()
    first = processor_time(process.pid) or 0
    while process.poll() is None:
        spent = processor_time(process.pid)
        if (spent is not None and spent - first > limit) or time.monotonic() - begun > 50 * limit:
            return False
        time.sleep(0.02)
    return True


def run(command, limit, log):
    """Exit code and stderr; "stopped" instead of the code where it was still going at the limit."""
    with log.open("w") as stream:
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=stream, start_new_session=True)
    if wait(process, limit):
        return process.returncode, log.read_text(errors="replace")
    longer = SECONDS_A_POINT * announced_points(log.read_text(errors="replace")) - limit
    if longer > 0 and wait(process, longer):
        return process.returncode, log.read_text(errors="replace")
    process.send_signal(signal.SIGTERM)
    # A run saves its state where points are sorted, 32 steps from there or 8 of many points: a microsecond for a
    # point and step.
    points = re.search(r"(\d+) material points, ", log.read_text(errors="replace"))
    many = int(points.group(1)) if points else 0
    allowed = 5 + max(4, 8e-6 * many)
    if not wait(process, allowed):
        process.kill()
        process.wait()
        raise Fault(f"it does not end within {allowed:.0f} s of processor time after SIGTERM")
    said = log.read_text(errors="replace")
    if process.returncode not in (0, 130):
        raise Fault(f"exit {process.returncode} after SIGTERM: {said[-300:]}")
    return ("stopped" if process.returncode == 130 else 0), said


def refusal(code, said):
    """The words of a clear refusal; a fault where they are none."""
    lines = [line for line in said.splitlines() if re.match(r"talus-\w+: ", line)]
    if code not in (2, 3, 4) or not lines or "this is a bug" in said:
        raise Fault(f"exit {code}: {said[-400:]}")
    named = re.search(r"[a-z]+_[a-z]|\[\w+|\.(vdb|h5|asc)|--\w+|\b[a-z]+ = |\bcfl\b", lines[0])
    if not named or "nan" in lines[0].lower().split():
        raise Fault(f"a refusal that names no key, file or option: {lines[0]}")
    return lines[0]


def check_history(out, text):
    rows = list(csv.DictReader((out / "history.csv").open()))
    if not rows:
        raise Fault("history.csv is empty")
    for before, row in zip([rows[0], *rows], rows):
        # No force is known of a time in which matter left.
        may_lack = ("gauge", "ground_force") if row["outflow_m3"] != before["outflow_m3"] else ("gauge",)
        for name, value in row.items():
            if not math.isfinite(float(value)) and not name.startswith(may_lack):
                raise Fault(f"history.csv: {name} = {value} at {row.get('time_s')} s")


def check_maps(out):
    from osgeo import gdal

    gdal.UseExceptions()
    for file in sorted((out / "maps").glob("*.tif")):
        raster = gdal.Open(str(file))  # a band does not keep its raster
        band = raster.GetRasterBand(1)
        data, nodata = band.ReadRaster(buf_type=gdal.GDT_Float64), band.GetNoDataValue()
        for value in memoryview(data).cast("d"):
            if not math.isfinite(value) and not (nodata is not None and math.isnan(nodata) and math.isnan(value)):
                raise Fault(f"{file.name} holds {value}")


def check_results(out, changed):
    score = json.loads((out / "score.json").read_text())
    numbers = flat(score)
    for name, value in numbers.items():
        if isinstance(value, float) and not math.isfinite(value):
            raise Fault(f"score.json: {name} = {value}")
    check_history(out, changed)
    check_maps(out)
    fastest = numbers.get("max_peak_speed_m_s")
    # What the relief of the scene (80 m and the thickness) gives at most; other forces are other bounds.
    pushed = {"gravity_m_s2", "initial_velocity_m_s"} & {key.name for key, _ in changed}
    bound = math.sqrt(2 * 9.81 * 84) * 1.05
    if fastest is not None and not pushed and fastest > bound:
        raise Fault(f"peak speed {fastest:.1f} m/s, energy allows {bound:.1f}")


def flat(node):
    if not isinstance(node, dict):
        return {}
    found = {}
    for key, value in node.items():
        if isinstance(value, dict):
            found.update(flat(value))
        elif isinstance(value, (int, float)) and not isinstance(value, bool):
            found[key] = float(value)
    return found


def announced_work(said):
    """Steps times points, as the solver spoke of them before its first step, and the steps alone."""
    found = re.findall(r"(?:about|gravity is brought on first, in) ([0-9.e+]+|inf) steps", said)
    points = re.search(r"(\d+) material points", said)
    steps = max(map(float, found), default=0.0)
    return steps * (int(points.group(1)) if points else 0), steps


def announced_points(said):
    """The material points that talus-preprocess spoke of before it made them; 0: of none, or of so many that it warned
    of the time."""
    found = re.search(r"material points: ([\d,]+)", said)
    return int(found.group(1).replace(",", "")) if found and "to make so many takes long" not in said else 0


def judged(args, folder, changes):
    """How a recipe ends: (way, words)."""
    out = folder / "out"
    for stage in STAGES:
        command = [args.bin / f"talus-{stage}", folder / "recipe.toml", "--out", out, "--threads", "1"]
        command += ["--on", "cpu"] if stage == "solve" else []
        code, said = run([str(word) for word in command], args.time, folder / f"{stage}.log")
        if code == "stopped":
            work, steps = announced_work(said)
            if stage == "preprocess" and "to make so many takes long" in said:
                return "stopped", "many material points were announced"
            text = (folder / "recipe.toml").read_text()
            implicit = "integrator" in text or "factor_of_safety = true" in text
            if stage != "solve" or not (implicit or work > 1000 * 128):
                raise Fault(f"{stage} still goes on after {args.time:g} s; it spoke of {steps:g} steps: {said[-200:]}")
            if "--restart" not in said and "run the stage again" not in said:
                raise Fault(f"stopped without a word on how to go on: {said[-200:]}")
            return "stopped", f"{steps:.3g} steps were announced"
        if code != 0:
            return f"refused by {stage} ({code})", refusal(code, said)
    check_results(out, changes)
    return "result", ""


def one(args, n, keys):
    """Draws a recipe, runs it, and says how it ended: a row of the table."""
    rng = random.Random(f"{args.seed}/{n}")
    chosen = rng.sample(keys, rng.randint(1, 8))
    always = [key for key in keys if f"{key.table}.{key.name}" in args.always]
    if always and not any(key in chosen for key in always):
        chosen.append(rng.choice(always))
    changes = [(key, drawn(rng, key)) for key in chosen]
    folder = args.out / f"recipe-{n:04d}"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    (folder / "recipe.toml").write_text(recipe_text(changes))
    begun = time.monotonic()
    try:
        way, words = judged(args, folder, changes)
        shutil.rmtree(folder)
    except Fault as fault:
        way, words = "FAULT", str(fault)
    return [n, way, f"{time.monotonic() - begun:.1f}", words.replace("\n", " | "),
            "; ".join(f"{key.table}.{key.name} = {value}" for key, value in changes)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=pathlib.Path, required=True, help="folder of the programs")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder to work in")
    parser.add_argument("--count", type=int, default=500)
    parser.add_argument("--first", type=int, default=0, help="number of the first recipe")
    parser.add_argument("--seed", type=int, default=20)
    parser.add_argument("--time", type=float, default=20, help="seconds of processor time that a stage may take")
    parser.add_argument("--always", action="append", default=[], metavar="TABLE.KEY",
                        help="every recipe has this key, or one of these")
    parser.add_argument("--jobs", type=int, default=1, help="recipes at a time")
    args = parser.parse_args()
    args.bin = args.bin.resolve()
    keys = [key for stage in STAGES for key in template_keys(args.bin / f"talus-{stage}")]
    args.out.mkdir(parents=True, exist_ok=True)
    make_scene(args.out)
    ways, longest = collections.Counter(), 0.0
    with (args.out / "table.csv").open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["recipe", "end", "seconds", "words", "changes"])
        with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
            drawn_ones = [pool.submit(one, args, n, keys) for n in range(args.first, args.first + args.count)]
            for done in concurrent.futures.as_completed(drawn_ones):
                row = done.result()
                writer.writerow(row)
                file.flush()
                ways[row[1]] += 1
                longest = max(longest, float(row[2]))
                if row[1] == "FAULT":
                    print(f"recipe {row[0]}: {row[3]}\n    {row[4]}", flush=True)
    print(f"{args.count} recipes, seed {args.seed}, {len(keys)} keys, {args.time:g} s a stage:")
    for way, count in sorted(ways.items()):
        print(f"  {count:5d}  {way}")
    print(f"longest {longest:.1f} s; {args.out / 'table.csv'}")
    return 1 if ways["FAULT"] else 0


if __name__ == "__main__":
    sys.exit(main())
