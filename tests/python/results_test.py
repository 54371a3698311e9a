# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads runs, maps and surveys, and holds them against what other readers find in the same files."""
import csv
import shutil
import unittest

import h5py
import numpy
import rasterio
import talus
from scene import FIRST, HERE, SECOND


class ResultsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.run_ = talus.open_run(FIRST)

    def test_facts_are_those_of_the_file(self):
        self.assertEqual(self.run_.facts["title"], "Bowl")
        self.assertEqual(self.run_.facts["volume_released_m3"], 6400.0)
        self.assertEqual(self.run_.provenance["released_cells"], "16")
        self.assertIn("coarse-grid", [found["name"] for found in self.run_.findings if found["severity"] == "warning"])
        self.assertIn("256 points", repr(self.run_))

    def test_history_has_the_columns_of_the_csv_with_units(self):
        history = self.run_.history()
        with open(FIRST / "history.csv", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual({"time_s", *history.data_vars}, set(rows[0]))
        for name, unit in (("kinetic_J", "J"), ("speed_max_m_s", "m s-1"), ("packing_p99", "1")):
            self.assertEqual(history[name].units, unit)
            numpy.testing.assert_allclose(history[name], [float(row[name]) for row in rows], rtol=1e-6)
        numpy.testing.assert_allclose(history.time, [float(row["time_s"]) for row in rows])

    def test_maps_lie_where_the_geotiffs_do(self):
        maps = self.run_.maps()
        for name in ("deposit_thickness", "peak_speed", "peak_pressure", "arrival_time"):
            with rasterio.open(FIRST / f"maps/{name}.tif") as file:
                for row, column in ((9, 5), (10, 7), (19, 0), (0, 19)):
                    x, y = file.xy(row, column)
                    theirs = file.read(1, masked=True)[row, column]
                    ours = maps[name].sel(x=x, y=y).item()
                    numpy.testing.assert_equal(numpy.ma.filled(theirs, numpy.nan), ours, f"{name} {row} {column}")
        self.assertEqual(maps.peak_pressure.units, "kPa")
        volume = maps.deposit_thickness.sum().item() * 100
        # what docs/reference/formats.md says
        self.assertAlmostEqual(volume / self.run_.facts["volume_final_m3"], 1, delta=1e-9)

    def test_maps_carry_their_crs(self):
        crs = rasterio.crs.CRS.from_wkt(self.run_.maps().spatial_ref.crs_wkt)
        self.assertEqual(crs.to_epsg(), 32633)
        raster = talus.read_raster(FIRST / "maps/deposit_thickness.tif")
        self.assertEqual(rasterio.crs.CRS.from_wkt(raster.spatial_ref.crs_wkt), crs)
        numpy.testing.assert_array_equal(raster, self.run_.maps().deposit_thickness)
        numpy.testing.assert_array_equal(raster.y, self.run_.maps().y)
        self.assertEqual(raster.units, "m")

    def test_frames_are_read_when_they_are_looked_at(self):
        shutil.copyfile(FIRST / "run.h5", HERE / "moved.h5")
        frames = talus.open_run(HERE / "moved.h5").thickness()
        first = frames.isel(time=0)
        last = frames.sel(time=3.0).values
        with h5py.File(FIRST / "run.h5") as file:
            whole = file["frames/thickness"][:]
            numpy.testing.assert_array_equal(frames.time, file["frames/time"])
        numpy.testing.assert_array_equal(last, whole[-1])
        numpy.testing.assert_array_equal(frames[::-1, 2:9:3, ::-2], whole[::-1, 2:9:3, ::-2])
        numpy.testing.assert_array_equal(frames[:, [7, 3], 5], whole[:, [7, 3], 5])
        (HERE / "moved.h5").unlink()
        with self.assertRaises(OSError):  # nothing of it is in memory
            first.values

    def test_points_of_a_frame_hold_the_volume(self):
        first, last = self.run_.points(0), self.run_.points()
        self.assertEqual(first.volume.sum().item(), 6400.0)
        self.assertEqual((first.time.item(), last.time.item()), (0.0, 3.0))
        self.assertEqual((last.velocity.dims, last.velocity.units, last.pressure.units),
                         (("point", "axis"), "m s-1", "Pa"))
        self.assertEqual(float(abs(first.velocity).max()), 0)
        # They fall: the mean height sinks as the energy does, m g dz, but for what points and grid differ by.
        history = self.run_.history()
        fall = (first.z * first.volume).sum().item() - (last.z * last.volume).sum().item()
        lost = (history.potential_J[0] - history.potential_J[-1]).item()
        self.assertAlmostEqual(fall * self.run_.facts["density_kg_m3"] * 9.81 / lost, 1, delta=1e-4)
        with self.assertRaises(IndexError):
            self.run_.points(2)

    def test_score_and_used_recipe(self):
        self.assertEqual(self.run_.score()["volume_released_m3"], 6400.0)
        self.assertEqual(self.run_.used()["solve.base.friction_angle_deg"], 15.0)
        self.assertEqual(talus.open_run(SECOND).used()["solve.base.friction_angle_deg"], 10.0)

    def test_survey_has_facts_and_rasters(self):
        survey = self.run_.survey()
        self.assertEqual(survey.facts["source"]["volume_m3"], 6400.0)
        self.assertIn("difference", survey.names)
        self.assertEqual(survey.raster("difference").min().item(), -4.0)
        surface = survey.raster("sliding_surface")  # nodata beside the source
        self.assertEqual(int(numpy.isfinite(surface).sum()), 16)
        with self.assertRaisesRegex(talus.TalusError, "no such raster. There are: after_aligned"):
            survey.raster("diference")

    def test_what_is_no_run_is_said(self):
        with self.assertRaisesRegex(talus.TalusError, "there is no run.h5 in it"):
            talus.open_run(HERE / "nowhere")
        (HERE / "broken").mkdir(exist_ok=True)
        (HERE / "broken/run.h5").write_bytes((FIRST / "run.h5").read_bytes()[:600])
        with self.assertRaisesRegex(talus.TalusError, "cannot be read as HDF5"):
            talus.open_run(HERE / "broken")
        with h5py.File(HERE / "broken/run.h5", "w") as file:
            file.attrs.update({"format": "talus-run", "format_version": 99})
        with self.assertRaisesRegex(talus.TalusError, "its format: 99"):
            talus.open_run(HERE / "broken")
        with self.assertRaisesRegex(talus.TalusError, "there is no survey.json"):
            talus.read_survey(HERE / "broken")
