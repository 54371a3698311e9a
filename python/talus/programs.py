# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the programs."""
import os
import pathlib
import shutil
import subprocess
import warnings

import talus
from talus.errors import ProgramError, TalusError, TalusWarning
from talus.in_process import run_plan
from talus.recipe import Recipe, toml_value


def run(recipe, out=None, set=None, on="auto", programs=None, threads=None, callback=None):
    """Runs the plan `recipe` in this process (`talus.in_process.run_plan`), or, with `out`, all stages of a recipe.

    Of a recipe it runs every stage whose results are not up to date (`talus run`), and returns the run as
    `talus.open_run` does. recipe: its path, or a Recipe that was read, with its changes. out: folder of the results;
    relative to where you stand. set: values in the place of the recipe's, {"solve.end_time_s": 60.0}; they hold over
    its changes. on: "auto", "cpu", "gpu" or "gpus". programs: folder of the programs; by default $TALUS_PROGRAMS, else
    those beside this package, else those on the PATH. threads: the most to take.

    Raises ProgramError with the program's own words. What the programs warn of comes as TalusWarning. Ctrl-C lets the
    solver write its checkpoint first; the same call goes on from there.
    """
    if out is None:
        return run_plan(recipe, on=on, callback=callback, threads=threads or 0)
    path, changes = (recipe.path, dict(recipe.changes)) if isinstance(recipe, Recipe) else (recipe, {})
    if path is None:
        raise TalusError("this Recipe is from no file. Write it first (recipe.write), then read it")
    changes.update(set or {})
    command = [find_program("talus", programs), "run", os.fspath(path), "--out", os.fspath(out), "--on", on]
    if threads is not None:
        command += ["--threads", str(threads)]
    for key, value in changes.items():
        command += ["--set", f"{key}={toml_value(value)}"]
    code, said = _call(command)
    if code != 0:
        raise ProgramError(command, code, said)
    for line in dict.fromkeys(line for line in said.splitlines() if line.startswith("warning: ")):
        warnings.warn(line.removeprefix("warning: "), TalusWarning, stacklevel=2)
    return talus.open_run(out)


def find_program(name, programs=None):
    """The path of a program of Talus. Raises TalusError where it is not found."""
    if programs is None:
        programs = os.environ.get("TALUS_PROGRAMS") or None
    if programs is not None:
        found = shutil.which(name, path=os.fspath(programs))
        if found is None:
            raise TalusError(f"{programs}: there is no program {name} in it. Name the folder that holds {name}")
        return os.path.abspath(found)
    package = pathlib.Path(__file__).resolve().parent  # python/talus of a checkout, or share/talus/python/talus
    beside = [package / "../../build/bin", package / "../../../../bin"]
    found = next(filter(None, (shutil.which(name, path=str(folder)) for folder in beside)), None) or shutil.which(name)
    if found is None:
        raise TalusError(f"the program {name} was not found. Name its folder: programs=..., or TALUS_PROGRAMS=...")
    return os.path.abspath(found)


def _call(command):
    """Exit code, and what was written for people. The child has a session of its own: Ctrl-C comes to it once."""
    process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                               text=True, encoding="utf-8", errors="replace", start_new_session=True)
    try:
        _, said = process.communicate()
    except BaseException:
        process.terminate()
        process.communicate()
        raise
    return process.returncode, said
