# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Recipes: keys, changes, TOML that comes back as it was."""
import datetime
import math
import pathlib
import tomllib
import unittest

import numpy
import talus
from scene import HERE, RECIPE
from talus.recipe import toml_text, toml_value


class RecipeTest(unittest.TestCase):
    def test_keys_are_those_of_set(self):
        recipe = talus.Recipe.read(RECIPE)
        self.assertEqual(recipe["solve.base.friction_angle_deg"], 15.0)
        self.assertIsNone(recipe.get("solve.cfl"))
        self.assertNotIn("solve.cfl", recipe)
        with self.assertRaises(KeyError):
            recipe["solve.cfl"]
        recipe["solve.implicit.step_s"] = 0.1  # a table that is not there is made
        recipe["solve.gauge"] = [{"name": "bridge", "at_m": [1.0, 2.0]}]
        recipe["solve.gauge[0].at_m"] = [2.0, 3.0]
        self.assertEqual(recipe["solve.gauge[0].at_m"], [2.0, 3.0])
        self.assertEqual(list(recipe.changes), ["solve.implicit.step_s", "solve.gauge", "solve.gauge[0].at_m"])
        self.assertEqual(recipe.changes["solve.gauge"], [{"name": "bridge", "at_m": [1.0, 2.0]}])
        for key in ("solve.gauge[1].at_m", "solve.part[0].law", "scene.name.more", "scene.name[0]"):
            with self.assertRaises(KeyError, msg=key):
                recipe[key] = 1
        with self.assertRaisesRegex(talus.TalusError, "is no key"):
            recipe["solve..x"] = 1

    def test_a_written_recipe_says_the_same(self):
        recipe = talus.Recipe.read(RECIPE)
        recipe["scene.title"] = 'a "b"\\ \n ü \x7f'
        recipe["solve.part"] = [{"release": "top", "cohesion_Pa": 1e-7}, {"release": "foot"}]
        recipe["solve.gravity_m_s2"] = [0, 0, -9.81]
        recipe.write(RECIPE.parent / "written.toml")
        self.assertEqual(tomllib.loads((RECIPE.parent / "written.toml").read_text(encoding="utf-8")), recipe.tables)

    def test_a_recipe_with_relative_paths_stays_in_its_folder(self):
        (HERE / "elsewhere").mkdir(exist_ok=True)
        with self.assertRaisesRegex(talus.TalusError, "its relative paths would lead elsewhere"):
            talus.Recipe.read(RECIPE).write(HERE / "elsewhere/recipe.toml")
        self.assertFalse((HERE / "elsewhere/recipe.toml").exists())

    def test_every_kind_of_value_comes_back(self):
        values = {
            "flag": True, "count": 3, "small": 1e-300, "large": 1e22, "far": math.inf, "text": "tab\t'\"", "none": "",
            "list": [1.0, 2.0], "table": {"a b": {"deep": [{"x": False}, {"x": True}]}}, "empty": [],
            "when": datetime.datetime(2010, 5, 1, 12, 30, tzinfo=datetime.timezone.utc), "mixed": [1, {"x": 2}],
        }  # fmt: skip
        self.assertEqual(tomllib.loads(toml_text(values)), values)
        for name, value in values.items():
            self.assertEqual(tomllib.loads(f"key = {toml_value(value)}")["key"], value, name)
        self.assertEqual(toml_value(numpy.float64(0.5)), "0.5")
        self.assertEqual(toml_value(numpy.arange(2)), "[0, 1]")
        self.assertEqual(toml_value(pathlib.Path("a/b.tif")), '"a/b.tif"')
        self.assertTrue(math.isnan(tomllib.loads(f"key = {toml_value(math.nan)}")["key"]))
        with self.assertRaisesRegex(talus.TalusError, "cannot be said in a recipe"):
            toml_value(None)

    def test_what_is_no_recipe_is_said(self):
        with self.assertRaisesRegex(talus.TalusError, "none.toml: the recipe cannot be read"):
            talus.Recipe.read(HERE / "none.toml")
        (HERE / "wrong.toml").write_text("[scene\n", encoding="utf-8")
        with self.assertRaisesRegex(talus.TalusError, "wrong.toml: the recipe cannot be read"):
            talus.Recipe.read(HERE / "wrong.toml")
