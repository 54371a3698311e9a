# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""QGIS: two runs beside one another, on a page."""
import os

from qgis.core import QgsProcessingException, QgsProcessingOutputHtml, QgsProcessingParameterFile

from .base import TalusAlgorithm


class CompareRuns(TalusAlgorithm):
    ID, TITLE, GROUP = "compareruns", "Compare two runs", "Results"
    HELP = (
        "Writes <i>comparison.html</i> into the first folder, as <i>talus compare</i> does: the difference of the "
        "deposits as a map, the numbers of both side by side, and the keys in which their recipes differ."
    )

    def initAlgorithm(self, config=None):  # noqa: N802
        for name, words in [("FIRST", "Folder of results of a run"), ("SECOND", "Folder of another")]:
            self.addParameter(QgsProcessingParameterFile(name, words, behavior=QgsProcessingParameterFile.Folder))
        self.addOutput(QgsProcessingOutputHtml("PAGE", "Comparison"))

    def processAlgorithm(self, parameters, context, feedback):  # noqa: N802
        first, second = (self.parameterAsFile(parameters, name, context) for name in ("FIRST", "SECOND"))
        if self.talus(["compare", first, second], feedback).cancelled:
            raise QgsProcessingException("Cancelled: the runs were not compared.")
        return {"PAGE": os.path.join(os.path.abspath(first), "comparison.html")}
