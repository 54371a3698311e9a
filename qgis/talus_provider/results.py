# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What lies in a folder of results, by its names alone."""
import datetime
import os
import re


class Results:
    """The files that talus-postprocess has left in `folder`."""

    def __init__(self, folder):
        self.folder = os.path.abspath(folder)
        self.maps_folder = os.path.join(self.folder, "maps")
        if not os.path.isdir(self.maps_folder):
            raise FileNotFoundError(
                f"{self.maps_folder}: no such folder. Choose the folder of results of a run (--out), which holds maps/"
            )

    def _file(self, *names):
        path = os.path.join(self.folder, *names)
        return path if os.path.isfile(path) else None

    netcdf = property(lambda self: self._file("maps", "results.nc"))
    run = property(lambda self: self._file("run.h5"))
    report = property(lambda self: self._file("report.html"))

    def project(self):
        """The project of QGIS that lies beside the maps; None where there is none."""
        found = sorted(n for n in os.listdir(self.maps_folder) if n.endswith(".qgs"))
        return os.path.join(self.maps_folder, found[0]) if found else None


def start_of(units):
    """The instant from which a CF time counts: "seconds since 1903-04-29 04:10:00" -> datetime, UTC."""
    found = re.match(r"^seconds since (\d{4})-(\d\d)-(\d\d)[ T](\d\d):(\d\d):(\d\d)", units)
    if not found:
        raise ValueError(f'the time of results.nc has the units "{units}" instead of seconds since a date')
    return datetime.datetime(*(int(part) for part in found.groups()), tzinfo=datetime.timezone.utc)


def stride_for(counts, most):
    """The smallest n for which every n-th of each of `counts` makes no more than `most` together."""
    stride = max(1, -(-sum(counts) // max(most, 1)))
    while sum(-(-count // stride) for count in counts) > most and stride < max(counts):
        stride += 1
    return stride
