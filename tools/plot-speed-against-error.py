#!/usr/bin/env python3
"""Draws docs/pictures/speed-against-error.png, and headline.png beside it.

They are drawn from docs/benchmarks/speed-against-error.csv.

usage: tools/plot-speed-against-error.py [CSV [PNG]]        (Debian: python3-matplotlib)
"""
import csv
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

ROOT = pathlib.Path(__file__).resolve().parent.parent
SOURCE = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs/benchmarks/speed-against-error.csv"
PICTURE = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else ROOT / "docs/pictures/speed-against-error.png"
COLOURS = {
    "explicit": "#0072b2",
    "newmark": "#d55e00",
    "newmark, exact tangent": "#cc79a7",
    "auto": "#009e73",
    "reference preset": "#000000",
}  # Okabe & Ito 2008: told apart by all eyes
MARKS = {
    ("quadratic", "double"): "o",
    ("quadratic", "single"): "s",
    ("linear", "double"): "^",
    ("gimp", "single"): "D",
    ("gimp", "double"): "d",
}


def number(row, key):
    return float(row[key]) if row[key] else float("nan")


def draw(axes, row, x, y, label, below=False):
    on_gpu = "H200" in row["place"]
    colour = COLOURS[row["integrator"]]
    axes.plot(
        x,
        y,
        MARKS[row["shape"], row["precision"]],
        color=colour,
        markerfacecolor=colour if on_gpu else "white",
        markersize=8,
    )
    axes.annotate(label, (x, y), textcoords="offset points", xytext=(-4, -15) if below else (7, 5), fontsize=8)


def frank(axes, rows, modulus):
    rows = [
        r
        for r in rows
        if r["scene"] == "Frank Slide" and float(r["youngs_modulus_Pa"]) == modulus and r["stiffness"] == "as-given"
    ]
    rows = [r for r in rows if number(r, "elsewhere_than_finest_percent") > 0]
    for row in rows:
        height = row["layer_height_m"]
        label = row["spacing_m"] + (f"/{height}" if height != row["spacing_m"] else "") + " m"
        if row["integrator"] == "newmark":
            label += f", {float(row['step_mean_cfl']):.2g} CFL"
        elif row["step_asked_cfl"] == "0.1":
            label += ", 0.1 CFL"
        if row["integrator"] == "auto" or (row["precision"], row["shape"]) == ("single", "quadratic"):
            label = ""  # beside its twin in double precision
        below = row["integrator"] == "newmark" and row["step_asked_cfl"] == "10"  # close to its neighbours
        draw(axes, row, number(row, "wall_s"), number(row, "elsewhere_than_finest_percent"), label, below)
    axes.set_xscale("log")
    axes.margins(x=0.12)
    axes.set_ylim(0, 1.12 * max(number(r, "elsewhere_than_finest_percent") for r in rows))
    axes.set_xlabel("wall time of the steps [s]")
    axes.set_ylabel("deposit elsewhere than on the finest grid [%]")
    axes.set_title(f"Frank Slide, E = {modulus:.0e} Pa".replace("e+0", "e"), loc="left", fontweight="bold")


def sand_column(axes, rows):
    rows = [r for r in rows if r["scene"] == "sand column" and number(r, "elsewhere_than_finest_percent") > 0]
    for row in rows:
        step = number(row, "step_asked_cfl")
        plain = (row["precision"], row["shape"]) == ("double", "quadratic")
        label = f"{step:g}" if plain and row["integrator"] != "auto" else ""
        draw(axes, row, number(row, "wall_s"), number(row, "elsewhere_than_finest_percent"), label)
    axes.set_xscale("log")
    axes.set_ylim(0, 17.5)
    axes.text(
        0.015,
        0.93,
        "cells of 0.0225 m above 8 %, of 0.01125 m below (reference preset: 16 and 13 %); "
        "numbers: step over the CFL step",
        transform=axes.transAxes,
        fontsize=8,
    )
    axes.set_xlabel("wall time of the steps [s]")
    axes.set_ylabel("sand elsewhere than on the finest grid [%]")
    axes.set_title("Sand column A3", loc="left", fontweight="bold")


def stiff_slide(axes, rows):
    rows = [r for r in rows if r["scene"] == "stiff slide"]
    scenes = sorted({(int(r["layer_height_m"]), float(r["youngs_modulus_Pa"])) for r in rows}, reverse=True)
    for height, modulus in scenes:
        runs = [r for r in rows if int(r["layer_height_m"]) == height and float(r["youngs_modulus_Pa"]) == modulus]
        plain = lambda r: (r["shape"], r["precision"]) == ("quadratic", "double")
        fixed = {r["place"]: number(r, "wall_s") for r in runs if r["integrator"] == "explicit" and plain(r)}
        for row in runs:  # beside the lines: linear, single, the reference preset, the CPU
            if (
                plain(row)
                and ("H200" in row["place"] or row["integrator"] == "explicit")
                or not number(row, "elsewhere_than_explicit_percent") > 0.05
            ):
                continue
            label = f"{height} m" if row["integrator"] == "reference preset" else ""
            draw(
                axes,
                row,
                number(row, "wall_s") / fixed[row["place"]],
                number(row, "elsewhere_than_explicit_percent"),
                label,
            )
        fixed = fixed["NVIDIA H200"]
        runs = sorted(
            (r for r in runs if r["integrator"] == "newmark" and plain(r) and "H200" in r["place"]),
            key=lambda r: number(r, "step_mean_cfl"),
        )
        x = [number(r, "wall_s") / fixed for r in runs]
        y = [number(r, "elsewhere_than_explicit_percent") for r in runs]
        stiff = modulus > 5e9
        colour = {40: "#d55e00", 10: "#cc79a7", 5: "#56b4e9"}[height]
        axes.plot(
            x,
            y,
            "--o" if stiff else "-o",
            color=colour,
            markerfacecolor="white" if stiff else colour,
            markersize=8,
            label=f"layers of {height} m, {modulus:.2g} Pa".replace("e+0", "e"),
        )
        for run, across, up in zip(runs, x, y):
            axes.annotate(
                f"{number(run, 'step_mean_cfl'):.2g}",
                (across, up),
                textcoords="offset points",
                xytext=(7, -3),
                fontsize=8,
            )
    axes.axvline(1, color=COLOURS["explicit"])
    axes.annotate(
        "explicit", (1, 0.2), textcoords="offset points", xytext=(5, 0), fontsize=8, color=COLOURS["explicit"]
    )
    axes.set_xscale("log")
    axes.set_xlim(0.8, 60)
    axes.set_ylim(bottom=0)
    axes.legend(fontsize=8, loc=(0.07, 0.42))
    axes.set_xlabel("wall time of Newmark steps over that of explicit ones")
    axes.set_ylabel("deposit elsewhere than with explicit steps [%]")
    axes.set_title(
        "Stiff slide; lines: H200, quadratic, double; numbers: mean step over the CFL step",
        loc="left",
        fontweight="bold",
    )


def legend(axes):
    for name, colour in COLOURS.items():
        axes.plot([], [], "o", color=colour, label=name)
    for (shape, precision), mark in MARKS.items():
        axes.plot([], [], mark, color="grey", label=f"{shape}, {precision}")
    axes.plot([], [], "o", color="grey", markerfacecolor="white", label="CPU, two threads (filled: H200)")
    axes.legend(fontsize=8, loc="lower left")


def headline(axes, rows):
    """Frank Slide, a line for every method: quadratic functions and double precision, the reference preset as it is."""

    def pick(integrator, place, modulus, spacings, step):
        found = [
            r
            for r in rows
            if r["scene"] == "Frank Slide"
            and (r["integrator"], r["step_asked_cfl"], r["stiffness"]) == (integrator, step, "as-given")
            and place in r["place"]
            and float(r["youngs_modulus_Pa"]) == modulus
            and r["precision"] == "double"
            and r["shape"] == ("linear" if integrator == "reference preset" else "quadratic")
            and (r["spacing_m"], r["layer_height_m"]) in spacings
            and number(r, "elsewhere_than_finest_percent") > 0
        ]
        found.sort(key=lambda r: number(r, "wall_s"))
        return found

    all_spacings = [("40", "40"), ("20", "20"), ("20", "10")]
    for label, colour, runs in (
        ("explicit, H200", COLOURS["explicit"], pick("explicit", "H200", 1e7, all_spacings, "0.5")),
        ("explicit, two CPU threads", "#56b4e9", pick("explicit", "CPU", 1e7, all_spacings, "0.5")),
        (
            "implicit (Newton), 10 CFL, 1e9 Pa, H200",
            COLOURS["newmark"],
            pick("newmark", "H200", 1e9, all_spacings, "10"),
        ),
        (
            "the reference paper's PCG scheme, 1e9 Pa, H200",
            COLOURS["reference preset"],
            pick("reference preset", "H200", 1e9, all_spacings, "0.2"),
        ),
    ):
        axes.plot(
            [number(r, "wall_s") for r in runs],
            [number(r, "elsewhere_than_finest_percent") for r in runs],
            "o-",
            color=colour,
            label=label,
            markersize=6,
        )
        for r in runs:
            height = r["layer_height_m"]
            axes.annotate(
                r["spacing_m"] + (f" over {height}" if height != r["spacing_m"] else "") + " m",
                (number(r, "wall_s"), number(r, "elsewhere_than_finest_percent")),
                textcoords="offset points",
                xytext=(6, 5),
                fontsize=8,
            )
    axes.set_xscale("log")
    axes.set_xlim(0.05, 100)
    axes.set_ylim(0, 8.5)
    axes.set_xlabel("wall time of the steps, 100 s of slide [s]")
    axes.set_ylabel("deposit elsewhere than on the finest grid [%]")
    axes.set_title("Frank Slide: error over time to solution", loc="left", fontweight="bold")
    axes.grid(color="#dddddd")
    axes.set_axisbelow(True)
    axes.legend(fontsize=8, loc="upper left")


with open(SOURCE, newline="") as file:
    table = list(csv.DictReader(file))
figure, panels = plt.subplots(4, 1, figsize=(9, 18.5), dpi=110)
frank(panels[0], table, 1e7)
legend(panels[0])
frank(panels[1], table, 1e9)
stiff_slide(panels[2], table)
sand_column(panels[3], table)
for panel in panels:
    panel.grid(color="#dddddd")
    panel.set_axisbelow(True)
figure.tight_layout()
PICTURE.parent.mkdir(parents=True, exist_ok=True)
figure.savefig(PICTURE)
print(PICTURE)
figure, axes = plt.subplots(figsize=(7.5, 4), dpi=110, layout="constrained")
headline(axes, table)
figure.savefig(PICTURE.with_name("headline.png"))
print(PICTURE.with_name("headline.png"))
