# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""QGIS: results as layers: those of the project that talus-postprocess writes, and on request the material points."""
from qgis.core import QgsLayerTreeGroup, QgsLayerTreeLayer, QgsProcessingException, QgsProject
from qgis.PyQt.QtXml import QDomDocument

from .points import points_layer


def _copy_of(layer):
    """The layer again, in its style and with its time, for another project."""
    copy, style = layer.clone(), QDomDocument()
    error = layer.exportNamedStyle(style)
    done, words = copy.importNamedStyle(style) if not error else (False, error)
    if not done:
        raise QgsProcessingException(f"{layer.name()}: its style could not be taken over ({words}).")
    return copy


def _copy_group(source, target, project, feedback):
    """Copies what stands below `source` to `target`; returns the number of layers."""
    count = 0
    for node in source.children():
        if isinstance(node, QgsLayerTreeGroup):
            group = target.addGroup(node.name())
            count += _copy_group(node, group, project, feedback)
            group.setItemVisibilityChecked(node.itemVisibilityChecked())
            group.setExpanded(node.isExpanded())
        elif isinstance(node, QgsLayerTreeLayer):
            layer = node.layer()
            if layer is None or not layer.isValid():
                feedback.pushWarning(f"{node.name()}: its file is missing or broken; the layer is left out.")
                continue
            copy = _copy_of(layer)
            project.addMapLayer(copy, False)
            added = target.addLayer(copy)
            added.setItemVisibilityChecked(node.itemVisibilityChecked())
            added.setExpanded(node.isExpanded())
            count += 1
    return count


def load_results(project, results, feedback, flow=True, points=0):
    """Adds a group on top of `project` with all layers of the results' own project, without those of the flow over time
    where `flow` is False, and a sample of at most `points` material points over time. Returns the number of layers.
    Raises QgsProcessingException where the folder holds no project."""
    path = results.project()
    if path is None:
        raise QgsProcessingException(
            f"{results.maps_folder}: there is no project (*.qgs). Run talus-postprocess again; it writes one."
        )
    source = QgsProject()
    if not source.read(path):
        raise QgsProcessingException(f"{path}: QGIS cannot read it ({source.error()}). Run talus-postprocess again.")
    if not flow:
        root = source.layerTreeRoot()
        for node in [n for n in root.children() if n.name().startswith("Flow over time")]:
            root.removeChildNode(node)
    if not project.mapLayers() and source.crs().isValid():
        project.setCrs(source.crs())
    group = project.layerTreeRoot().insertGroup(0, source.title() or path)
    count = _copy_group(source.layerTreeRoot(), group, project, feedback)
    times = source.timeSettings().temporalRange()
    if flow and not times.begin().isNull() and project.timeSettings().temporalRange().begin().isNull():
        project.timeSettings().setTemporalRange(times)
        project.timeSettings().setTimeStep(source.timeSettings().timeStep())
        project.timeSettings().setTimeStepUnit(source.timeSettings().timeStepUnit())
        project.timeSettings().setFramesPerSecond(source.timeSettings().framesPerSecond())
    if points:
        layer = points_layer(results, source.crs(), points, feedback)
        if layer is not None:
            project.addMapLayer(layer, False)
            group.insertLayer(0, layer)
            count += 1
    feedback.pushInfo(f"{count} layers were added from {path}")
    return count
