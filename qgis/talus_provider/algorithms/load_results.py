# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""QGIS: the results of a run as layers."""
from qgis.core import (
    QgsProcessingAlgorithm,
    QgsProcessingException,
    QgsProcessingOutputNumber,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterFile,
    QgsProcessingParameterNumber,
)

from ..layers import load_results
from ..results import Results
from .base import TalusAlgorithm


class LoadResults(TalusAlgorithm):
    ID, TITLE, GROUP = "loadresults", "Load results", "Results"
    HELP = (
        "Adds a group with the maps of a run in their styles, the outlines and a hillshade.<br><br>"
        "<b>Flow over time</b>: the thickness of every frame as layers that the Temporal Controller shows one after "
        "the other. <b>Points over time</b>: a sample of the material points of every frame, coloured by speed. Both "
        "need a run with frames (<i>frame_interval_s</i>)."
    )

    def initAlgorithm(self, config=None):  # noqa: N802
        add = self.addParameter
        add(QgsProcessingParameterFile("FOLDER", "Folder of results", behavior=QgsProcessingParameterFile.Folder))
        add(QgsProcessingParameterBoolean("FLOW", "Flow over time", defaultValue=True))
        add(QgsProcessingParameterBoolean("POINTS", "Points over time", defaultValue=False))
        number = QgsProcessingParameterNumber("COUNT", "Points at most, all frames together", minValue=100,
                                              maxValue=5000000, defaultValue=200000)
        number.setFlags(number.flags() | QgsProcessingParameterDefinition.FlagAdvanced)
        add(number)
        self.addOutput(QgsProcessingOutputNumber("LAYERS", "Number of layers added"))

    def flags(self):
        return super().flags() | QgsProcessingAlgorithm.FlagNoThreading  # it changes the project

    def processAlgorithm(self, parameters, context, feedback):  # noqa: N802
        if context.project() is None:
            raise QgsProcessingException("There is no project to load into (qgis_process: name one by --project_path).")
        try:
            results = Results(self.parameterAsFile(parameters, "FOLDER", context))
        except FileNotFoundError as error:
            raise QgsProcessingException(str(error)) from error
        points = self.parameterAsInt(parameters, "COUNT", context)
        count = load_results(
            context.project(),
            results,
            feedback,
            flow=self.parameterAsBoolean(parameters, "FLOW", context),
            points=points if self.parameterAsBoolean(parameters, "POINTS", context) else 0,
        )
        return {"LAYERS": count}
