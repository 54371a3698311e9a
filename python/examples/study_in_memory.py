# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs one site on beds of several strengths in memory, and says how far the flow reaches on each.

usage: study_in_memory.py RECIPE COEFFICIENT...      friction coefficients at rest; half of each is left at 20 m/s
"""
import sys

import numpy
import talus


def reach(result):
    """The largest distance of the flow from the middle of the release, in plan [m]."""
    start, flow = result.maps["initial_thickness"], result.maps["peak_thickness"]
    rows, columns = numpy.indices(start.shape)
    middle = numpy.average([rows[start > 0], columns[start > 0]], axis=1, weights=start[start > 0])
    return result.grid["cell_m"] * numpy.hypot(rows - middle[0], columns - middle[1])[flow > 0.1].max()


def main(path, *coefficients):
    recipe = talus.Recipe.read(path)
    site = talus.prepare(recipe)  # read and seeded once
    speeds = numpy.linspace(0, 20, 5)
    print("coefficient  reach_m  steps")
    for at_rest in map(float, coefficients):
        recipe["solve.base.law"] = "table"
        recipe["solve.base.table"] = numpy.column_stack([speeds, at_rest * (1 - 0.5 * speeds / speeds[-1])])
        result = talus.run(talus.plan(recipe, site), on="cpu")
        print(f"{at_rest:11.2f}  {reach(result):7.0f}  {result.summary['steps']:5d}")


if __name__ == "__main__":
    main(*sys.argv[1:])
