# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the programs, and what they refuse."""
import os
import pathlib
import signal
import subprocess
import sys
import time
import unittest
import warnings

import talus
from scene import FIRST, HERE, RECIPE

SHORT = {"solve.end_time_s": 0.1, "postprocess.outputs": []}


class ProgramsTest(unittest.TestCase):
    def test_changes_of_a_recipe_reach_the_programs(self):
        recipe = talus.Recipe.read(RECIPE)
        recipe["solve.base.friction_angle_deg"] = 11.5
        recipe["scene.title"] = "A \"title\", = with ü"
        before = RECIPE.read_bytes()
        with self.assertWarnsRegex(talus.TalusWarning, "the grid is coarse for this release"):
            run = talus.run(recipe, HERE / "changed", set=SHORT, on="cpu", threads=1)
        self.assertEqual(run.used()["solve.base.friction_angle_deg"], 11.5)
        self.assertEqual(run.used()["solve.end_time_s"], 0.1)
        self.assertEqual(run.facts["title"], "A \"title\", = with ü")
        self.assertEqual(RECIPE.read_bytes(), before)
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # nothing runs again, so nothing is warned of
            again = talus.run(recipe, HERE / "changed", set=SHORT, on="cpu", threads=1)
        self.assertEqual(again.provenance["run.id"], run.provenance["run.id"])

    def test_an_error_is_the_programs_own_words(self):
        with self.assertRaises(talus.ProgramError) as caught:
            talus.run(RECIPE, HERE / "refused", set={"solve.end_tim_s": 5, "solve.cfl": -1.0}, on="cpu")
        self.assertEqual(caught.exception.code, 2)
        self.assertIn('unknown key "end_tim_s" in [solve]. Did you mean "end_time_s"?', str(caught.exception))
        self.assertFalse((HERE / "refused/run.h5").exists())
        with self.assertRaises(talus.ProgramError) as caught:
            talus.run(RECIPE, HERE / "refused", set={"preprocess.after_dem": pathlib.Path("none.asc")}, on="cpu")
        self.assertEqual(caught.exception.code, 3)
        self.assertIn("none.asc", str(caught.exception))

    def test_an_interrupted_call_leaves_a_checkpoint_and_no_program(self):
        out = HERE / "interrupted"
        asked = {"solve.end_time_s": 300.0, "solve.checkpoint_interval_s": 0.1}
        words = f"import talus; talus.run({str(RECIPE)!r}, {str(out)!r}, set={asked}, on='cpu')"
        with subprocess.Popen([sys.executable, "-W", "ignore", "-c", words], stderr=subprocess.PIPE, text=True) as call:
            limit = time.monotonic() + 120
            while not (out / "checkpoint.h5").exists() and call.poll() is None and time.monotonic() < limit:
                time.sleep(0.02)
            call.send_signal(signal.SIGINT)
            _, said = call.communicate(timeout=120)
        self.assertIn("KeyboardInterrupt", said)
        self.assertTrue((out / "checkpoint.h5").exists())
        self.assertFalse((out / "run.h5").exists())
        self.assertFalse((out / ".talus.lock").exists(), "a program is still at work there")

    def test_programs_that_are_not_there_are_said(self):
        with self.assertRaisesRegex(talus.TalusError, "there is no program talus in it"):
            talus.run(RECIPE, FIRST, programs=HERE)
        with self.assertRaisesRegex(talus.TalusError, "is from no file"):
            talus.run(talus.Recipe({}), FIRST)
        self.assertEqual(talus.programs.find_program("talus", os.environ["TALUS_PROGRAMS"]),
                         talus.programs.find_program("talus"))
