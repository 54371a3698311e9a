# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a recipe with several friction angles of the bed and prints a table.

usage: sweep_friction.py RECIPE OUT ANGLE...      angles in degrees
"""
import pathlib
import sys

import talus


def main(recipe, out, *angles):
    recipe = talus.Recipe.read(recipe)
    print("angle_deg  runout_m  h_over_l  deposit_csi")
    for angle in angles:
        recipe["solve.base.friction_angle_deg"] = float(angle)
        run = talus.run(recipe, pathlib.Path(out) / f"friction-{angle}", on="cpu")
        score = run.score()
        csi = score.get("deposit_csi")  # only where the recipe has a survey
        print(f"{float(angle):9.1f}  {score['runout_m']:8.0f}  {score['h_over_l']:8.3f}  "
              + (f"{csi:11.3f}" if csi is not None else "          -"))


if __name__ == "__main__":
    main(*sys.argv[1:])
