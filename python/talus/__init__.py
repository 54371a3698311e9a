# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Talus from Python: change a recipe, prepare, plan and run it in memory, read results, compare two runs.

Lengths are in metres, times in seconds, angles in degrees, thickness is vertical, and names and attributes `units` say
what differs. Row 0 of a map is the southernmost: `y` grows, as in run.h5.
"""
import importlib

from talus.errors import DataError, NumericalError, ProgramError, RecipeError, TalusError, TalusWarning
from talus.in_process import plan, prepare, site, write
from talus.programs import run
from talus.recipe import Recipe

# These need h5py, xarray and rasterio, and are loaded where they are asked for.
_WITH_XARRAY = {
    "Comparison": "comparison", "Run": "results", "Survey": "survey", "compare": "comparison", "open_run": "results",
    "read_raster": "rasters", "read_survey": "survey",
}  # fmt: skip

__all__ = [
    "DataError", "NumericalError", "ProgramError", "Recipe", "RecipeError", "TalusError", "TalusWarning", "plan",
    "prepare", "run", "site", "write", *_WITH_XARRAY,
]


def __getattr__(name):
    if name not in _WITH_XARRAY:
        raise AttributeError(f"module 'talus' has no attribute '{name}'")
    return getattr(importlib.import_module(f"talus.{_WITH_XARRAY[name]}"), name)
