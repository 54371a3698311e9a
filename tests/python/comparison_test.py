# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Comparisons against the page of `talus compare`, the score, and what can be said by hand."""
import re
import shutil
import unittest

import h5py
import numpy
import talus
from scene import FIRST, HERE, SECOND


def changed(name, change):
    """A copy of the first run whose file `change` has changed."""
    (HERE / name).mkdir(exist_ok=True)
    shutil.copyfile(FIRST / "run.h5", HERE / name / "run.h5")
    with h5py.File(HERE / name / "run.h5", "r+") as file:
        change(file)
    return HERE / name


def shifted_by_two_cells(file):
    file["maps"].attrs["west_m"] += 20.0


def cut_into_halves(file):
    """The same maps in cells half as wide."""
    attributes = file["maps"].attrs
    for name, data in list(file["maps"].items()):
        values, about = data[:], dict(data.attrs)
        del file["maps"][name]
        file["maps"][name] = numpy.kron(values, numpy.ones((2, 2)))
        file["maps"][name].attrs.update(about)
    attributes.update({"cell_m": 5.0, "columns": 40, "rows": 40})


def thinned(file):
    file["maps/deposit_thickness"][:] *= 0.5


class ComparisonTest(unittest.TestCase):
    def test_a_run_is_itself(self):
        found = talus.compare(FIRST, talus.open_run(FIRST))
        self.assertEqual((found.elsewhere, found.runout_difference_m), (0, 0))
        self.assertEqual((found.footprint_csi, found.deposit_csi), (1, 1))

    def test_numbers_are_those_of_talus_compare(self):
        page = (FIRST / "comparison.html").read_text(encoding="utf-8")
        percent = float(re.search(r"lies elsewhere[^<]*</t[dh]>\s*<td[^>]*>([0-9.e-]+) %", page)[1])
        found = talus.compare(FIRST, SECOND)
        self.assertGreater(percent, 1)
        self.assertAlmostEqual(100 * found.elsewhere / percent, 1, delta=0.005)  # three digits on the page

    def test_runout_is_that_of_the_score(self):
        found = talus.compare(FIRST, SECOND)
        self.assertAlmostEqual(found.runout_first_m, talus.open_run(FIRST).score()["runout_m"], places=6)
        self.assertAlmostEqual(found.runout_second_m, talus.open_run(SECOND).score()["runout_m"], places=6)
        self.assertEqual(found.runout_difference_m, found.runout_second_m - found.runout_first_m)

    def test_other_cells_hold_the_same_deposit(self):
        for first, second in ((FIRST, changed("fine", cut_into_halves)), (HERE / "fine", FIRST)):
            found = talus.compare(first, second)
            self.assertLess(found.elsewhere, 1e-12)
            self.assertEqual(found.deposit_csi, 1)
            self.assertAlmostEqual(found.volume_second_m3, 6400, places=6)

    def test_a_shifted_deposit_lies_elsewhere_by_what_it_uncovers(self):
        found = talus.compare(FIRST, changed("shifted", shifted_by_two_cells))
        deposit = talus.open_run(FIRST).maps().deposit_thickness.values
        there = numpy.pad(deposit, ((0, 0), (2, 0)))  # the second map reaches further east
        here = numpy.pad(deposit, ((0, 0), (0, 2)))
        self.assertAlmostEqual(found.elsewhere, abs(there - here).sum() / 2 / here.sum(), places=12)
        self.assertEqual(found.threshold_m, 0.1)
        there, here = there > 0.1, here > 0.1
        both, either = (there & here).sum(), (there | here).sum()
        self.assertAlmostEqual(found.deposit_csi, both / either, places=12)
        self.assertEqual(found.volume_second_m3, found.volume_first_m3)

    def test_a_thinner_deposit_lies_in_the_same_place(self):
        found = talus.compare(FIRST, changed("thin", thinned))
        self.assertLess(found.elsewhere, 1e-12)
        self.assertAlmostEqual(found.volume_second_m3 / found.volume_first_m3, 0.5)
        self.assertLess(found.deposit_csi, 1)
        self.assertGreater(found.rms_m, 1)

    def test_what_cannot_be_compared_is_refused(self):
        def elsewhere(file):
            file["maps"].attrs["crs_wkt"] = "another"

        with self.assertRaisesRegex(talus.TalusError, "coordinate systems differ"):
            talus.compare(FIRST, changed("other-crs", elsewhere))
        with self.assertRaisesRegex(talus.TalusError, "no deposit"):
            talus.compare(FIRST, changed("empty", lambda file: file["maps/deposit_thickness"].__setitem__(..., 0.0)))
