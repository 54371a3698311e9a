# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the talus command."""
import os
import shutil

USUAL = ["/usr/bin/talus", "/usr/local/bin/talus", os.path.expanduser("~/.local/bin/talus")]


def find_talus(given=""):
    """The path of the program: `given` in the settings, else the environment variable TALUS, else on the path, else in
    the usual folders. Raises FileNotFoundError with words on what to do."""
    for origin, path in [("in the settings of Processing", given), ("by TALUS", os.environ.get("TALUS", ""))]:
        if not path:
            continue
        if os.path.isdir(path):
            path = os.path.join(path, "talus")
        if os.access(path, os.X_OK) and os.path.isfile(path):
            return path
        raise FileNotFoundError(f"{path}: no such program (it is named {origin}). Name the talus command there")
    found = shutil.which("talus") or next((path for path in USUAL if os.access(path, os.X_OK)), None)
    if found:
        return found
    raise FileNotFoundError(
        "The talus command was not found on the path nor in /usr/bin or /usr/local/bin. Install Talus, or name the "
        "program under Settings > Options > Processing > Providers > Talus"
    )
