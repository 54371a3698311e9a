#!/usr/bin/env python3
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the table of speed against error: every way of stepping on the same scenes, at the same modulus, at one commit.

usage: speed_against_error.py prepare|run|table|all OUT [--bin DIR] [--data DIR] [--on gpu] [--only TEXT] [--long]

prepare writes domains and recipes (talus-preprocess; Debian: python3-tomli-w), run solves what has not been solved
(talus-solve), table writes OUT/speed-against-error.csv (Debian: python3-h5py). The three may be done on different
machines. What is run is in the lists SCENES and the functions below them.
"""
import argparse
import copy
import csv
import dataclasses
import datetime
import functools
import json
import math
import os
import pathlib
import subprocess
import sys
import time
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
COLUMNS = [
    "set", "scene", "commit", "date", "machine", "method", "asked", "spacing_m", "layer_height_m",
    "youngs_modulus_Pa", "points", "steps", "newton_iterations", "linear_iterations", "steps_cut", "step_over_cfl_mean",
    "loop_s",
    "process_s", "memory_bytes", "elsewhere_than_finest_percent", "elsewhere_than_explicit_percent", "creep_m_s",
]  # fmt: skip


@dataclasses.dataclass
class Scene:
    """A recipe on a grid, with a modulus [Pa]: what all ways of stepping are tried on."""

    name: str
    recipe: str  # from the root of the project
    spacing: float  # [m]
    layer: float  # [m]
    modulus: float | None = None  # none: the recipe's
    changes: dict = dataclasses.field(default_factory=dict)
    long: bool = False

    def place(self):
        """The name of its domain."""
        return f"{self.name}-{self.spacing:g}-{self.layer:g}"

    def key(self):
        """The name of its runs."""
        modulus = f"-{self.modulus:.2g}".replace("+0", "") if self.modulus else ""
        return self.place() + modulus


@dataclasses.dataclass
class Method:
    """A way of stepping: keys of the recipe, and how it is named in the table."""

    name: str
    asked: str  # length of the step over the CFL step, or the accuracy
    changes: dict


def explicit(cfl, again=""):
    return Method("explicit" + again, f"{cfl:g}", {"solve": {"integrator": "explicit", "cfl": cfl}})


def columns(cfl):
    return Method("column-implicit", f"{cfl:g}", {"solve": {"integrator": "column-implicit", "cfl": cfl}})


def automatic(accuracy):
    return Method("auto", f"{accuracy:g}", {"solve": {"integrator": "auto", "accuracy": accuracy}})


def single(method):
    """The same in single precision."""
    return Method(method.name + " single", method.asked, merged(method.changes, {"solve": {"precision": "single"}}))


def newton(steps, tolerance=1e-3):
    """Backward Euler with Newton's iterations to a tolerance; `steps` CFL steps long."""
    implicit = {"newmark": [0.5, 1.0], "newton_tolerance": tolerance, "step_cfl": steps}
    return Method("newton", f"{steps:g}", {"solve": {"integrator": "newmark", "implicit": implicit}})


def reference(steps):
    """Our reading of the reference paper's scheme."""
    solve = {"preset": "reference", "integrator": "newmark", "implicit": {"step_cfl": steps}}
    return Method("reference preset", f"{steps:g}", {"solve": solve})


FRANK = "pipelines/frank-slide/recipe.toml"
FRAMELESS = {"solve": {"point_frames": "none"}}
SAND = "tests/validation/A3/recipe.toml"


def sand(cell):
    columns_of = lambda length: max(8, math.ceil(length / cell - 1e-9))
    return {
        "preprocess": {
            "laboratory": {"cells": [columns_of(1.35), 8], "corner_m": [-4 * cell, -4 * cell, 0.0]},
            "box": [{"name": "sand", "extent_m": [0.0, 0.0, 0.09, cell, 0.0, 0.63]}],
            "grid": {"points_per_cell": [3, 3, 3]},
        },
        "solve": {"point_frames": "none", "frame_interval_s": 1.5},
        "walls_at": cell,
    }  # fmt: skip


# One picture: all methods, one modulus, lines over grids and over lengths of step; the last grid is the finest.
PICTURE = {
    "Frank Slide": [
        Scene("frank", FRANK, 40, 40, 1e9, FRAMELESS),
        Scene("frank", FRANK, 40, 20, 1e9, FRAMELESS),
        Scene("frank", FRANK, 20, 20, 1e9, FRAMELESS),
        Scene("frank", FRANK, 20, 10, 1e9, FRAMELESS),
        Scene("frank", FRANK, 10, 5, 1e9, FRAMELESS),
    ],
    "sand column": [
        Scene("sand", SAND, 0.0225, 0.0225, None, sand(0.0225)),
        Scene("sand", SAND, 0.01125, 0.01125, None, sand(0.01125)),
        Scene("sand", SAND, 0.005625, 0.005625, None, sand(0.005625)),
    ],
}
# What the steps cost, and what they move, on one grid each.
STEPS = [
    Scene("frank", FRANK, 20, 10, 1e7, FRAMELESS),
    Scene("frank", FRANK, 20, 20, 8.1e9, FRAMELESS),
    Scene("stiff-slide", FRANK, 40, 5, 8.1e9, {"solve": {"point_frames": "none", "end_time_s": 40.0}}),
    Scene("iseesnow", "pipelines/iseesnow/recipe.toml", 5, 1, None, FRAMELESS),
    Scene("xinmo", "pipelines/synthetic-xinmo/recipe.toml", 10, 10, None,
          {"solve": {"point_frames": "none", "energy_budget": False, "material": {"stiffness": "as-given"}}}),
    Scene("sand", SAND, 0.01125, 0.01125, None, sand(0.01125)),
]  # fmt: skip


# What lies still: an elastic slab of 60 x 30 x 2 m on 20 degrees over a bed of 25, in equilibrium, for ten minutes.
SLOPE = math.radians(20)
SLAB = Scene("slab", "tests/validation/B1/recipe.toml", 1, 0.5, 1e8, {
    "preprocess": {
        "laboratory": {"cells": [80, 50], "slope": [-math.tan(SLOPE), 0.0]},
        "box": [{"name": "slab", "extent_m": [10.0, 10.0, 70.0, 40.0, 0.0, 2.0]}],
    },
    "solve": {
        "end_time_s": 600.0, "history_interval_s": 10.0, "frame_interval_s": 600.0, "point_frames": "none",
        "gravity_loading_steps": 10,
        "base": {"friction_angle_deg": 25.0},
    },
})  # fmt: skip
STILL = [
    Method("newmark", "2 s", {"solve": {"integrator": "newmark", "implicit": {"step_s": 2.0}}}),
    Method("auto", "0.01", {"solve": {"integrator": "auto", "accuracy": 0.01}}),
]


def runs(long):
    """(set, scene, method) of every run."""
    for name, scenes in PICTURE.items():
        for place, scene in enumerate(scenes):
            finest, coarsest = place == len(scenes) - 1, place == 0
            if finest:
                yield name, scene, explicit(0.25)
                continue
            for cfl in (0.1, 0.25, 0.5, 0.8) if coarsest else (0.25, 0.5, 0.8):
                yield name, scene, explicit(cfl)
            for cfl in (0.5, 1.0, 1.5):
                yield name, scene, columns(cfl)
            for steps in (3, 10, 30) if coarsest else (10,):
                yield name, scene, newton(steps)
            for steps in (0.5, 1, 2, 5, 10) if coarsest else (1,) if long else ():
                yield name, scene, reference(steps)
    for scene in STEPS:
        for method in (explicit(0.25), explicit(0.25, " again"), explicit(0.1), explicit(0.5), explicit(0.8)):
            yield "cost of steps", scene, method
        for method in (columns(0.5), columns(1.0), columns(1.5), automatic(0.01), automatic(0.02)):
            yield "cost of steps", scene, method
        for method in (explicit(0.8), columns(1.5), automatic(0.01), automatic(0.02)):
            yield "cost of steps", scene, single(method)
    for method in STILL:
        yield "at rest", SLAB, method


def merged(base, changes):
    """The tables of `changes` over those of `base`."""
    result = copy.deepcopy(base)
    for key, value in changes.items():
        result[key] = merged(result.get(key, {}), value) if isinstance(value, dict) else copy.deepcopy(value)
    return result


def wave_speed(material):
    """sqrt(confined modulus / density) [m/s]."""
    young, poisson = material["youngs_modulus_Pa"], material["poisson_ratio"]
    confined = young * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson))
    return math.sqrt(confined / material["density_kg_m3"])


def recipe_of(scene, method=None):
    with open(ROOT / scene.recipe, "rb") as file:
        recipe = tomllib.load(file)
    recipe = merged(recipe, {k: v for k, v in scene.changes.items() if k != "walls_at"})
    for wall in recipe["solve"].get("wall", []):
        if "walls_at" in scene.changes and wall["axis"] == "y" and wall["position_m"] > 0:
            wall["position_m"] = scene.changes["walls_at"]
    grid = {"spacing_m": float(scene.spacing), "layer_height_m": float(scene.layer)}
    recipe = merged(recipe, {"preprocess": {"grid": grid}})
    for key in ("base_dem", "before_dem", "after_dem"):
        path = recipe["preprocess"].get(key, "")
        if path.startswith(".."):
            recipe["preprocess"][key] = str((ROOT / scene.recipe).parent / path)
    material = {"poisson_ratio": 0.25, "density_kg_m3": 2000.0, "youngs_modulus_Pa": 1e7} | recipe["solve"]["material"]
    if scene.modulus:
        material["youngs_modulus_Pa"] = scene.modulus
        recipe["solve"]["material"]["youngs_modulus_Pa"] = scene.modulus
    if method:
        recipe = merged(recipe, method.changes)
        if "cfl" not in method.changes["solve"]:
            recipe["solve"].pop("cfl", None)  # it belongs to the recipe's own integrator
        if method.name.startswith("auto") and recipe["solve"]["material"].get("stiffness") == "as-given":
            del recipe["solve"]["material"]["stiffness"]  # it follows from accuracy
        steps = recipe["solve"].get("implicit", {}).pop("step_cfl", None)
        if steps:
            up = 1 / scene.layer**2
            rate = wave_speed(material) * math.sqrt(2 / scene.spacing**2 + up)
            recipe["solve"]["implicit"]["step_s"] = steps / rate
    return recipe


def folder_of(out, scene, method):
    return out / f"{scene.key()}-{method.name}-{method.asked}".replace(" ", "-")


def write(path, recipe):
    import tomli_w

    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(tomli_w.dumps(recipe), encoding="utf-8")


def command(words, log):
    with open(log, "w", encoding="utf-8") as file:
        begun = time.monotonic()
        code = subprocess.run(words, stdout=file, stderr=subprocess.STDOUT, check=False).returncode
        return code, time.monotonic() - begun


def make_domain(arguments, home, scene):
    """Makes the domain of a scene in the folder `home`, where there is none yet."""
    if (home / "domain.vdb").exists():
        return
    write(home / "recipe.toml", recipe_of(scene))
    words = [arguments.bin / "talus-preprocess", home / "recipe.toml", "--out", home]
    if command(words, home / "log")[0] != 0:
        sys.exit((home / "log").read_text(encoding="utf-8"))


def solve(arguments, home):
    """Solves the recipe in the folder `home`, where that was not done yet."""
    if (home / "run.h5").exists() or (home / "failed").exists():
        return
    words = [arguments.bin / "talus-solve", home / "recipe.toml", "--out", home, "--on", arguments.on]
    code, seconds = command(words, home / "log")
    timed = {"process_s": seconds, "date": f"{datetime.date.today()}"}
    (home / "time.json").write_text(json.dumps(timed), encoding="utf-8")
    if code != 0:
        (home / "failed").touch()
    print(f"{home.name}: {seconds:.2f} s" + (f", exit code {code}" if code else ""), flush=True)


def prepare(arguments, chosen):
    os.environ["TALUS_DATA"] = str(arguments.data.resolve())
    for _, scene, method in chosen:
        make_domain(arguments, arguments.out / "domains" / scene.place(), scene)
        recipe = recipe_of(scene, method)
        solve = recipe["solve"] | {"domain": f"../domains/{scene.place()}/domain.vdb"}
        recipe = {"scene": recipe["scene"], "solve": solve}
        write(folder_of(arguments.out, scene, method) / "recipe.toml", recipe)


def run(arguments, chosen):
    for _, scene, method in chosen:
        solve(arguments, folder_of(arguments.out, scene, method))


class Deposit:
    """Thickness at the end [m] on its grid, and what it took to get there."""

    def __init__(self, path):
        import h5py

        with h5py.File(path / "run.h5") as file:
            maps = file["maps"].attrs
            self.thickness = file["maps/deposit_thickness"][:]
            self.west, self.south, self.cell = maps["west_m"], maps["south_m"], maps["cell_m"]
            self.facts = dict(file.attrs)
            self.history = {name: data[:] for name, data in file["history"].items()}

    def on(self, west, south, cell, columns_, rows):
        """The volume in the cells of another grid [m3]."""
        import numpy

        def overlap(first, count, start, number):
            own = first + self.cell * numpy.arange(count + 1)
            other = start + cell * numpy.arange(number + 1)
            low = numpy.maximum(own[:-1, None], other[None, :-1])
            return numpy.maximum(0, numpy.minimum(own[1:, None], other[None, 1:]) - low)

        thickness = numpy.nan_to_num(self.thickness)
        along = overlap(self.south, thickness.shape[0], south, rows)
        across = overlap(self.west, thickness.shape[1], west, columns_)
        return along.T @ thickness @ across

    def elsewhere(self, other, cell):
        """Half the sum of differences over the sum of the other's, in cells of this width [%]."""
        import numpy

        west, south = min(self.west, other.west), min(self.south, other.south)
        reach = lambda d, axis: (d.west, d.south)[axis] + d.cell * d.thickness.shape[1 - axis]
        size = [math.ceil((max(reach(self, a), reach(other, a)) - (west, south)[a]) / cell) for a in (0, 1)]
        mine, yours = (d.on(west, south, cell, *size) for d in (self, other))
        # Thickness of one-cell-deep columns counts by their own width.
        mine, yours = mine / mine.sum(), yours / yours.sum()
        return 50 * float(numpy.abs(mine - yours).sum())


@functools.cache
def deposit_of(home):
    """The deposit in a folder, read once; None where the run has failed."""
    return Deposit(home) if (home / "run.h5").exists() else None


def cost_of(home, deposit):
    """What a run was made with, and what it took."""
    facts, history = deposit.facts, deposit.history
    text = lambda value: value.decode() if isinstance(value, bytes) else str(value)
    timed = json.loads((home / "time.json").read_text())
    return {
        "commit": text(facts["version"]).split("(")[-1].rstrip(")"),
        "date": timed.get("date", ""),
        "machine": text(facts["on"]),
        "points": int(facts["particles"]),
        "steps": int(facts["steps"]),
        "newton_iterations": int(history["newton_iterations"][-1]),
        "linear_iterations": int(history["linear_iterations"][-1]),
        "steps_cut": int(history["step_cuts"][-1]),
        "loop_s": f"{float(facts['wall_time_s']):.3f}",
        "process_s": f"{timed['process_s']:.3f}",
        "memory_bytes": f"{float(facts['memory_bytes']):.0f}",
    }


def creep_of(history):
    """How fast the centre of what lies on SLAB's slope sinks along it in the second half of the run [m/s]."""
    time, fall = history["time_s"], history["potential_J"]
    half = len(time) // 2
    weight = history["volume_m3"][0] * 2000 * 9.81  # [N]
    return abs(fall[half] - fall[-1]) / (weight * math.sin(SLOPE) * (time[-1] - time[half]))


def row_of(arguments, name, scene, method, finest, plain, coarsest_cell):
    home = folder_of(arguments.out, scene, method)
    deposit = deposit_of(home)
    row = {
        "set": name, "scene": scene.name, "method": method.name, "asked": method.asked,
        "spacing_m": f"{scene.spacing:g}", "layer_height_m": f"{scene.layer:g}",
    }  # fmt: skip
    if deposit is None:
        return row | {"steps": "failed"}
    over = deposit.history["step_over_cfl"]
    with open(home / "solve.used.toml", "rb") as file:
        modulus = tomllib.load(file)["solve"]["material"]["youngs_modulus_Pa"]
    row |= cost_of(home, deposit) | {
        "youngs_modulus_Pa": f"{modulus:.3g}",
        "step_over_cfl_mean": f"{over[over > 0].mean():.3g}" if (over > 0).any() else "",
    }
    if scene is SLAB:
        row["creep_m_s"] = f"{creep_of(deposit.history):.1e}"
    if finest is not None:
        row["elsewhere_than_finest_percent"] = f"{deposit.elsewhere(finest, coarsest_cell):.2f}"
    if plain is not None:
        row["elsewhere_than_explicit_percent"] = f"{deposit.elsewhere(plain, scene.spacing):.2f}"
    return row


def table(arguments, chosen):
    def by_short_steps(scene):
        return deposit_of(folder_of(arguments.out, scene, explicit(0.25)))

    rows = []
    for name, scene, method in chosen:
        scenes = PICTURE.get(name)
        finest = by_short_steps(scenes[-1]) if scenes else None
        plain = by_short_steps(scene)
        rows.append(row_of(arguments, name, scene, method, finest, plain, scenes[0].spacing if scenes else None))
    path = arguments.out / "speed-against-error.csv"
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS, restval="", lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    print(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("phase", choices=["prepare", "run", "table", "all"])
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--bin", type=pathlib.Path, default=ROOT / "build/bin")
    parser.add_argument("--data", type=pathlib.Path, default=ROOT / "../shared/data")
    parser.add_argument("--on", default="auto", choices=["auto", "cpu", "gpu"])
    parser.add_argument("--only", default="", help="runs whose folder has this in its name")
    parser.add_argument("--long", action="store_true", help="the reference preset on fine grids too")
    arguments = parser.parse_args()
    arguments.out = arguments.out.resolve()
    chosen = [r for r in runs(arguments.long) if arguments.only in folder_of(arguments.out, *r[1:]).name]
    for phase in (prepare, run, table) if arguments.phase == "all" else (globals()[arguments.phase],):
        phase(arguments, chosen)


if __name__ == "__main__":
    main()
