# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What run.h5 holds, for comparison."""
import h5py
import numpy as np


class Run:
    """Frames and points of a run."""

    def __init__(self, folder):
        self.file = h5py.File(f"{folder}/run.h5", "r")
        maps = self.file["maps"].attrs
        self.cell = float(maps["cell_m"])
        self.west, self.south = float(maps["west_m"]), float(maps["south_m"])
        self.columns, self.rows = int(maps["columns"]), int(maps["rows"])
        self.times = np.array(self.file["frames/time"])
        self.density = float(self.file.attrs["density_kg_m3"])

    def thickness(self, frame):
        return np.nan_to_num(np.array(self.file["frames/thickness"][frame]))

    def points(self, frame):
        """positions [m], velocities [m/s], volumes [m3] of a frame."""
        group = self.file["VTKHDF"]
        first, count = group["Steps/PointOffsets"][frame], group["NumberOfPoints"][frame]
        rows = slice(int(first), int(first + count))
        data = group["PointData"]
        return (
            np.array(group["Points"][rows]),
            np.array(data["velocity"][rows], dtype=float),
            np.array(data["volume"][rows], dtype=float),
        )

    def point_times(self):
        return np.array(self.file["VTKHDF/Steps/Values"])


def expect(name, found, wanted, tolerance):
    """Stops where two numbers, or lists of them, differ by more than `tolerance`."""
    a, b = np.asarray(found, dtype=float), np.asarray(wanted, dtype=float)
    if a.shape != b.shape:
        raise SystemExit(f"FAILED {name}: of shape {a.shape} instead of {b.shape}")
    error = float(np.abs(a - b).max()) if b.size else 0.0
    words = f"{name}: {a.ravel()[:3]} beside {b.ravel()[:3]}, off by {error:.3g}"
    if not error <= tolerance:
        raise SystemExit(f"FAILED {words} (allowed {tolerance:.3g})")
    return words
