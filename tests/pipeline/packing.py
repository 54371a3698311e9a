# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How densely points lie that nothing moved but chance and their own weight: what a run may show at most.

Points that drift within cells gather where nothing holds them apart (docs/notes). A flow that stirs them leaves them
no denser than points thrown at random: their number in a cell is then a Poisson number of mean 1 / share, of points
that take `share` of a cell each. Weight compresses the mass beside that, by exp(pressure / modulus of confined
compression)."""
import csv
import json
import math
import pathlib
import re


def beyond(mean, least):
    """The chance that a Poisson number of this mean is `least` or more."""
    term, below = math.exp(-mean), 0.0
    for n in range(least):
        below += term
        term *= mean / (n + 1)
    return max(1 - below, 0.0)


def by_chance(share, cells, records, of_volume=0.0):
    """The packing that more than `of_volume` of the volume of `cells` full cells (0: a single cell) passes in one run
    of a hundred, each of so many records, where points of `share` of a cell lie by chance."""
    points = 1
    while True:
        packing = points * share
        needed = math.floor(of_volume * cells / packing) + 1
        if records * beyond(cells * beyond(1 / share, points), needed) < 0.01:
            return packing
        points += 1


def squash(thickness, density, modulus, poisson):
    """By how much the weight of a column [m, kg/m3, Pa] compresses its lowest points."""
    confined = modulus * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson))
    return math.exp(density * 9.81 * thickness / confined)


def faults(out):
    """What is wrong with the packing of a run, of one material, whose three stages wrote into `out`."""
    with open(f"{out}/history.csv") as file:
        rows = list(csv.DictReader(file))
    with open(f"{out}/score.json") as file:
        score = json.load(file)
    used = "".join(pathlib.Path(out, f"{stage}.used.toml").read_text() for stage in ("preprocess", "solve"))

    def given(key):
        return float(re.search(rf"(?m)^(?:# )?{key}(?: =|:) ([0-9.e+]+)", used).group(1))

    cells = score["volume_released_m3"] / (score["cell_m"] ** 2 * given("layer_height_m"))
    weight = squash(score["max_peak_thickness_m"], given("density_kg_m3"), given("youngs_modulus_Pa"),
                    given("poisson_ratio"))
    p99, densest = (max(float(row[name]) for row in rows) for name in ("packing_p99", "packing_max"))
    most_p99, most = (weight * by_chance(cells / score["particles"], cells, len(rows), volume) for volume in (0.01, 0))
    print(f"packing: 99 % of the volume below {p99:.3g} (bound {most_p99:.3g}), "
          f"densest cell {densest:.3g} ({most:.3g})")
    found = []
    if not 1 <= p99 <= most_p99:
        found.append("packing of 99 % of the volume")
    if not p99 <= densest <= most:
        found.append("packing of the densest cell")
    return found
