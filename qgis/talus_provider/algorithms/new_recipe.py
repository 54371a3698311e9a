# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""QGIS: a first recipe from the elevation models before and after a slide."""
import os

from qgis.core import (
    QgsProcessingException,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterFileDestination,
    QgsProcessingParameterRasterLayer,
)

from .base import TalusAlgorithm


class NewRecipe(TalusAlgorithm):
    ID, TITLE, GROUP = "newrecipe", "New recipe from two elevation models", "Prepare"
    HELP = (
        "Finds the slide between two elevation models and writes a commented recipe for it, as <i>talus new</i> does: "
        "spacing, layers, friction at the bed and end time follow from the slide. It is a beginning to be edited."
    )

    def initAlgorithm(self, config=None):  # noqa: N802
        self.addParameter(QgsProcessingParameterRasterLayer("BEFORE", "Elevations before the slide"))
        self.addParameter(QgsProcessingParameterRasterLayer("AFTER", "Elevations after it"))
        self.addParameter(
            QgsProcessingParameterBoolean("OVERWRITE", "Write over a recipe that is there already", defaultValue=False)
        )
        self.addParameter(QgsProcessingParameterFileDestination("RECIPE", "Recipe", "Recipes (*.toml)"))

    def _file(self, parameters, name, context):
        """The file of a layer: Talus reads files, not what a server or the memory of QGIS holds."""
        layer = self.parameterAsRasterLayer(parameters, name, context)
        source = layer.source() if layer is not None else ""
        if not os.path.isfile(source):
            raise QgsProcessingException(
                f"{source or name}: not a raster in a file. Save the layer as a GeoTIFF and choose that."
            )
        return source

    def processAlgorithm(self, parameters, context, feedback):  # noqa: N802
        recipe = self.parameterAsFileOutput(parameters, "RECIPE", context)
        words = ["new", self._file(parameters, "BEFORE", context), self._file(parameters, "AFTER", context),
                 "--recipe", recipe]
        if self.parameterAsBoolean(parameters, "OVERWRITE", context):
            words.append("--overwrite")
        if self.talus(words, feedback).cancelled:
            raise QgsProcessingException("Cancelled: no recipe was written.")
        return {"RECIPE": recipe}
