# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""QGIS: what the algorithms share: names, help, and the call of the talus command."""
import os

from qgis.core import QgsProcessingAlgorithm, QgsProcessingException
from qgis.PyQt.QtGui import QIcon

from .. import process
from ..progress import Progress


class TalusAlgorithm(QgsProcessingAlgorithm):
    """An algorithm named by its class: `ID`, `TITLE`, `GROUP`, `HELP`."""

    ID, TITLE, GROUP, HELP = "", "", "", ""

    def createInstance(self):  # noqa: N802
        return type(self)()

    def name(self):
        return self.ID

    def displayName(self):  # noqa: N802
        return self.TITLE

    def group(self):
        return self.GROUP

    def groupId(self):  # noqa: N802
        return self.GROUP.lower().replace(" ", "_")

    def shortHelpString(self):  # noqa: N802
        return self.HELP

    def icon(self):
        return QIcon(os.path.join(os.path.dirname(os.path.dirname(__file__)), "icon.svg"))

    def talus(self, words, feedback):
        """Run the talus command with `words`; its lines go to the log, its progress to the bar. Returns the Outcome of
        one that ended well or was cancelled; raises QgsProcessingException with what the command says is wrong."""
        from ..provider import talus_program

        try:
            command = [talus_program(), *words]
        except FileNotFoundError as error:
            raise QgsProcessingException(str(error)) from error
        feedback.pushCommandInfo(" ".join(command))
        progress = Progress()

        def on_line(line):
            if progress.read(line):
                feedback.setProgressText(line)
            elif line.startswith("warning"):
                feedback.pushWarning(line)
            else:
                feedback.pushInfo(line)
            feedback.setProgress(progress.percent)

        outcome = process.run(command, on_line, feedback.isCanceled)
        if outcome.code != 0 and not outcome.cancelled:
            raise QgsProcessingException(f"Talus: {outcome.meaning()}.\n{outcome.faults()}")
        return outcome


def folder_of_results(recipe, out):
    """Where results go: as given, else `out` beside the recipe, as the command has it."""
    return os.path.abspath(out) if out else os.path.join(os.path.dirname(os.path.abspath(recipe)), "out")
