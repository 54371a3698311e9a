# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""QGIS: material points over time as a layer, from run.h5 through GDAL's reader of HDF5."""
import datetime

from osgeo import gdal
from qgis.core import (
    QgsFeature,
    QgsGeometry,
    QgsGraduatedSymbolRenderer,
    QgsMarkerSymbol,
    QgsPointXY,
    QgsProcessingException,
    QgsRendererRange,
    QgsVectorLayer,
    QgsVectorLayerTemporalProperties,
)
from qgis.PyQt.QtCore import QDateTime, Qt
from qgis.PyQt.QtGui import QColor

from .results import start_of, stride_for

NOMINAL = "seconds since 1970-01-01 00:00:00"  # as Talus counts where nobody says when the failure began

# Lower limits of the classes [m/s], and their colours: those of the maps of speed.
SPEEDS = [(0, "#dfe8e0"), (0.5, "#c4ebd3"), (1, "#8fd0c4"), (5, "#58b0bd"), (10, "#3c88b3"), (25, "#395b9c"),
          (50, "#3b2f73")]


class _Points:
    """The lists of run.h5 that VTKHDF names."""

    def __init__(self, path):
        self.file = gdal.OpenEx(path, gdal.OF_MULTIDIM_RASTER)
        root = self.file.GetRootGroup() if self.file is not None else None
        self.group = root.OpenGroup("VTKHDF") if root is not None else None
        self.steps = self.group.OpenGroup("Steps") if self.group is not None else None

    def known(self):
        return self.steps is not None and "Points" in (self.group.GetMDArrayNames() or [])

    def column(self, group, name):
        return group.OpenMDArray(name).ReadAsArray()

    def rows(self, group, name, first, count, stride):
        """Every `stride`-th row of `count`, from `first`."""
        array = group.OpenMDArray(name)
        taken = (count + stride - 1) // stride
        return array.ReadAsArray([first, 0], [taken, 3], [stride, 1])


def _start(results):
    """When time begins, as results.nc has it; GDAL keeps units apart from the other attributes."""
    file = gdal.OpenEx(results.netcdf, gdal.OF_MULTIDIM_RASTER) if results.netcdf else None
    time = file.GetRootGroup().OpenMDArray("time") if file is not None else None
    return start_of(time.GetUnit() if time is not None else NOMINAL)


def _instant(start, seconds):
    when = start + datetime.timedelta(seconds=float(seconds))
    return QDateTime.fromString(when.strftime("%Y-%m-%dT%H:%M:%S.") + f"{when.microsecond // 1000:03d}Z",
                                Qt.ISODateWithMs)


def _renderer():
    ranges = []
    for i, (low, colour) in enumerate(SPEEDS):
        high = SPEEDS[i + 1][0] if i + 1 < len(SPEEDS) else 1e9
        symbol = QgsMarkerSymbol.createSimple({"name": "circle", "size": "0.9", "outline_style": "no"})
        symbol.setColor(QColor(colour))
        words = f"> {low} m/s" if high == 1e9 else f"{low} \u2013 {high} m/s"
        ranges.append(QgsRendererRange(low, high, symbol, words))
    return QgsGraduatedSymbolRenderer("speed", ranges)


def points_layer(results, crs, most, feedback):
    """Every n-th point of every frame, so that all frames together hold at most `most`; with speed [m/s], elevation
    [m], its id and the instant, from which the Temporal Controller shows it until the next frame. None, with a warning,
    where the run kept no points."""
    points = _Points(results.run) if results.run else None
    if points is None or not points.known():
        feedback.pushWarning("run.h5 is not there or holds no points over time (point_frames): no layer of points.")
        return None
    times = points.column(points.steps, "Values")
    offsets, counts = points.column(points.steps, "PointOffsets"), points.column(points.group, "NumberOfPoints")
    stride, start = stride_for([int(n) for n in counts], most), _start(results)
    layer = QgsVectorLayer(
        "Point?field=id:integer&field=speed:double&field=elevation:double&field=time:datetime", "Points over time",
        "memory")
    if not layer.isValid():
        raise QgsProcessingException("QGIS could not make a layer for the points.")
    layer.setCrs(crs)
    for frame, time in enumerate(times):
        if feedback.isCanceled():
            return None
        first, count = int(offsets[frame]), int(counts[frame])
        where = points.rows(points.group, "Points", first, count, stride)
        velocity = points.rows(points.group.OpenGroup("PointData"), "velocity", first, count, stride)
        _add(layer, where, velocity, stride, _instant(start, time))
        feedback.setProgress(100.0 * (frame + 1) / len(times))
    layer.updateExtents()
    layer.setRenderer(_renderer())
    _set_time(layer, times)
    if stride > 1:
        feedback.pushInfo(f"Points over time: every {stride}th point of {int(counts[0])} is shown.")
    return layer


def _add(layer, where, velocity, stride, instant):
    features = []
    for k, (place, speed) in enumerate(zip(where, velocity)):
        feature = QgsFeature(layer.fields())
        feature.setGeometry(QgsGeometry.fromPointXY(QgsPointXY(float(place[0]), float(place[1]))))
        size = float((speed[0] ** 2 + speed[1] ** 2 + speed[2] ** 2) ** 0.5)
        feature.setAttributes([k * stride, size, float(place[2]), instant])
        features.append(feature)
    layer.dataProvider().addFeatures(features)


def _set_time(layer, times):
    """Each point is there until the next frame."""
    step = float(times[1] - times[0]) if len(times) > 1 else 1.0
    properties = layer.temporalProperties()
    properties.setMode(QgsVectorLayerTemporalProperties.ModeFeatureDateTimeInstantFromField)
    properties.setStartField("time")
    properties.setFixedDuration(step)
    properties.setDurationUnits(0)
    properties.setIsActive(True)
