# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The QGIS plugin of Talus: a Processing provider over the talus command.

Modules without a leading word of QGIS in their docstring import nothing of it and are tested without it.
"""


def classFactory(iface):  # noqa: N802 (QGIS asks for this name)
    """Called by QGIS when the plugin is switched on. `iface` is None under qgis_process."""
    from .plugin import TalusPlugin

    return TalusPlugin(iface)
