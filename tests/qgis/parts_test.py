# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts of the QGIS plugin that need no QGIS."""
import datetime
import os
import pathlib
import signal
import stat
import sys
import tempfile
import time
import unittest

from talus_provider import process
from talus_provider.locate import find_talus
from talus_provider.progress import Progress
from talus_provider.results import Results, start_of, stride_for

signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell starts background work with it ignored

ASK_AND_SAVE = """
import os, signal, sys, time
def end(*_):
    print("saved", file=sys.stderr, flush=True)
    open(sys.argv[1], "w").close()
    sys.exit(130)
signal.signal(signal.SIGINT, end)
print("t 1.00/10 s  step 3", file=sys.stderr, flush=True)
time.sleep(30)
"""


DEAF = """
import signal, sys, time
signal.signal(signal.SIGINT, signal.SIG_IGN)
print("x", file=sys.stderr, flush=True)
time.sleep(60)
"""


class ProgressTest(unittest.TestCase):
    def test_goes_by_stage_and_time_and_never_back(self):
        progress, seen = Progress(), []
        for line in [
            "preprocess: domain.vdb is missing",
            "release  36000 m3",
            "solve: run.h5 is missing",
            "0 %  eta ?  t 0.00/120 s  v_max 0.0 m/s  step 0  dt 0.01 s  mass error 0.0e+00",
            "50 %  eta at most 4 min  t 60.00/120 s  v_max 38.0 m/s  step 1240  dt 0.010 s  mass error 2e-15",
            "25 %  eta 1 s  t 30.00/120 s  a line out of order",
            "postprocess: score.json is missing",
            "survey 100/200 drawn within its error",
        ]:
            progress.read(line)
            seen.append(progress.percent)
        self.assertEqual(seen, [0, 0, 5, 5, 48.5, 48.5, 92, 96])

    def test_tells_progress_from_what_people_read(self):
        progress = Progress()
        self.assertTrue(progress.read("0 %  eta ?  t 1.2e-03/5e+01 s  step 1"))
        self.assertFalse(progress.read("thickness at rest 3/4"))
        self.assertFalse(progress.read("solve: run.h5 is up to date"))
        self.assertEqual(progress.percent, 92)


class ProcessTest(unittest.TestCase):
    def test_keeps_results_and_lines_apart(self):
        heard = []
        code = "import sys; print('/a b/run.h5'); print('one', file=sys.stderr); sys.stderr.write('two'); sys.exit(3)"
        outcome = process.run([sys.executable, "-c", code], heard.append)
        self.assertEqual((outcome.code, outcome.results, outcome.lines), (3, ["/a b/run.h5"], ["one", "two"]))
        self.assertEqual(heard, outcome.lines)
        self.assertFalse(outcome.cancelled)
        self.assertIn("a file is wrong", outcome.meaning())

    def test_cancel_is_an_interrupt_that_may_save(self):
        with tempfile.TemporaryDirectory() as folder:
            saved, lines = pathlib.Path(folder) / "saved", []
            began = time.monotonic()
            outcome = process.run([sys.executable, "-c", ASK_AND_SAVE, str(saved)], lines.append, lambda: bool(lines))
            self.assertTrue(saved.exists() and outcome.cancelled)
            self.assertEqual((outcome.code, outcome.lines[-1]), (130, "saved"))
            self.assertLess(time.monotonic() - began, 20)

    def test_what_does_not_listen_is_ended(self):
        lines = []
        outcome = process.run([sys.executable, "-c", DEAF], lines.append, lambda: bool(lines), patience=0.3)
        self.assertEqual(outcome.code, 128 + 15)

    def test_asks_the_solver_for_a_line_a_second(self):
        outcome = process.run(["bash", "-c", "echo $TALUS_PROGRESS_S"])
        self.assertEqual(outcome.results, ["1"])


class LocateTest(unittest.TestCase):
    def test_goes_by_what_is_given_then_by_the_path(self):
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder) / "talus"
            program.write_text("#!/bin/sh\n")
            with self.assertRaises(FileNotFoundError) as refused:
                find_talus(str(program))  # not executable
            self.assertIn("in the settings", str(refused.exception))
            program.chmod(program.stat().st_mode | stat.S_IXUSR)
            self.assertEqual(find_talus(str(program)), str(program))
            self.assertEqual(find_talus(folder), str(program))
            path, os.environ["PATH"] = os.environ["PATH"], folder
            try:
                self.assertEqual(find_talus(""), str(program))
            finally:
                os.environ["PATH"] = path


class ResultsTest(unittest.TestCase):
    def test_are_a_folder_with_maps(self):
        with tempfile.TemporaryDirectory() as folder:
            with self.assertRaises(FileNotFoundError) as refused:
                Results(folder)
            self.assertIn("maps", str(refused.exception))
            maps = pathlib.Path(folder) / "maps"
            maps.mkdir()
            self.assertIsNone(Results(folder).project())
            (maps / "slide.qgs").write_text("")
            self.assertEqual(Results(folder).project(), str(maps / "slide.qgs"))

    def test_time_begins_as_the_file_says(self):
        self.assertEqual(start_of("seconds since 1903-04-29 04:10:00"),
                         datetime.datetime(1903, 4, 29, 4, 10, tzinfo=datetime.timezone.utc))
        with self.assertRaises(ValueError):
            start_of("days since 1903-04-29 04:10:00")

    def test_points_are_thinned_to_what_is_asked_for(self):
        for counts, most in [([1000] * 7, 500), ([1000] * 7, 7000), ([3, 999, 1], 10), ([5], 1)]:
            stride = stride_for(counts, most)
            self.assertLessEqual(sum(-(-n // stride) for n in counts), max(most, len(counts)))
            if stride > 1:
                self.assertGreater(sum(-(-n // (stride - 1)) for n in counts), most, "more could be shown")


if __name__ == "__main__":
    unittest.main()
