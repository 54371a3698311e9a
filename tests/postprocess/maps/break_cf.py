#!/usr/bin/python3
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Breaks copies of a file without faults, one requirement of CF at a time: check_cf.py must find every break.

usage: break_cf.py FILE.nc               breaks that were not found, one a line; exit code 1 if there are any
"""
import os
import sys
import tempfile

import netCDF4
import numpy

sys.dont_write_bytecode = True  # nothing is left beside the sources
from check_cf import Check, writable_copy  # noqa: E402


def put(variable, attribute, value):
    return lambda f: f[variable].setncattr(attribute, value)


def drop(variable, attribute):
    return lambda f: f[variable].delncattr(attribute)


def set_value(variable, place, value):
    def change(f):
        f[variable][place] = value

    return change


BREAKS = {  # a requirement and how a copy of the file is made to miss it
    "2.3 name": lambda f: f.renameVariable("peak_speed", "peak-speed"),
    "2.5.1 missing_value": put("peak_speed", "missing_value", numpy.float32(-9999)),
    "2.6.1": lambda f: f.setncattr("Conventions", "CF-1.8x"),
    "2.6.2": lambda f: f.delncattr("institution"),
    "3": drop("crs", "long_name"),
    "3.1 missing": drop("peak_speed", "units"),
    "3.1 unknown": put("peak_speed", "units", "heaps"),
    "3.1 standard_name": put("x", "units", "s"),
    "3.3": put("peak_speed", "standard_name", "speed_of_a_landslide"),
    "4 data with axis": put("peak_speed", "axis", "X"),
    "4 axis": put("x", "axis", "W"),
    "4.4": put("time", "units", "s"),
    "4.4 legal": put("time", "units", "seconds since 1999-02-31 00:00:00"),
    "4.4.1": put("time", "calendar", "mayan"),
    "4.4.1 reform": put("time", "units", "seconds since 1582-10-01 00:00:00"),
    "5 monotonic": set_value("x", 1, 0),
    "5 coordinates": put("peak_speed", "coordinates", "nowhere"),
    "5.6": put("peak_speed", "grid_mapping", "nowhere"),
    "5.6 grid_mapping_name": put("crs", "grid_mapping_name", "flat_earth"),
    "5.6 names": drop("crs", "horizontal_datum_name"),
    "5.6 crs_wkt": put("crs", "crs_wkt", "PROJCRS["),
    "5.6.1 consistent": put("crs", "false_easting", 400000.0),
    "F missing": drop("crs", "latitude_of_projection_origin"),
    "F type": put("crs", "false_easting", "500000"),
    "7.1 exists": put("x", "bounds", "nowhere"),
    "7.1 attributes": put("x_bnds", "units", "m"),
    "7.1 cells": set_value("x_bnds", (0, 0), 1e9),
    "7.3 form": put("thickness", "cell_methods", "time point"),
    "7.3 method": put("thickness", "cell_methods", "time: biggest"),
    "7.3 name": put("thickness", "cell_methods", "z: mean time: point"),
    "7.3 twice": put("thickness", "cell_methods", "time: mean time: point"),
    "8.1": put("peak_speed", "scale_factor", 2.0),
}


def unseen_breaks(path):
    unseen = []
    for name, change in BREAKS.items():
        with tempfile.TemporaryDirectory() as folder:
            copy = os.path.join(folder, "broken.nc")
            writable_copy(path, copy)
            with netCDF4.Dataset(copy, "a") as file:
                file.set_auto_maskandscale(False)
                change(file)
            found = Check(copy).run()
        if not any(fault.startswith(name.split()[0] + ":") for fault in found):
            unseen.append(f"{name}: broken and not seen; found instead: {found}")
    return unseen


if __name__ == "__main__":
    lines = unseen_breaks(sys.argv[1])
    print("\n".join(lines) if lines else "no faults")
    sys.exit(1 if lines else 0)
