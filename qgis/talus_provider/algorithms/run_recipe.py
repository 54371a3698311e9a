# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""QGIS: runs the stages of a recipe that are not up to date."""
import os

from qgis.core import (
    QgsProcessingOutputFile,
    QgsProcessingOutputFolder,
    QgsProcessingOutputHtml,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterEnum,
    QgsProcessingParameterFile,
    QgsProcessingParameterNumber,
    QgsProcessingParameterString,
)

from ..layers import load_results
from ..results import Results
from .base import TalusAlgorithm, folder_of_results

PLACES = ["auto", "cpu", "gpu", "gpus"]


class RunRecipe(TalusAlgorithm):
    ID, TITLE, GROUP = "runrecipe", "Run a recipe", "Run"
    HELP = (
        "Runs the stages of a recipe (preparing, solving, maps and report) whose results are not up to date, as "
        "<i>talus run</i> does. Cancelling ends the solver after its present step and leaves a checkpoint: running the "
        "same recipe again goes on from there.<br><br>"
        "<b>Folder of results</b>: where they go; empty: <i>out</i> beside the recipe.<br>"
        "<b>Other values</b>: a line for each, which takes the place of the recipe's: "
        "<i>solve.base.friction_angle_deg=18</i>"
    )

    def initAlgorithm(self, config=None):  # noqa: N802
        add = self.addParameter
        add(QgsProcessingParameterFile("RECIPE", "Recipe", extension="toml"))
        add(QgsProcessingParameterFile("OUT", "Folder of results", behavior=QgsProcessingParameterFile.Folder,
                                       optional=True))
        add(QgsProcessingParameterEnum("ON", "Solve on", PLACES, defaultValue=0))
        add(QgsProcessingParameterString("SET", "Other values (KEY=VALUE, a line for each)", multiLine=True,
                                         optional=True))
        add(QgsProcessingParameterBoolean("LOAD", "Load the results into the project", defaultValue=True))
        threads = QgsProcessingParameterNumber("THREADS", "Threads at most (0: as many as there are)", minValue=0,
                                               maxValue=4096, defaultValue=0)
        threads.setFlags(threads.flags() | QgsProcessingParameterDefinition.FlagAdvanced)
        add(threads)
        self.addOutput(QgsProcessingOutputFolder("FOLDER", "Folder of results"))
        self.addOutput(QgsProcessingOutputHtml("REPORT", "Report"))
        self.addOutput(QgsProcessingOutputFile("PROJECT", "Project of QGIS"))

    def processAlgorithm(self, parameters, context, feedback):  # noqa: N802
        recipe = self.parameterAsFile(parameters, "RECIPE", context)
        self.folder = folder_of_results(recipe, self.parameterAsString(parameters, "OUT", context))
        words = ["run", recipe, "--out", self.folder,
                 "--on", PLACES[self.parameterAsEnum(parameters, "ON", context)]]
        threads = self.parameterAsInt(parameters, "THREADS", context)
        if threads > 0:
            words += ["--threads", str(threads)]
        for line in self.parameterAsString(parameters, "SET", context).splitlines():
            if line.strip():
                words += ["--set", line.strip()]
        outcome = self.talus(words, feedback)
        self.wants_layers = self.parameterAsBoolean(parameters, "LOAD", context) and not outcome.cancelled
        found = {"FOLDER": self.folder}
        if outcome.cancelled:
            kept = os.path.isfile(os.path.join(self.folder, "checkpoint.h5"))
            feedback.pushWarning(
                "Cancelled. " + ("The solver's state was saved: run the recipe again to go on from there."
                                 if kept else "Nothing was saved.")
            )
            return found
        results = Results(self.folder)
        return {**found, "REPORT": results.report, "PROJECT": results.project()}

    def postProcessAlgorithm(self, context, feedback):  # noqa: N802
        if self.wants_layers and context.project() is not None:
            load_results(context.project(), Results(self.folder), feedback)
        return {}
