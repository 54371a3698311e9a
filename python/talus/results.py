# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the results of a run (docs/reference/formats.md)."""
import json
import pathlib

import h5py
import numpy
import xarray

from talus.errors import TalusError
from talus.frames import on_disk
from talus.rasters import on_map
from talus.recipe import Recipe
from talus.survey import read_survey

_VERSION = 1  # of run.h5


def open_run(path):
    """The run in a folder of results, or in a run.h5. Raises TalusError where there is none that can be read."""
    path = pathlib.Path(path)
    file = path if path.is_file() else path / "run.h5"
    if not file.is_file():
        raise TalusError(f"{path}: there is no run.h5 in it. Name the folder of results of a run: what --out was")
    return Run(file)


class Run:
    """A run of talus-solve, and what talus-postprocess made of it. Files are opened for each look and closed again."""

    def __init__(self, file):
        self.file = pathlib.Path(file).absolute()
        self.folder = self.file.parent
        try:
            with h5py.File(self.file) as opened:
                self.facts = {name: _plain(value) for name, value in opened.attrs.items()}  # units in the names
                self.provenance = {_plain(group.attrs["key"]): _plain(group.attrs["value"])
                                   for group in opened.get("provenance", {}).values()}
                self._grid = {k: _plain(v) for k, v in opened["maps"].attrs.items()} if "maps" in opened else None
        except OSError as error:
            raise TalusError(f"{self.file}: it cannot be read as HDF5 ({error}). Run talus-solve again") from error
        version = self.facts.get("format_version")
        if self.facts.get("format") != "talus-run" or version != _VERSION or self._grid is None:
            raise TalusError(f"{self.file}: this is no run of Talus of format {_VERSION} (its format: {version})."
                             " Take the Python package of the programs that wrote it")

    def __repr__(self):
        return (f"<talus.Run {self.facts['scene']}: {self.facts['particles']} points, {self.facts['time_end_s']:g} s,"
                f" {self.file}>")

    @property
    def crs_wkt(self):
        """The CRS as WKT; "" for local metric coordinates."""
        return self._grid["crs_wkt"]

    @property
    def findings(self):
        """Advice, warnings and overridden refusals of the stages: dictionaries with `severity` ("advice", "warning" or
        "refusal"), `name`, `message`, `numbers` ({name: {"value", "unit"}}), `stage` and `accepted_by`."""
        with h5py.File(self.file) as file:
            return json.loads(file["findings"][:].tobytes())

    def history(self):
        """The history as a Dataset on `time` [s]; a variable for each column, attributes `units`, also of a gauge or
        obstacle `quantity` and `place`."""
        with h5py.File(self.file) as file:
            columns = {name: (data[:], _attributes(data)) for name, data in file["history"].items()}
        time, attributes = columns.pop("time_s")
        variables = {name: ("time", values, about) for name, (values, about) in columns.items()}
        return xarray.Dataset(variables, {"time": ("time", time, attributes)}, {"title": self.facts["title"]})

    def maps(self):
        """The maps as a Dataset on y and x (centres of cells [m], south to north), NaN where there is no value:
        `terrain`, `before` [m], `initial_thickness`, `deposit_thickness`, `peak_thickness` [m, vertical],
        `peak_speed` [m s-1], `peak_pressure` [kPa], `arrival_time` [s] and what else the run has."""
        with h5py.File(self.file) as file:
            found = {}
            for name, data in file["maps"].items():
                for one, values in data.items() if isinstance(data, h5py.Group) else [(None, data)]:
                    whole = name if one is None else f"{name}_{one}"
                    found[whole] = self._map(whole, values[:], _attributes(values))
        maps = xarray.Dataset(found, attrs={"title": self.facts["title"], "scene": self.facts["scene"]})
        return maps.assign_attrs(threshold_m=float(self._grid["threshold_m"]))

    def thickness(self):
        """Vertical thickness [m] of everything at the frames, on time [s], y and x. A frame is read when it is looked
        at: `run.thickness().isel(time=-1)` reads one."""
        with h5py.File(self.file) as file:
            time = file["frames/time"][:]
        frames = self._map("thickness", on_disk(self.file, "frames/thickness"),
                           {"units": "m", "long_name": "thickness, vertical"})
        return frames.assign_coords(time=("time", time, {"units": "s", "long_name": "time from the failure"}))

    def points(self, frame=-1):
        """The material points at a frame (0 the first, -1 the last) as a Dataset on `point`: x, y, z [m], `velocity`
        on `axis` [m s-1], `volume` [m3], `pressure` [Pa, compression positive], `id`, `release`."""
        with h5py.File(self.file) as file:
            if "VTKHDF" not in file:
                raise TalusError(f"{self.file}: it holds no points. Run it again without solve.point_frames")
            group, steps = file["VTKHDF"], file["VTKHDF/Steps"]
            times = steps["Values"][:]
            if not -len(times) <= frame < len(times):
                raise IndexError(f"frame {frame}: {self.file} has {len(times)} frames with points")
            first = int(steps["PointOffsets"][frame])
            span = slice(first, first + int(group["NumberOfPoints"][int(steps["PartOffsets"][frame])]))
            places = group["Points"][span]
            data = {name: values[span] for name, values in group["PointData"].items()}
        variables = {name: ("point", places[:, i], {"units": "m"}) for i, name in enumerate("xyz")}
        units = {"velocity": "m s-1", "volume": "m3", "pressure": "Pa"}
        for name, values in data.items():
            dimensions = ("point", "axis") if values.ndim == 2 else ("point",)
            variables[name] = (dimensions, values, {"units": units.get(name, "1")})
        coordinates = {"axis": list("xyz"), "time": ((), times[frame], {"units": "s"})}
        return xarray.Dataset(variables, coordinates, {"crs_wkt": self.crs_wkt})

    def score(self):
        """score.json: numbers and texts by name, units at the end of names; `not_scored` maps names to reasons."""
        path = self.folder / "score.json"
        try:
            return json.loads(path.read_text(encoding="utf-8"))
        except OSError as error:
            raise TalusError(f"{path}: {error.strerror}. Run talus-postprocess on this run first") from error

    def survey(self):
        """What talus-preprocess found in the two elevation models."""
        return read_survey(self.folder)

    def used(self, stage="solve"):
        """The recipe that a stage used, defaults filled in: "preprocess", "solve" or "postprocess"."""
        return Recipe.read(self.folder / f"{stage}.used.toml")

    def _map(self, name, values, about):
        grid = self._grid
        array = on_map(values, grid["west_m"], grid["south_m"], grid["cell_m"], about["units"],
                       about.get("long_name", name), grid["crs_wkt"], name)
        array.attrs.update({key: value for key, value in about.items() if key not in array.attrs})
        return array


def _plain(value):
    if isinstance(value, bytes):
        return value.decode("utf-8")
    return value.item() if isinstance(value, numpy.generic) else value


def _attributes(data):
    """Attributes of a dataset, with `unit` under the name that xarray and CF have for it."""
    about = {name: _plain(value) for name, value in data.attrs.items()}
    return {"units": about.pop("unit", "1"), **about}
