#!/usr/bin/env python3
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Solves the rock slope of Xinmo's proportions in four ways, to the end, and makes one table of them.

usage: xinmo_variants.py prepare|run|table|all OUT [--bin DIR] [--on gpu] [--only TEXT]

All four have the rock's own modulus, velocity weakening, and area B. The first 5 s of the reference paper's scheme are
also solved in steps of 1e-4 s, and their cost carried on to the end. prepare writes domain and recipes
(talus-preprocess; Debian: python3-tomli-w), run solves (talus-solve), table maps the deposits (talus-postprocess) and
writes OUT/xinmo-variants.csv (Debian: python3-h5py). The three may be done on different machines.
"""
import argparse
import csv
import json
import pathlib
import sys

import speed_against_error as runs

SCENE = runs.Scene("xinmo", "pipelines/synthetic-xinmo/recipe.toml", 10, 10, None,
                   {"solve": {"point_frames": "none", "material": {"stiffness": "as-given"}}})  # fmt: skip
FIRST_SECONDS = 5.0
PAPERS_STEP = 1e-4  # [s]


# The budget of energy is kept by explicit and by column-implicit steps.
def preset(step, **keys):
    solve = {"preset": "reference", "integrator": "newmark", "energy_budget": False, "implicit": {"step_s": step}}
    return {"solve": solve | keys}


def newton(steps, tolerance):
    changes = runs.merged(runs.newton(steps, tolerance).changes, {"solve": {"energy_budget": False}})
    return runs.Method(f"Newton to {tolerance:g}", f"{steps:g} CFL", changes)


VARIANTS = {
    "reference-preset": runs.Method("the paper's scheme, as we read it", "0.01 s", preset(0.01)),
    "reference-preset-papers-steps": runs.Method(
        "the same in steps of 1e-4 s, first 5 s", "1e-4 s",
        preset(PAPERS_STEP, end_time_s=FIRST_SECONDS, stop_kinetic_fraction=0.0)),
    "newton": newton(10, 1e-3),
    "newton-loose": newton(5, 1e-2),
    "column-implicit": runs.Method("column-implicit", "1 CFL", runs.columns(1.0).changes),
    "explicit": runs.Method("explicit", "0.5 CFL", runs.explicit(0.5).changes),
    "explicit-quarter": runs.Method("explicit, what the others are held against", "0.25 CFL",
                                    runs.explicit(0.25).changes),
}  # fmt: skip
LOSSES = ("bed_loss_J", "damping_loss_J", "plastic_loss_J", "transfer_loss_J")
COLUMNS = [
    "variant", "steps_of", "commit", "machine", "points", "time_end_s", "steps", "newton_iterations",
    "linear_iterations", "steps_cut", "loop_s", "process_s", "loop_of_whole_run_s", "memory_bytes",
    *(name.replace("_loss_J", "_share_percent") for name in LOSSES), "unaccounted_percent", "peak_speed_m_s",
    "runout_m", "max_deposit_thickness_m", "elsewhere_than_explicit_percent", "stop_reason",
]  # fmt: skip


def prepare(arguments, chosen):
    runs.make_domain(arguments, arguments.out / "domain", SCENE)
    for name, variant in chosen.items():
        recipe = runs.recipe_of(SCENE, variant)
        recipe["solve"]["domain"] = "../domain/domain.vdb"
        runs.write(arguments.out / name / "recipe.toml", {"scene": recipe["scene"], "solve": recipe["solve"]})


def run(arguments, chosen):
    for name in chosen:
        runs.solve(arguments, arguments.out / name)


def shares(history):
    """What took the energy that was given up, in per cent, and what is not accounted for."""
    if not all(name in history for name in LOSSES):
        return {}
    given = history["potential_J"][0] - history["potential_J"][-1]
    taken = {name: history[name][-1] for name in LOSSES}
    left = history["kinetic_J"][-1] + history["elastic_J"][-1] - history["kinetic_J"][0] - history["elastic_J"][0]
    rest = given - sum(taken.values()) - left
    row = {name.replace("_loss_J", "_share_percent"): f"{100 * value / given:.2f}" for name, value in taken.items()}
    return row | {"unaccounted_percent": f"{100 * rest / given:.3f}"}


def row_of(arguments, name, variant, whole_end):
    home = arguments.out / name
    row = {"variant": variant.name, "steps_of": variant.asked}
    deposit = runs.deposit_of(home)
    if deposit is None:
        return row | {"stop_reason": "failed, see its log"}
    command = [arguments.bin / "talus-postprocess", home / "recipe.toml", "--out", home]
    if runs.command(command, home / "maps.log")[0]:
        sys.exit((home / "maps.log").read_text(encoding="utf-8"))
    score = json.loads((home / "score.json").read_text(encoding="utf-8"))
    row |= runs.cost_of(home, deposit) | shares(deposit.history) | {
        "time_end_s": f"{score['time_end_s']:g}",
        "peak_speed_m_s": f"{score['max_peak_speed_m_s']:.1f}",
        "stop_reason": score["stop_reason"],
    }
    if name == "reference-preset-papers-steps":
        return row | {"loop_of_whole_run_s": f"{float(row['loop_s']) * whole_end / FIRST_SECONDS:.0f}"}
    plain = runs.deposit_of(arguments.out / "explicit-quarter")
    row["elsewhere_than_explicit_percent"] = f"{deposit.elsewhere(plain, SCENE.spacing):.2f}" if plain else ""
    return row | {
        "runout_m": f"{score['runout_m']:.0f}",
        "max_deposit_thickness_m": f"{score['max_deposit_thickness_m']:.1f}",
    }


def table(arguments, chosen):
    plain = runs.deposit_of(arguments.out / "explicit-quarter")
    whole_end = float(plain.history["time_s"][-1]) if plain else float("nan")
    rows = [row_of(arguments, name, variant, whole_end) for name, variant in chosen.items()]
    with open(arguments.out / "xinmo-variants.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    print(f"{arguments.out / 'xinmo-variants.csv'}: {len(rows)} rows")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["prepare", "run", "table", "all"])
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--bin", type=pathlib.Path, default=runs.ROOT / "build/bin")
    parser.add_argument("--on", default="auto")
    parser.add_argument("--only", default="", help="variants whose name has this in it")
    arguments = parser.parse_args()
    arguments.out, arguments.bin = arguments.out.resolve(), arguments.bin.resolve()
    chosen = {name: variant for name, variant in VARIANTS.items() if arguments.only in name}
    for name, do in (("prepare", prepare), ("run", run), ("table", table)):
        if arguments.what in (name, "all"):
            do(arguments, chosen)


if __name__ == "__main__":
    main()
