# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Prepares, plans and runs in this process, by libtalus (docs/reference/library.md)."""
import os
import pathlib

import talus
from talus.errors import TalusError


def _core():
    """The module talus._core: beside this package, or in the build folder. Raises TalusError where it is not built."""
    programs = os.environ.get("TALUS_PROGRAMS")
    places = [pathlib.Path(programs) / "../python"] if programs else []
    places.append(pathlib.Path(__file__).resolve().parent / "../../build/python")
    for place in places:
        if str(place) not in talus.__path__:
            talus.__path__.append(str(place))
    try:
        from talus import _core
    except ImportError as error:
        raise TalusError(f"talus._core cannot be loaded ({error}). Build it with pybind11-dev installed (make build),"
                         " or install the wheel (make wheel)") from error
    return _core


def _words(recipe):
    """A recipe as the module takes it: its file and changes, or its text."""
    if not isinstance(recipe, talus.Recipe):
        recipe = talus.Recipe(recipe) if isinstance(recipe, dict) else talus.Recipe.read(recipe)
    if recipe.path is None:
        return _core().RecipeWords(None, recipe.text(), os.getcwd(), [])
    return _core().RecipeWords(str(recipe.path), "", "", recipe.changes_as_text())


def site(bed, thickness, **places):
    """The site of two arrays [rows][columns], the southernmost row first: elevation of the bed and vertical thickness
    of the released mass [m]. Further: cell [m], west, south [m], layer_height [m], per_cell, crs_wkt."""
    return _core().Site(bed, thickness, **places)


def prepare(recipe, threads=0):
    """The site of a recipe's [preprocess]: `terrain`, `before` and `thickness` as arrays that may be changed.

    recipe: a Recipe, a path or a dict. threads: the most to take; 0: all.
    """
    return _core().prepare(_words(recipe), threads)


def plan(recipe, site=None, threads=0):
    """The plan of a recipe's [solve] on a site; by default on that of its [preprocess]."""
    return _core().plan(prepare(recipe, threads) if site is None else site, _words(recipe), threads)


def run_plan(plan, on="auto", callback=None, threads=0):
    """Takes the steps of a plan and returns its result: maps, points, history, frames and summary, in memory.

    callback(moment) is called at every record ([solve] history_interval_s): time, steps, thickness, maps and points of
    that moment. Where it returns False the run ends. What it raises ends the run too, and comes out of this call.
    """
    return _core().run(plan, on, callback, threads)


def write(result, recipe, folder):
    """Writes run.h5 and the outputs of a recipe's [postprocess] into a folder; returns their paths."""
    return [pathlib.Path(name) for name in _core().write(result, _words(recipe), os.fspath(folder))]
