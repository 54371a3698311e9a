# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs in this process; python_test.sh has run recipe.toml into the folder a."""
import gc
import os
import pathlib
import signal
import threading
import time
import unittest
import warnings

import numpy
import talus

RECIPE = pathlib.Path.cwd() / "recipe.toml"


def plane(rows=16, columns=30, cell=5.0):
    """The site of a mass of 4 m on a plane that falls to the east."""
    bed = numpy.tile(200 - 0.5 * cell * numpy.arange(columns), (rows, 1))
    thickness = numpy.zeros((rows, columns))
    thickness[5:10, 6:11] = 4
    return talus.site(bed, thickness, cell=cell, west=1000, south=2000, layer_height=2)


def short(**changes):
    base = {"friction_angle_deg": 15.0, **changes.pop("base", {})}
    return {"solve": {"end_time_s": 1.0, "largest_step_s": 0.02, "history_interval_s": 0.25,
                      "material": {"youngs_modulus_Pa": 1e6}, "base": base, **changes}}


class InProcessTest(unittest.TestCase):
    def setUp(self):
        warnings.simplefilter("ignore", talus.TalusWarning)

    def test_maps_are_those_of_the_programs(self):
        with self.assertWarnsRegex(talus.TalusWarning, "the grid is coarse for this release"):
            plan = talus.plan(RECIPE)
        result, run = talus.run(plan, on="cpu"), talus.open_run("a")
        for name, values in run.maps().items():
            numpy.testing.assert_array_equal(result.maps[name], values.values, name)
        for name, values in run.history().items():
            numpy.testing.assert_array_equal(result.history[name], values.values, name)
        self.assertEqual(result.summary["steps"], run.facts["steps"])
        self.assertEqual(result.summary["title"], "Bowl")

    def test_arrays_are_views_that_keep_their_memory(self):
        site = plane()
        terrain = site.terrain
        terrain[0, 0] = 1234
        self.assertEqual(site.terrain[0, 0], 1234)
        terrain[0, 0] = 200
        result = talus.run(talus.plan(short(), site), on="cpu")
        deposit, points = result.maps["deposit_thickness"], result.points
        self.assertFalse(deposit.flags.owndata)
        self.assertIs(deposit.base, result)
        self.assertTrue(numpy.shares_memory(deposit, result.maps["deposit_thickness"]))
        total = deposit.sum()
        del result
        gc.collect()
        self.assertEqual(deposit.sum(), total)
        self.assertAlmostEqual(total * 25, 2500, 6)
        self.assertEqual(points["position"].shape, (len(points["volume"]), 3))
        self.assertTrue((points["position"][:, 0] > 1000).all() and (points["position"][:, 0] < 1150).all())

    def test_a_callback_sees_records_and_ends_the_run(self):
        seen = []
        def look(now):
            seen.append((now.time, now.thickness, now.maps["peak_speed"], now.points["volume"], now))
            return len(seen) < 3
        result = talus.run(talus.plan(short(), plane()), on="cpu", callback=look)
        self.assertEqual([time for time, *_ in seen], [0, 0.25, 0.5])
        self.assertEqual(result.summary["stop_reason"], "stopped by the caller")
        for _, thickness, _, volume, _ in seen:  # arrays outlive their moment
            self.assertAlmostEqual(thickness.sum() * 25, 2500, 6)
            self.assertAlmostEqual(volume.sum(), 2500, 2)
        self.assertGreater(seen[2][2].max(), seen[1][2].max())
        with self.assertRaisesRegex(ValueError, "valid in its callback alone"):
            seen[0][4].maps

    def test_what_a_callback_raises_comes_out(self):
        def refuse(now):
            raise KeyError("mine")
        with self.assertRaisesRegex(KeyError, "mine"):
            talus.run(talus.plan(short(), plane()), on="cpu", callback=refuse)

    def test_other_threads_run_meanwhile(self):
        counted = []
        plan = talus.plan(short(end_time_s=20.0), plane())
        stop = threading.Event()
        def count():
            while not stop.wait(0.001):
                counted.append(1)
        thread = threading.Thread(target=count)
        thread.start()
        talus.run(plan, on="cpu", threads=1)
        stop.set()
        thread.join()
        self.assertGreater(len(counted), 5)

    def test_ctrl_c_ends_a_run(self):
        plan = talus.plan(short(end_time_s=1e5, largest_step_s=1e-4), plane())
        timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        began = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            talus.run(plan, on="cpu")
        self.assertLess(time.monotonic() - began, 60)

    def test_errors_are_in_the_words_of_the_programs(self):
        recipe = talus.Recipe.read(RECIPE)
        recipe["solve.end_tim_s"] = 5
        with self.assertRaises(talus.RecipeError) as caught:
            talus.plan(recipe)
        self.assertEqual(str(caught.exception),
                         '--set solve.end_tim_s=5: unknown key "end_tim_s" in [solve]. Did you mean "end_time_s"?')
        recipe = talus.Recipe.read(RECIPE)
        recipe["preprocess.after_dem"] = "none.asc"
        with self.assertRaisesRegex(talus.DataError, "none.asc"):
            talus.prepare(recipe)
        with self.assertRaisesRegex(ValueError, "must be"):
            talus.run(talus.plan(short(), plane()), on="cup")
        with self.assertRaises(talus.TalusError):
            talus.Recipe.parse("[solve\n")

    def test_a_table_gives_the_friction_of_the_bed(self):
        mu = numpy.tan(numpy.radians(15.0))
        def kinetic(base):
            return talus.run(talus.plan(short(base=base), plane()), on="cpu").history["kinetic_J"][-1]
        def table(*coefficients):
            return {"law": "table", "table": list(zip([0.0, 0.5, 2.0], coefficients))}
        self.assertEqual(kinetic(table(mu, mu, mu)), kinetic({}))
        self.assertGreater(kinetic(table(mu, 0.1, 0.05)), 1.1 * kinetic({}))

    def test_obstacles_and_shaking_are_given_in_memory(self):
        site, recipe = plane(), short()
        recipe["solve"]["obstacle"] = [{"name": "wall"}]
        site.add_obstacle("wall", (1056, 2020, 140), (1058, 2060, 182), lambda x, y, z: max(
            1056 - x, x - 1058, 2020 - y, y - 2060, 140 - z, z - 182))  # fmt: skip
        site.set_shaking([0, 0.2, 0.4], [[0, 0, 0], [-5, 0, 0], [0, 0, 0]])
        result = talus.run(talus.plan(recipe, site), on="cpu")
        self.assertNotEqual(result.history["obstacle_wall_impulse_x_N_s"][-1], 0)
        self.assertLess(result.history["shaking_x_m_s2"][1], -3)  # about -3.75 at 0.25 s, in the middle of a step

    def test_a_result_is_written(self):
        result = talus.run(talus.plan(RECIPE), on="cpu")
        files = talus.write(result, RECIPE, "written")
        self.assertIn(pathlib.Path("written/score.json").resolve(), [file.resolve() for file in files])
        self.assertEqual(talus.open_run("written").score()["runout_m"], talus.open_run("a").score()["runout_m"])


if __name__ == "__main__":
    unittest.main()
