# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What talus-preprocess found in two elevation models."""
import json
import pathlib

from talus.errors import TalusError
from talus.rasters import read_raster


class Survey:
    """The folder `survey` of a run: facts and rasters (docs/reference/formats.md, survey)."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        try:
            self.facts = json.loads((self.folder / "survey.json").read_text(encoding="utf-8"))  # units in the names
        except OSError as error:
            raise TalusError(
                f"{self.folder}: there is no survey.json in it. A survey is written where the recipe gives before_dem"
                " and after_dem, or a sliding surface was computed") from error

    @property
    def names(self):
        """The names of the rasters that are there."""
        return sorted(path.stem for path in self.folder.glob("*.tif"))

    def raster(self, name):
        """A raster as a DataArray: "difference" (after less before, m), "source_thickness" (vertical, m), ..."""
        path = self.folder / f"{name}.tif"
        if not path.exists():
            raise TalusError(f"{path}: no such raster. There are: {', '.join(self.names) or 'none'}")
        return read_raster(path).rename(name)


def read_survey(path):
    """The survey in a folder of results, or in the folder `survey` itself. Raises TalusError where there is none."""
    path = pathlib.Path(path)
    return Survey(path if (path / "survey.json").exists() else path / "survey")
