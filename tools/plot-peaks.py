#!/usr/bin/env python3
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws peak thickness (normal to the slope) and peak speed of a run beside those of other models.

usage: tools/plot-peaks.py PNG DEM.tif RUN=OUT_FOLDER NAME=FOLDER/PREFIX...
       (Debian: python3-matplotlib, python3-gdal)

OUT_FOLDER is what a pipeline leaves, with maps/peak_thickness.tif (vertical) and maps/peak_speed.tif; of the others
PREFIX_pft.tif (normal to the slope) and PREFIX_pfv.tif are read, as the ISeeSnow project names them. docs/pictures/
realtopo-peak.png is made so:

  tools/plot-peaks.py docs/pictures/realtopo-peak.png $D/dem.tif "Talus, 10 m=build/iseesnow-realtopo" \
    com1DFA=$D/com1DFA RAMMS=$D/RAMMSUSER r.avaflow=$D/avaflow          (D=../shared/data/iseesnow_realtopo)
"""
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from osgeo import gdal

gdal.UseExceptions()


class Raster:
    def __init__(self, path):
        data = gdal.Open(str(path))
        self.x, self.cell, _, self.y, _, _ = data.GetGeoTransform()
        band = data.GetRasterBand(1)
        values = band.ReadAsArray().astype(float)
        none = band.GetNoDataValue()
        self.values = np.where(np.isfinite(values) & (values != none), values, np.nan)

    def extent(self):
        rows, columns = self.values.shape
        return [self.x, self.x + columns * self.cell, self.y - rows * self.cell, self.y]


def at_cells_of(raster, other):
    """The values of `other` at the centres of the raster's cells."""
    rows, columns = np.indices(raster.values.shape)
    i = ((raster.x + (columns + 0.5) * raster.cell - other.x) / other.cell).astype(int)
    j = ((other.y - raster.y + (rows + 0.5) * raster.cell) / other.cell).astype(int)
    return other.values[j.clip(0, other.values.shape[0] - 1), i.clip(0, other.values.shape[1] - 1)]


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    picture, ground = sys.argv[1], Raster(sys.argv[2])
    ground.values[ground.values < -1000] = np.nan
    down, right = np.gradient(ground.values, ground.cell)
    shade = (0.7 - 0.5 * right - 0.5 * down) / np.sqrt(1 + right**2 + down**2)
    slope = Raster(sys.argv[2])
    slope.values = 1 / np.sqrt(1 + right**2 + down**2)
    models = []
    for argument in sys.argv[3:]:
        name, place = argument.split("=", 1)
        own = pathlib.Path(place).is_dir()
        thickness = Raster(f"{place}/maps/peak_thickness.tif" if own else f"{place}_pft.tif")
        speed = Raster(f"{place}/maps/peak_speed.tif" if own else f"{place}_pfv.tif")
        if own:
            thickness.values = thickness.values * at_cells_of(thickness, slope)
        # Speed counts where there is flow.
        speed.values = np.where(np.nan_to_num(at_cells_of(speed, thickness)) > 0.1, speed.values, np.nan)
        thickness.values = np.where(np.nan_to_num(thickness.values) > 0.1, thickness.values, np.nan)
        models.append((name, thickness, speed))
    boxes = []
    for _, thickness, _ in models:
        rows, columns = np.where(np.isfinite(thickness.values))
        boxes.append([thickness.x + columns.min() * thickness.cell, thickness.x + columns.max() * thickness.cell,
                      thickness.y - rows.max() * thickness.cell, thickness.y - rows.min() * thickness.cell])
    box = [min(b[0] for b in boxes) - 60, max(b[1] for b in boxes) + 60, min(b[2] for b in boxes) - 60,
           max(b[3] for b in boxes) + 60]
    aspect = (box[3] - box[2]) / (box[1] - box[0])
    high = min(3.4 * aspect, 5.0)  # of a map [inches]
    size = (max(high / aspect, 1.6) * len(models) + 1.2, 2 * high + 0.6)
    figure, axes = plt.subplots(2, len(models), figsize=size, constrained_layout=True, squeeze=False)
    for row, title in enumerate(["peak thickness, normal to the slope [m]", "peak speed [m/s]"]):
        top = np.ceil(max(np.nanpercentile(model[1 + row].values, 99) for model in models))
        for column, model in enumerate(models):
            axis, raster = axes[row][column], model[1 + row]
            axis.imshow(shade, cmap="gray", extent=ground.extent(), vmin=-0.6, vmax=1.4)
            image = axis.imshow(raster.values, cmap="viridis", extent=raster.extent(), vmin=0, vmax=top)
            axis.set(xlim=box[:2], ylim=box[2:], xticks=[], yticks=[])
            if row == 0:
                axis.set_title(model[0])
            if row == 1 and column == 0:
                axis.plot([box[0] + 60, box[0] + 560], [box[2] + 70] * 2, color="black", lw=3)
                axis.text(box[0] + 60, box[2] + 100, "500 m")
            inside = raster.values[np.isfinite(raster.values)]
            if inside.size:
                axis.text(0.97, 0.97, f"99 %: {np.percentile(inside, 99):.0f}", transform=axis.transAxes, ha="right",
                          va="top")
        figure.colorbar(image, ax=list(axes[row]), label=title, shrink=0.9, extend="max")
    figure.savefig(picture, dpi=110)


main()
