# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Talus from Python: read a run, change a recipe, run the stages, compare two runs.

Lengths are in metres, times in seconds, angles in degrees, thickness is vertical, and names and attributes `units` say
what differs. Row 0 of a map is the southernmost: `y` grows, as in run.h5.
"""
from talus.comparison import Comparison, compare
from talus.errors import ProgramError, TalusError, TalusWarning
from talus.programs import run
from talus.rasters import read_raster
from talus.recipe import Recipe
from talus.results import Run, open_run
from talus.survey import Survey, read_survey

__all__ = [
    "Comparison", "ProgramError", "Recipe", "Run", "Survey", "TalusError", "TalusWarning", "compare", "open_run",
    "read_raster", "read_survey", "run",
]
