# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""QGIS: the Processing provider, with the place of the talus command as its setting."""
import os

from processing.core.ProcessingConfig import ProcessingConfig, Setting
from qgis.core import QgsProcessingProvider
from qgis.PyQt.QtGui import QIcon

from .algorithms.check_recipe import CheckRecipe
from .algorithms.compare_runs import CompareRuns
from .algorithms.load_results import LoadResults
from .algorithms.new_recipe import NewRecipe
from .algorithms.run_recipe import RunRecipe
from .locate import find_talus

PROGRAM = "TALUS_PROGRAM"


class TalusProvider(QgsProcessingProvider):
    """Algorithms `talus:...`."""

    def id(self):
        return "talus"

    def name(self):
        return "Talus"

    def longName(self):  # noqa: N802
        return "Talus: landslide run-out"

    def icon(self):
        return QIcon(os.path.join(os.path.dirname(__file__), "icon.svg"))

    def load(self):
        ProcessingConfig.settingIcons["Talus"] = self.icon()
        ProcessingConfig.addSetting(
            Setting("Talus", PROGRAM, "The talus command (empty: it is looked for on the path)", "",
                    valuetype=Setting.FILE)
        )
        ProcessingConfig.readSettings()
        self.refreshAlgorithms()
        return True

    def unload(self):
        ProcessingConfig.removeSetting(PROGRAM)

    def loadAlgorithms(self):  # noqa: N802
        for algorithm in [RunRecipe, CheckRecipe, NewRecipe, LoadResults, CompareRuns]:
            self.addAlgorithm(algorithm())


def talus_program():
    """The command as the settings name it, or as it is found. Raises FileNotFoundError."""
    return find_talus(ProcessingConfig.getSetting(PROGRAM) or "")
