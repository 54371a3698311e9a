# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a scene in memory on a bed whose friction falls with slip speed as a table says, and draws its deposit.

usage: valley_in_memory.py RECIPE PICTURE.png
"""
import sys

import talus
from matplotlib import pyplot

recipe = talus.Recipe.read(sys.argv[1])
recipe["solve.base.law"] = "table"
recipe["solve.base.table"] = [[0, 0.4], [2, 0.35], [10, 0.25], [30, 0.2]]  # slip speed [m/s], friction
result = talus.run(talus.plan(recipe), callback=lambda now: print(f"{now.time:.1f} s: {now.thickness.max():.2f} m"))
pyplot.imshow(result.maps["deposit_thickness"], origin="lower", vmin=0.1)
pyplot.colorbar(label="thickness of the deposit [m]")
pyplot.savefig(sys.argv[2])
