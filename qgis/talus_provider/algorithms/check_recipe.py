# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""QGIS: every fault of a recipe, without running it."""
from qgis.core import QgsProcessingException, QgsProcessingOutputString, QgsProcessingParameterFile

from .base import TalusAlgorithm, folder_of_results


class CheckRecipe(TalusAlgorithm):
    ID, TITLE, GROUP = "checkrecipe", "Check a recipe", "Prepare"
    HELP = (
        "Lists every fault of all stages at once, as <i>talus check</i> does, and what talus-solve would advise. "
        "Nothing is written."
    )

    def initAlgorithm(self, config=None):  # noqa: N802
        self.addParameter(QgsProcessingParameterFile("RECIPE", "Recipe", extension="toml"))
        self.addParameter(
            QgsProcessingParameterFile("OUT", "Folder of results", behavior=QgsProcessingParameterFile.Folder,
                                       optional=True)
        )
        self.addOutput(QgsProcessingOutputString("WORDS", "What the check says"))

    def processAlgorithm(self, parameters, context, feedback):  # noqa: N802
        recipe = self.parameterAsFile(parameters, "RECIPE", context)
        out = folder_of_results(recipe, self.parameterAsString(parameters, "OUT", context))
        outcome = self.talus(["check", recipe, "--out", out], feedback)
        if outcome.cancelled:
            raise QgsProcessingException("Cancelled: the recipe was not checked to its end.")
        return {"WORDS": "\n".join(outcome.lines)}
