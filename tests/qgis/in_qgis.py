# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks inside a QgsApplication: cancelling, loading, time, the print layout."""
import os
import shutil
import subprocess
import sys

sys.path.append("/usr/share/qgis/python/plugins")  # where `processing` lies
from qgis.core import (  # noqa: E402
    QgsApplication,
    QgsDateTimeRange,
    QgsLayoutExporter,
    QgsLayoutItemLabel,
    QgsLayoutItemLegend,
    QgsLayoutItemMap,
    QgsLayoutItemPicture,
    QgsLayoutItemScaleBar,
    QgsMapRendererParallelJob,
    QgsMapSettings,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProject,
)
from qgis.PyQt.QtCore import QSize  # noqa: E402
from qgis.PyQt.QtGui import QImage  # noqa: E402

_APPLICATION = []


class Feedback(QgsProcessingFeedback):
    """Keeps what it is told; cancels at a percentage."""

    def __init__(self, cancel_above=1000.0):
        super().__init__(False)
        self.lines, self.percents, self.cancel_above = [], [], cancel_above
        self.progressChanged.connect(self.hear)

    def hear(self, percent):
        self.percents.append(percent)
        if percent > self.cancel_above:
            self.cancel()

    def pushInfo(self, info):  # noqa: N802
        self.lines.append(info)

    def pushWarning(self, warning):  # noqa: N802
        self.lines.append("warning: " + warning)

    def reportError(self, error, fatalError=False):  # noqa: N802, N803
        self.lines.append("error: " + error)


def start():
    """QGIS with Processing and the provider, once."""
    if not _APPLICATION:
        application = QgsApplication([], False)
        application.initQgis()
        from processing.core.Processing import Processing

        Processing.initialize()
        sys.path.append(os.environ["QGIS_PLUGINPATH"])
        from talus_provider.provider import TalusProvider

        provider = TalusProvider()
        assert QgsApplication.processingRegistry().addProvider(provider)
        _APPLICATION.extend([application, provider])


def run(name, parameters, feedback):
    """An algorithm of the provider in the present project: (results, whether it went well)."""
    start()
    context = QgsProcessingContext()
    context.setProject(QgsProject.instance())
    context.setFeedback(feedback)
    algorithm = QgsApplication.processingRegistry().algorithmById(f"talus:{name}")
    return algorithm.run(parameters, context, feedback)


def opened(path):
    """A project, every layer of which is there."""
    start()
    project = QgsProject.instance()
    project.clear()
    assert project.read(str(path)), f"QGIS does not read {path}: {project.error()}"
    broken = [layer.name() for layer in project.mapLayers().values() if not layer.isValid()]
    assert not broken, f"layers that QGIS finds broken: {broken}"
    return project


def drawn(layers, extent, time=None):
    """A picture of layers, as numbers: how many pixels are not white."""
    settings = QgsMapSettings()
    settings.setLayers(layers)
    settings.setExtent(extent)
    settings.setOutputSize(QSize(300, 300))
    if time is not None:
        settings.setIsTemporal(True)
        settings.setTemporalRange(time)
    job = QgsMapRendererParallelJob(settings)
    job.start()
    job.waitForFinished()
    image = job.renderedImage().convertToFormat(QImage.Format_RGB32)
    white = 0xFFFFFFFF
    return sum(image.pixel(x, y) & 0xFFFFFFFF != white for y in range(0, 300, 3) for x in range(0, 300, 3))


def check_runs_with_progress_and_loads(place):
    start()
    QgsProject.instance().clear()
    feedback = Feedback()
    results, well = run("runrecipe", {"RECIPE": f"{place.scene}/recipe.toml", "OUT": f"{place.work}/out", "ON": 1,
                                      "SET": "solve.end_time_s=4\n", "LOAD": True}, feedback)
    assert well, feedback.lines
    assert feedback.percents == sorted(feedback.percents) and 4 < max(feedback.percents), feedback.percents
    assert any(line.startswith("solve: ") for line in feedback.lines), feedback.lines
    assert results["PROJECT"] == f"{place.work}/out/maps/bowl.qgs", results
    names = [layer.name() for layer in QgsProject.instance().mapLayers().values()]
    assert "Deposit thickness, vertical [m]" in names and sum(n.startswith("Thickness at") for n in names) == 9, names


def check_cancel_leaves_a_checkpoint(place):
    feedback, out = Feedback(cancel_above=8), place.work / "cancelled"
    results, well = run("runrecipe", {"RECIPE": f"{place.scene}/recipe.toml", "OUT": str(out), "ON": 1, "LOAD": True,
                                      "SET": "solve.end_time_s=3000\nsolve.frame_interval_s=100"}, feedback)
    assert well and feedback.isCanceled(), feedback.lines
    assert (out / "checkpoint.h5").is_file(), f"no checkpoint: {feedback.lines}"
    assert not (out / "run.h5").exists() and "REPORT" not in results, results
    assert any("go on from there" in line for line in feedback.lines), feedback.lines
    again = Feedback(cancel_above=50)
    run("runrecipe", {"RECIPE": f"{place.scene}/recipe.toml", "OUT": str(out), "ON": 1,
                      "SET": "solve.end_time_s=3000\nsolve.frame_interval_s=100"}, again)
    assert any("resum" in line or "checkpoint" in line for line in again.lines), again.lines


def check_says_what_is_wrong(place):
    bad = place.scene / "wrong.toml"
    bad.write_text((place.scene / "recipe.toml").read_text().replace("before.tif", "nowhere.tif"))
    feedback = Feedback()
    _, well = run("runrecipe", {"RECIPE": str(bad), "OUT": f"{place.work}/wrong", "ON": 1}, feedback)
    said = "\n".join(feedback.lines)
    assert not well and "nowhere.tif" in said and "a file is wrong" in said, said


def check_loads_results_into_a_project(place):
    start()
    project = QgsProject.instance()
    project.clear()
    feedback = Feedback()
    results, well = run("loadresults", {"FOLDER": f"{place.work}/out", "POINTS": True, "COUNT": 500}, feedback)
    assert well and results["LAYERS"] == len(project.mapLayers()), (results, feedback.lines)
    assert project.crs().authid() == "EPSG:32611", project.crs().authid()
    points = project.mapLayersByName("Points over time")[0]
    assert 200 < points.featureCount() <= 500, points.featureCount()
    speeds = [feature["speed"] for feature in points.getFeatures()]
    assert max(speeds) > 1 and min(speeds) == 0, (min(speeds), max(speeds))
    extent = points.extent()
    assert 500000 < extent.xMinimum() < extent.xMaximum() < 500200, extent.toString()
    assert points.temporalProperties().isActive()
    flow = [layer for layer in project.mapLayers().values() if layer.name().startswith("Thickness at")]
    assert len(flow) == 9 and all(layer.temporalProperties().isActive() for layer in flow), len(flow)
    _, well = run("loadresults", {"FOLDER": f"{place.work}/out", "FLOW": False}, feedback)
    again = [layer for layer in project.mapLayers().values() if layer.name().startswith("Thickness at")]
    assert well and len(again) == 9, "without the flow over time its layers came all the same"
    _, well = run("loadresults", {"FOLDER": str(place.scene)}, feedback)
    assert not well and any("holds maps/" in line for line in feedback.lines), feedback.lines


def check_compares_two_runs(place):
    results, well = run("compareruns", {"FIRST": f"{place.work}/out", "SECOND": f"{place.work}/by-process"}, Feedback())
    with open(results["PAGE"], encoding="utf-8") as page:
        assert well and "Recipes: what differs" in page.read()


def check_project_has_a_time(place):
    project = opened(place.work / "out" / "maps" / "bowl.qgs")
    node = [n for n in project.layerTreeRoot().children() if n.name().startswith("Flow over time")][0]
    assert not node.itemVisibilityChecked(), "the frames lie on one another at first"
    frames = [n.layer() for n in node.children()]
    whole = project.timeSettings().temporalRange()
    assert abs(whole.begin().msecsTo(whole.end()) - 4500) < 1, whole.begin().msecsTo(whole.end())
    extent = frames[0].extent()
    seen = []
    for frame in frames:
        time = frame.temporalProperties().fixedTemporalRange()
        middle = time.begin().addMSecs(time.begin().msecsTo(time.end()) // 2)
        instant = QgsDateTimeRange(middle, middle)
        seen.append(drawn(frames, extent, instant))
        assert seen[-1] == drawn([frame], extent), f"{frame.name()}: the controller shows something else"
    assert len(set(seen)) > 2 and min(seen) > 10, f"the frames look alike: {seen}"


def check_project_has_a_print_layout(place):
    project = opened(place.work / "out" / "maps" / "bowl.qgs")
    layouts = project.layoutManager().printLayouts()
    assert [layout.name() for layout in layouts] == ["Map, A4"], [layout.name() for layout in layouts]
    layout = layouts[0]
    items = {kind: [item for item in layout.items() if isinstance(item, kind)]
             for kind in [QgsLayoutItemMap, QgsLayoutItemLegend, QgsLayoutItemScaleBar, QgsLayoutItemPicture,
                          QgsLayoutItemLabel]}
    assert [len(found) for found in items.values()] == [1, 1, 1, 1, 3], items
    page = items[QgsLayoutItemMap][0]
    assert items[QgsLayoutItemScaleBar][0].linkedMap() is page and items[QgsLayoutItemLegend][0].linkedMap() is page
    words = [label.currentText() for label in items[QgsLayoutItemLabel]]
    assert "Bowl" in words and any("Talus" in w and "run" in w for w in words), words
    entries = [n.name() for n in items[QgsLayoutItemLegend][0].model().rootGroup().findLayers()]
    assert "Deposit thickness, vertical [m]" in entries, entries
    assert not any(name.startswith("Thickness at") for name in entries), entries
    path = place.work / "layout.png"
    settings = QgsLayoutExporter.ImageExportSettings()
    settings.dpi = 150
    assert QgsLayoutExporter(layout).exportToImage(str(path), settings) == QgsLayoutExporter.Success
    image = QImage(str(path))
    size = (image.width(), image.height())
    assert abs(size[0] - 1754) < 2 and abs(size[1] - 1240) < 2, f"A4 across at 150 dpi has {size} pixels"
    inside(items, layout)
    colours = {image.pixel(x, y) for y in range(0, image.height(), 5) for x in range(0, image.width(), 5)}
    assert len(colours) > 100, f"the page has {len(colours)} colours"


def check_project_of_an_ensemble_opens_whole(place):
    recipe = place.scene / "ensemble.toml"
    recipe.write_text((place.scene / "recipe.toml").read_text() + """
[ensemble]
members = 8

[[ensemble.vary]]
key = "solve.base.friction_angle_deg"
low = 14.0
high = 30.0
""")
    out = place.work / "ensemble"
    subprocess.run([place.bin / "talus", "run", recipe, "--on", "cpu", "--out", out], check=True, capture_output=True)
    project = opened(out / "probability" / "bowl-ensemble.qgs")
    layers = project.mapLayers().values()
    assert len(layers) > 30, f"{len(layers)} layers"
    shown = [node.layer() for node in project.layerTreeRoot().findLayers() if node.isVisible()]
    chosen = [layer for layer in shown if layer.name().startswith("Probability of peak thickness")]
    assert len(chosen) == 1, [layer.name() for layer in shown]
    seen, covered = drawn(shown, chosen[0].extent()), drawn(chosen, chosen[0].extent())
    assert 10 < covered < seen, f"the probability covers {covered} and all that is shown {seen} of 10,000 pixels"


def check_hostile_names_are_text(place):
    """The scene of tests/pipeline/payload_test.sh: its project and its layers' expressions run nothing."""
    folder = place.work / "hostile"
    folder.mkdir()
    build = place.bin.parent
    script = 'source "$0" && hostile_scene'
    subprocess.run(["bash", "-c", script, place.tests / "pipeline" / "hostile_scene.sh"], cwd=folder, check=True,
                   capture_output=True, env=os.environ | {"TALUS_SOURCE": str(place.tests.parent),
                                                          "TALUS_BUILD": str(build), "TALUS_SCRATCH": str(folder)})
    maps = folder / "<b>&'maps"  # GDAL names no layer of a NetCDF file below a folder with a double quote
    shutil.copytree(folder / "in <b>&'\"x" / "out" / "maps", maps)
    project = opened(maps / "..-hostile.qgs")
    assert "<script>window.pwned=1</script>" in project.title(), project.title()
    layers = list(project.mapLayers().values())
    names = [layer.name() for layer in layers]
    assert any(name.startswith("Survey: <img src=x onerror=") for name in names), names
    extent = next(layer.extent() for layer in layers if layer.name().startswith("Deposit thickness"))
    assert drawn([node.layer() for node in project.layerTreeRoot().findLayers() if node.isVisible()], extent) > 10
    words = [item.currentText() for item in project.layoutManager().printLayouts()[0].items()
             if isinstance(item, QgsLayoutItemLabel)]
    assert any("[ % 7*7 %]" in text for text in words), f"QGIS computes what stands in [% %]: {words}"
    assert not list(place.work.rglob("pwned")), "a shell ran"


def inside(items, layout):
    """Nothing reaches over the edge of the paper, and the legend does not lie on the scale bar."""
    from qgis.PyQt.QtCore import QRectF

    paper = QRectF(0, 0, 297, 210)
    boxes = {}
    for found in items.values():
        for item in found:
            box = item.mapRectToScene(item.rect())
            assert paper.contains(box), f"{item.id()} lies at {box}"
            boxes[item.id()] = box
    assert not boxes["Legend"].intersects(boxes["Scale bar"]), boxes
    assert not boxes["Legend"].intersects(boxes["Map"]), boxes


in_qgis_checks = [
    check_runs_with_progress_and_loads,
    check_cancel_leaves_a_checkpoint,
    check_says_what_is_wrong,
    check_loads_results_into_a_project,
    check_compares_two_runs,
    check_project_has_a_time,
    check_project_has_a_print_layout,
    check_project_of_an_ensemble_opens_whole,
    check_hostile_names_are_text,
]
