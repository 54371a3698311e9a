#!/usr/bin/env python3
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws docs/pictures/speed-against-error.png.

It is drawn from docs/benchmarks/speed-against-error.csv, which pipelines/benchmarks/speed_against_error.py writes.
Rows of more than one commit or machine are refused.

usage: tools/plot-speed-against-error.py [CSV [PNG]]        (Debian: python3-matplotlib)
"""
import csv
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
SOURCE = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs/benchmarks/speed-against-error.csv"
PICTURE = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else ROOT / "docs/pictures/speed-against-error.png"
COLOURS = {
    "explicit": "#0072b2",
    "column-implicit": "#009e73",
    "newton": "#d55e00",
    "reference preset": "#000000",
}  # Okabe & Ito 2008: told apart by all eyes
NAMES = {
    "explicit": "explicit",
    "column-implicit": "implicit along columns",
    "newton": "implicit, Newton's iterations",
    "reference preset": "the reference paper's scheme, as we read it",
}
LINES = {"explicit": "0.8", "column-implicit": "1.5", "newton": "10"}  # the step, in CFL, of the line over the grids


def read(source):
    """The rows that have a result, all of one commit and machine."""
    with open(source, newline="", encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["steps"] != "failed"]
    for key in ("commit", "machine"):
        kinds = sorted({row[key] for row in rows})
        if len(kinds) != 1:
            sys.exit(f"{source}: rows of more than one {key} ({', '.join(kinds)}): make them anew, by one command")
    return rows


def of(rows, name):
    return [row for row in rows if row["set"] == name and float(row["elsewhere_than_finest_percent"]) > 0]


def grid_of(row):
    same = row["spacing_m"] == row["layer_height_m"]
    return row["spacing_m"] + ("" if same else f" over {row['layer_height_m']}") + " m"


def place(row):
    return float(row["loop_s"]), float(row["elsewhere_than_finest_percent"])


def note(axes, row, text, below=False):
    axes.annotate(text, place(row), textcoords="offset points", xytext=(5, -11 if below else 5), fontsize=7.5,
                  color=COLOURS[row["method"]])  # fmt: skip


def plain_ticks(axis, values):
    import matplotlib.ticker

    axis.set_major_locator(matplotlib.ticker.FixedLocator(values))
    axis.set_major_formatter(matplotlib.ticker.FormatStrFormatter("%g"))
    axis.set_minor_locator(matplotlib.ticker.NullLocator())


def draw(axes, rows):
    """A line for every method over the grids, at one step; lone marks for other steps on the coarsest grid."""
    for method, colour in COLOURS.items():
        runs = [row for row in rows if row["method"] == method]
        swept = method == "reference preset"
        line = [row for row in runs if swept or row["asked"] == LINES[method]]
        if not swept:
            line = sorted(line, key=lambda row: float(row["loop_s"]))
        step = ", over its step" if swept else f", {LINES[method]} CFL, over the grids"
        axes.plot(*zip(*map(place, line)), "o-", color=colour, markersize=6, label=NAMES[method] + step)
        for number, row in enumerate(line):
            if swept:
                note(axes, row, f"{row['asked']} CFL", below=number % 2 == 1)  # steps of like cost lie side by side
            elif method != "column-implicit":  # whose grids are those of its neighbour
                note(axes, row, grid_of(row))
        others = [row for row in runs if row not in line]
        if others:
            axes.plot(*zip(*map(place, others)), "o", color=colour, markersize=4, markerfacecolor="white")
    axes.plot([], [], "o", color="#777777", markersize=4, markerfacecolor="white", label="other lengths of step")
    axes.set_xscale("log")
    axes.set_yscale("log")
    plain_ticks(axes.xaxis, [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50])
    plain_ticks(axes.yaxis, [0.5, 1, 2, 3, 5, 10, 20, 30])
    axes.margins(x=0.16, y=0.12)  # names stand to the right of their marks
    axes.set_xlabel("time of the steps [s]")
    axes.grid(color="#dddddd")
    axes.set_axisbelow(True)


def legend_below(axes):
    """Under the axis, where it hides no point."""
    axes.legend(fontsize=8, loc="upper center", bbox_to_anchor=(0.5, -0.13), ncol=2, frameon=False)


def main():
    rows = read(SOURCE)  # before matplotlib is needed
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    machine, commit = rows[0]["machine"], rows[0]["commit"]
    panels = (
        ("Frank Slide", "Frank Slide, E = 1e9 Pa, 100 s", "deposit elsewhere than on cells of 10 over 5 m [%]"),
        ("sand column", "Sand column A3, E = 1.82e6 Pa, 1.5 s", "sand elsewhere than on cells of 5.6 mm [%]"),
    )
    figure, axes = plt.subplots(2, 1, figsize=(8.5, 10), dpi=110, layout="constrained")
    for axis, (name, title, label) in zip(axes, panels):
        draw(axis, of(rows, name))
        axis.set_ylabel(label)
        axis.set_title(title, loc="left", fontweight="bold")
    legend_below(axes[0])
    figure.supxlabel(f"{machine}, {commit}", fontsize=8)
    PICTURE.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(PICTURE)
    print(PICTURE)


if __name__ == "__main__":
    main()
