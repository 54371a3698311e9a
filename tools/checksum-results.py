#!/usr/bin/env python3
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checksums of results, to see whether a change of the code has changed a number.

    tools/checksum-results.py --bin build/bin --out DIR [--data DIR] [--only TEXT] > table.txt
    tools/checksum-results.py --compare before.txt after.txt

It runs the laboratory scenes below, the pipelines on the project's samples and, where the data are there, Frank Slide
on cells of 40 m, all on the CPU, and prints a line for each data set of run.h5, each map, each table and each number of
score.json: scene, name, SHA-256 of the values. The bits depend on the machine's mathematical library and on the
compiler: compare tables of one machine only. Needs python3-h5py, python3-numpy and python3-gdal.
"""
import argparse
import hashlib
import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent

# A block of 8 x 6 x 4 m on a slope, 12 layers of points deep in all.
SLOPE = """
[scene]
name = "slope"
title = "Block on a slope"
[preprocess.grid]
spacing_m = 1.0
layer_height_m = {layer}
points_per_cell = [2, 2, 2]
[preprocess.laboratory]
cells = [36, 16]
corner_m = [0.0, 0.0, 0.0]
slope = [{slope}, 0.05]
[[preprocess.box]]
name = "upper"
extent_m = [20.0, 5.0, 24.0, 11.0, 0.0, 3.0]
[[preprocess.box]]
name = "lower"
extent_m = [16.0, 5.0, 20.0, 11.0, 0.0, 3.0]
"""

# name: (keys of [solve], tables after it, {layer, slope})
VARIANTS = {
    "quadratic-apic": ("", "", {}),
    "single": ('precision = "single"', "", {}),
    "linear-flip": ('shape = "linear"\ntransfer = "flip"', "", {}),
    "gimp": ('shape = "gimp"', "", {}),
    "musl-damped": ('stress_update = "musl"\ndamping = 0.1', "", {}),
    "budget": ("energy_budget = true", "", {}),
    "deterministic": ("deterministic = true", "", {}),
    "cartesian-nodes": ('mapping = "cartesian"', "", {}),
    "cohesion-dilatancy": (
        "",
        "[solve.material]\ncohesion_Pa = 500.0\ndilatancy_angle_deg = 5.0\n" "tension_cutoff_Pa = 100.0\n",
        {},
    ),
    "pore-softening": (
        "",
        "[solve.material]\npore_pressure_ratio = 0.3\nsoftening_slip_m = 0.5\n"
        "residual_friction_angle_deg = 15.0\ncohesion_Pa = 1000.0\n",
        {},
    ),
    "plane-strain": ("", '[solve.material]\ncone = "plane-strain"\ndilatancy_angle_deg = 2.0\n', {}),
    "extension": ("", '[solve.material]\ncone = "extension"\n', {}),
    "hencky": ("", '[solve.material]\nmodel = "hencky"\n', {}),
    "corotated": ("", '[solve.material]\nmodel = "corotated"\n', {}),
    "linear-elastic": ("", '[solve.material]\nmodel = "linear-elastic"\n', {}),
    "parts": (
        "energy_budget = true",
        '[[solve.part]]\nrelease = "lower"\ndensity_kg_m3 = 1500.0\n'
        "softening_slip_m = 0.2\nresidual_friction_angle_deg = 10.0\n",
        {},
    ),
    "voellmy": ("", '[solve.base]\nlaw = "voellmy"\nturbulence_m_s2 = 300.0\nfriction_angle_deg = 12.0\n', {}),
    "weakening": ("", '[solve.base]\nlaw = "velocity-weakening"\ncharacteristic_speed_m_s = 2.0\n', {}),
    "samosat": ("", '[solve.base]\nlaw = "samosat"\nminimum_shear_Pa = 100.0\n', {}),
    "pouliquen": ("", '[solve.base]\nlaw = "pouliquen"\nlayer_length_m = 0.5\n', {}),
    "bartelt": ("", '[solve.base]\nlaw = "voellmy"\nbartelt_cohesion_Pa = 300.0\n', {}),
    "no-friction": ("", '[solve.base]\nlaw = "none"\n', {}),
    "stick": ("", '[solve.base]\nlaw = "stick"\n', {}),
    "base-cohesion-pore": ("", "[solve.base]\ncohesion_Pa = 300.0\npore_pressure_ratio = 0.4\n", {}),
    "stiffness-auto": ("", '[solve.material]\nyoungs_modulus_Pa = 1e9\nstiffness = "auto"\n', {}),
    "walls": (
        "",
        '[[solve.wall]]\naxis = "x"\nposition_m = 10.0\nkind = "frictional"\nfriction_angle_deg = 25.0\n'
        '[[solve.wall]]\naxis = "y"\nposition_m = 5.0\nto_s = 0.4\n',
        {},
    ),
    "load": (
        "",
        "[[solve.load]]\nextent_m = [20.0, 5.0, 22.0, 8.0, 0.0, 3.0]\nforce_N = [1e5, 0.0, 0.0]\n" "ramp_s = 0.5\n",
        {},
    ),
    "gravity-loading": ("gravity_loading_steps = 4", "", {}),
    "initial-velocity": ("initial_velocity_m_s = [-2.0, 0.5, 0.0]", "", {}),
    "fine-layers": ("", "", {"layer": 0.5}),
    "separation-none": ("", '[solve.base]\nseparation = "none"\n', {"slope": 0.8}),
    "column-implicit": ('integrator = "column-implicit"', "", {"layer": 0.5}),
    "column-implicit-single": ('integrator = "column-implicit"\nprecision = "single"\nshape = "gimp"', "", {}),
    "column-implicit-budget": ('integrator = "column-implicit"\nenergy_budget = true\ndamping = 0.1', "", {}),
    "column-implicit-musl": ('integrator = "column-implicit"\nstress_update = "musl"', "", {}),
    "column-implicit-points": (
        'integrator = "column-implicit"\nmapping = "cartesian"\nground_contact = "points"',
        "",
        {},
    ),
    "column-implicit-walls": (
        'integrator = "column-implicit"',
        '[[solve.wall]]\naxis = "x"\nposition_m = 10.0\nkind = "frictional"\nfriction_angle_deg = 25.0\n'
        '[[solve.wall]]\naxis = "y"\nposition_m = 5.0\nto_s = 0.4\n',
        {},
    ),
    "column-implicit-samosat": (
        'integrator = "column-implicit"',
        '[solve.base]\nlaw = "samosat"\nminimum_shear_Pa = 100.0\nseparation = "thin"\n',
        {"slope": 0.8},
    ),
    "column-implicit-pouliquen": (
        'integrator = "column-implicit"',
        '[solve.base]\nlaw = "pouliquen"\nlayer_length_m = 0.5\n',
        {},
    ),
    "newmark": ('integrator = "newmark"', "", {}),
    "newmark-single": ('integrator = "newmark"\nprecision = "single"', "", {}),
    "newmark-gimp": ('integrator = "newmark"\nshape = "gimp"', "", {}),
    "newmark-voellmy": ('integrator = "newmark"', '[solve.base]\nlaw = "voellmy"\ncohesion_Pa = 100.0\n', {}),
    "newmark-weakening": ('integrator = "newmark"', '[solve.base]\nlaw = "velocity-weakening"\n', {}),
    "newmark-samosat": ('integrator = "newmark"', '[solve.base]\nlaw = "samosat"\n', {}),
    "newmark-musl-flip": ('integrator = "newmark"\nstress_update = "musl"\ntransfer = "flip"\ndamping = 0.05', "", {}),
    "newmark-cholesky": ('integrator = "newmark"', '[solve.implicit]\nlinear_solver = "cholesky"\n', {}),
    "newmark-b-bar": (
        'integrator = "newmark"',
        "[solve.implicit]\nb_bar = true\n[solve.material]\n" "poisson_ratio = 0.45\n",
        {},
    ),
    "newmark-load-walls": (
        'integrator = "newmark"',
        '[[solve.wall]]\naxis = "x"\nposition_m = 12.0\n'
        "[[solve.load]]\nextent_m = [20.0, 5.0, 22.0, 8.0, 0.0, 3.0]\n"
        "force_N = [1e5, 0.0, 0.0]\n",
        {},
    ),
    "reference": ('preset = "reference"', "[solve.implicit]\nstep_s = 0.005\n", {}),
    "auto": ('integrator = "auto"\nlargest_step_s = 0.05', "", {}),
    "quasi-static": (
        'integrator = "quasi-static"\ngravity_ramp_s = 1.0\nend_time_s = 1.0\nhistory_interval_s = 0.25',
        '[solve.implicit]\nstep_s = 0.1\n[solve.material]\nmodel = "hencky"\n' '[solve.base]\nlaw = "stick"\n',
        {},
    ),
    "quasi-static-cholesky": (
        'integrator = "quasi-static"\ngravity_ramp_s = 1.0\nend_time_s = 1.0\nshape = "linear"',
        '[solve.implicit]\nstep_s = 0.1\nlinear_solver = "cholesky"\n[solve.material]\n'
        'model = "corotated"\n[solve.base]\nlaw = "stick"\n',
        {},
    ),
}

# Left out here, because its choice of integrator follows the time that the machine takes.
TIMED = {"auto"}


def merged(keys, tables, numbers):
    """The recipe of a laboratory variant; a table stated twice is put together."""
    text = SLOPE.format(layer=numbers.get("layer", 1.0), slope=numbers.get("slope", 0.5))
    given = {line.split("=")[0].strip() for line in keys.splitlines()}
    defaults = {"end_time_s": 1.0, "frame_interval_s": 0.5, "history_interval_s": 0.1}
    text += "[solve]\n" + "".join(f"{k} = {v}\n" for k, v in defaults.items() if k not in given) + keys + "\n"
    if "[solve.base]" not in tables:
        tables += "[solve.base]\nfriction_angle_deg = 18.0\n"
    return text + tables


def digest(array):
    """SHA-256 of the values of an array, with its type and shape."""
    import numpy

    array = numpy.asarray(array)
    if array.dtype == object:
        return hashlib.sha256(repr(array.tolist()).encode()).hexdigest()[:20]
    head = f"{array.dtype} {array.shape} ".encode()
    return hashlib.sha256(head + numpy.ascontiguousarray(array).tobytes()).hexdigest()[:20]


def of_hdf5(path):
    import h5py

    lines = []
    with h5py.File(path, "r") as file:
        file.visititems(lambda name, item: lines.append((name, digest(item[()]))) if hasattr(item, "dtype") else None)
    return lines


def of_raster(path):
    from osgeo import gdal

    gdal.UseExceptions()
    data = gdal.Open(str(path))
    return [(f"band {b}", digest(data.GetRasterBand(b).ReadAsArray())) for b in range(1, data.RasterCount + 1)]


UNSTEADY = ("wall", "seconds", "version", "hardware", "commit", "memory", "bytes", "speed_of", "per_second")


def of_score(path):
    lines = []

    def walk(name, value):
        if isinstance(value, dict):
            for key, item in value.items():
                walk(f"{name}/{key}", item)
        elif isinstance(value, list):
            for i, item in enumerate(value):
                walk(f"{name}/{i}", item)
        elif not any(word in name for word in UNSTEADY):
            lines.append((name, hashlib.sha256(repr(value).encode()).hexdigest()[:20]))

    walk("", json.load(open(path)))
    return lines


def checksums(out):
    """(file, what, checksum) of everything that a scene has left."""
    found = []
    for path in sorted(out.rglob("*")):
        name = path.relative_to(out).as_posix()
        if path.name == "run.h5":
            lines = of_hdf5(path)
        elif path.name == "score.json":
            lines = of_score(path)
        elif path.suffix == ".tif":
            lines = of_raster(path)
        elif path.name == "history.csv":
            lines = [("text", hashlib.sha256(path.read_bytes()).hexdigest()[:20])]
        else:
            continue
        found += [(name, what, value) for what, value in lines]
    return found


def run(binaries, recipe, out, stages=("preprocess", "solve", "postprocess")):
    for stage in stages:
        command = [str(binaries / f"talus-{stage}"), str(recipe), "--out", str(out), "-q"]
        if stage == "solve":
            command += ["--on", "cpu"]
        # Sums of the energy budget are made by atomics, in the order in which threads come: one thread, one order.
        one_core = "energy_budget = true" in recipe.read_text()
        pin = (lambda: os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})) if one_core else None
        done = subprocess.run(command, capture_output=True, text=True, preexec_fn=pin)
        if done.returncode != 0:
            return f"{stage} ended with {done.returncode}: {done.stderr.strip()}"
    return None


def scenes(out, data):
    """(name, recipe) of everything to run."""
    for name, (keys, tables, numbers) in VARIANTS.items():
        if name in TIMED:
            continue
        recipe = out / "recipes" / f"{name}.toml"
        recipe.parent.mkdir(parents=True, exist_ok=True)
        recipe.write_text(merged(keys, tables, numbers))
        yield f"laboratory/{name}", recipe
    for name in ("synthetic-valley", "synthetic-raw-survey"):
        yield f"pipelines/{name}", ROOT / "pipelines" / name / "recipe.toml"
    # The rock slope takes an hour of one core to its end: a tenth of it.
    text = (ROOT / "pipelines/synthetic-xinmo/recipe.toml").read_text()
    text = text.replace("../../data_samples", f"{ROOT}/data_samples")
    recipe = out / "recipes" / "synthetic-xinmo.toml"
    recipe.write_text(text.replace("end_time_s = 100.0", "end_time_s = 10.0"))
    yield "pipelines/synthetic-xinmo", recipe
    for case in sorted((ROOT / "tests/validation").glob("*/recipe.toml")):
        yield f"validation/{case.parent.name}", case
    if (data / "frank_slide/before_dem.tif").exists():
        text = (ROOT / "pipelines/frank-slide/recipe.toml").read_text().replace("${TALUS_DATA}", str(data))
        recipe = out / "recipes" / "frank-40m.toml"
        recipe.write_text(text.replace("spacing_m = 20.0", "spacing_m = 40.0"))
        yield "frank-slide/40m", recipe


def compare(before, after):
    """Prints what differs between two tables; the exit code."""

    def read(path):
        rows = (line.rstrip("\n").rsplit(" ", 1) for line in open(path) if line.strip() and not line.startswith("#"))
        return {what: value for what, value in rows}

    a, b = read(before), read(after)
    changed = [what for what in a if what in b and a[what] != b[what]]
    gone = [what for what in a if what not in b]
    new = [what for what in b if what not in a]
    for title, names in (("changed", changed), ("gone", gone), ("new", new)):
        for what in names:
            print(f"{title}: {what}")
    print(f"{len(a)} before, {len(b)} after: {len(changed)} changed, {len(gone)} gone, {len(new)} new")
    return 1 if changed or gone else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=pathlib.Path, default=ROOT / "build/bin", help="folder of the programs")
    parser.add_argument("--out", type=pathlib.Path, help="folder for recipes and results")
    parser.add_argument("--data", type=pathlib.Path, default=ROOT / "../shared/data", help="folder of the real terrain")
    parser.add_argument("--only", default="", help="only scenes whose name holds this text")
    parser.add_argument("--compare", nargs=2, metavar=("BEFORE", "AFTER"), help="compare two tables instead")
    given = parser.parse_args()
    if given.compare:
        return compare(*given.compare)
    if not given.out:
        parser.error("--out DIR is needed")
    given.out = given.out.resolve()
    (given.out / "recipes").mkdir(parents=True, exist_ok=True)
    for name, recipe in scenes(given.out, given.data.resolve()):
        if given.only not in name:
            continue
        folder = given.out / name
        problem = run(given.bin.resolve(), recipe, folder)
        print(f"# {name}", file=sys.stderr, flush=True)
        if problem:
            print(f"{name} failed: {hashlib.sha256(problem.encode()).hexdigest()[:20]}", flush=True)
            print(f"#   {problem}", file=sys.stderr)
        for file, what, value in checksums(folder):
            print(f"{name} {file} {what} {value}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
