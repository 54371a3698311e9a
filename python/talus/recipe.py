# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Recipes: read, look at, change, write."""
import copy
import datetime
import json
import math
import os
import pathlib
import re
import tomllib

from talus.errors import TalusError

_BARE = re.compile(r"[A-Za-z0-9_-]+")


class Recipe:
    """What a recipe says, and what was changed of it.

    Keys are dotted, with all their tables, as `--set` of the programs has them; an item of a list has its number,
    counted from 0: `recipe["solve.part[0].cohesion_Pa"] = 1800.0`. Units stand in the keys. The programs check keys and
    values (`talus.run`), this class does not: a key with a wrong name is an error there, with the name that is meant.
    """

    def __init__(self, tables=None, path=None):
        """`tables`: dictionaries as tomllib gives them; `path`: the file that they are from, or None."""
        self.tables = copy.deepcopy(tables or {})
        self.path = None if path is None else pathlib.Path(path).absolute()
        self.changes = {}  # key: value, of what was set since the recipe was read

    @classmethod
    def parse(cls, text):
        """The recipe in a text of TOML. Raises TalusError where it is none."""
        try:
            return cls(tomllib.loads(text))
        except tomllib.TOMLDecodeError as error:
            raise TalusError(f"the recipe cannot be read ({error}). Mend its TOML") from error

    @classmethod
    def read(cls, path):
        """The recipe in a file. Raises TalusError where there is none or it is no TOML."""
        try:
            return cls(tomllib.loads(pathlib.Path(path).read_text(encoding="utf-8")), path)
        except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
            raise TalusError(f"{path}: the recipe cannot be read ({error}). Check the path, and its TOML") from error

    def __getitem__(self, key):
        """The value of a key; KeyError where the recipe does not say it (it then has the programs' default)."""
        place = self.tables
        for part in _parts(key):
            try:
                place = place[part]
            except (KeyError, IndexError, TypeError):
                raise KeyError(key) from None
        return place

    def get(self, key, default=None):
        """The value of a key, or `default` where the recipe does not say it."""
        try:
            return self[key]
        except KeyError:
            return default

    def __contains__(self, key):
        return self.get(key, _MISSING) is not _MISSING

    def __setitem__(self, key, value):
        """Sets a value; tables that are not there are made, items of lists are not (KeyError)."""
        toml_value(value)  # raises where it cannot be said in TOML
        *tables, last = _parts(key)
        place = self.tables
        for part in tables:
            if isinstance(part, str) and isinstance(place, dict):
                place = place.setdefault(part, {})
                continue
            place = _item(place, part, key)
        if isinstance(last, int) or not isinstance(place, dict):
            _item(place, last, key)
        place[last] = copy.deepcopy(value)
        self.changes.pop(key, None)
        self.changes[key] = copy.deepcopy(value)

    def text(self):
        """The recipe as TOML, without remarks."""
        return toml_text(self.tables)

    def changes_as_text(self):
        """The changes as --set of the programs takes them: "key=value"."""
        return [f"{key}={toml_value(value)}" for key, value in self.changes.items()]

    def write(self, path):
        """Writes the recipe to a file, without the remarks of the one that was read.

        Paths in a recipe are relative to its folder. So a recipe that was read is written to its own folder only;
        elsewhere its paths would lead to other files. `talus.run(recipe, ...)` needs no file.
        """
        path = pathlib.Path(path).absolute()
        if self.path is not None and os.path.realpath(path.parent) != os.path.realpath(self.path.parent):
            raise TalusError(
                f"{path}: the recipe is from {self.path.parent}, and its relative paths would lead elsewhere. Write it"
                " into that folder, or write Recipe(recipe.tables) once its paths are absolute")
        path.write_text(self.text(), encoding="utf-8")


_MISSING = object()


def _parts(key):
    """The names and numbers of a dotted key: "solve.part[0].law" is solve, part, 0, law."""
    parts = []
    for name in key.split("."):
        match = re.fullmatch(r"([A-Za-z0-9_-]+)((?:\[\d+\])*)", name)
        if match is None:
            raise TalusError(f'"{key}" is no key. Give it with its tables, as in solve.part[0].cohesion_Pa')
        parts.append(match[1])
        parts += [int(number) for number in re.findall(r"\d+", match[2])]
    return parts


def _item(place, part, key):
    if not isinstance(place, list) or not isinstance(part, int) or part >= len(place):
        raise KeyError(f"{key}: the recipe has no such item. Items of lists are not made; set the whole list")
    return place[part]


def toml_value(value):
    """A value as TOML has it, on one line. Raises TalusError for what TOML does not know."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (str, os.PathLike)):
        return json.dumps(os.fspath(value), ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, (datetime.datetime, datetime.date, datetime.time)):
        return value.isoformat()
    if hasattr(value, "tolist"):  # of numpy
        return toml_value(value.tolist())
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return repr(value) if math.isfinite(value) else str(value)
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(toml_value(item) for item in value) + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_name(name)} = {toml_value(item)}" for name, item in value.items()) + "}"
    raise TalusError(f"{value!r} ({type(value).__name__}) cannot be said in a recipe. Give a number, text, a list")


def toml_text(tables, above=""):
    """Tables as a TOML file has them: values first, then the tables below, lists of tables as [[...]]."""
    def is_tables(value):
        return isinstance(value, list) and value and all(isinstance(item, dict) for item in value)

    values = {k: v for k, v in tables.items() if not isinstance(v, dict) and not is_tables(v)}
    text = "".join(f"{_name(name)} = {toml_value(value)}\n" for name, value in values.items())
    for name, value in tables.items():
        if name in values:
            continue
        path = above + _name(name)
        for item in [value] if isinstance(value, dict) else value:
            heading = f"[{path}]" if isinstance(value, dict) else f"[[{path}]]"
            text += f"\n{heading}\n" + toml_text(item, path + ".")
    return text


def _name(name):
    return name if _BARE.fullmatch(name) else json.dumps(name)
