#!/usr/bin/env python3
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws docs/pictures/kernels-time.png, time and memory over the number of points.

They are read from docs/benchmarks/kernels-h200.csv.

usage: tools/plot-kernels.py [CSV [PNG]]        (Debian: python3-matplotlib)
"""
import collections
import csv
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

ROOT = pathlib.Path(__file__).resolve().parent.parent
SOURCE = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs/benchmarks/kernels-h200.csv"
PICTURE = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else ROOT / "docs/pictures/kernels-time.png"
COLOURS = {"linear": "#0072b2", "quadratic": "#d55e00"}  # Okabe & Ito 2008: told apart by all eyes
LINES = {"single": "-", "double": "--"}

lines = collections.defaultdict(list)
with open(SOURCE, newline="") as file:
    for row in csv.DictReader(file):
        points = float(row["points"])
        lines[row["method"], row["shape"], row["precision"]].append(
            (points, float(row["seconds_per_point_and_step"]), points * float(row["bytes_per_point"]) / 1e9)
        )

figure, (time, memory) = plt.subplots(1, 2, figsize=(11, 4.6), layout="constrained")
for (method, shape, precision), values in sorted(lines.items()):
    values.sort()
    x, seconds, gigabytes = zip(*values)
    look = dict(
        color=COLOURS[shape],
        linestyle=LINES[precision],
        marker="o" if method == "explicit" else "^",
        markersize=4.5,
        label=f"{method}, {shape}, {precision}",
    )
    time.plot(x, seconds, **look)
    memory.plot(x, gigabytes, **look)
time.set_ylim(4e-11, 2e-7)
memory.axhline(139 * 1.073741824, color="black", linewidth=0.8)
memory.annotate("memory of an H200", (1.2e4, 160), fontsize=8)
for axes, label in ((time, "time per point and step [s]"), (memory, "device memory [GB]")):
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("material points")
    axes.set_ylabel(label)
    axes.grid(True, color="#dddddd")
    axes.set_axisbelow(True)
time.legend(fontsize=8)
figure.savefig(PICTURE, dpi=90)
