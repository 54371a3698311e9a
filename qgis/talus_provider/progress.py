# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How far a run is, from what the programs say on stderr."""
import re

# What a stage takes of the whole, in percent: from, to. The solver takes nearly all the time of a run.
SHARES = {"preprocess": (0.0, 5.0), "solve": (5.0, 92.0), "postprocess": (92.0, 100.0)}

_STAGE = re.compile(r"^(preprocess|solve|postprocess): ")
_TIME = re.compile(r"^\d+ %  eta .*?  t (\d[\d.e+-]*)/(\d[\d.e+-]*) s\b")
_COUNT = re.compile(r"(\d+)/(\d+)")


class Progress:
    """Reads line by line; `percent` (0 to 100) never falls."""

    def __init__(self):
        self.percent = 0.0
        self.stage = None

    def read(self, line):
        """Take a line of stderr. Returns True for one that tells how far the run is and nothing else."""
        stage = _STAGE.match(line)
        if stage:
            self.stage = stage.group(1)
            self._reach(SHARES[self.stage][1 if "is up to date" in line else 0])
            return False
        time = _TIME.match(line)
        if time:
            now, end = float(time.group(1)), float(time.group(2))
            low, high = SHARES["solve"]
            if end > 0:
                self._reach(low + (high - low) * min(now / end, 1.0))
            return True
        return self._counted(line)

    def _counted(self, line):
        """"survey 12/200 drawn within its error" and the like, while the results are made."""
        found = _COUNT.search(line) if self.stage == "postprocess" else None
        if not found or int(found.group(2)) == 0 or not line.startswith("survey "):
            return False
        low, high = SHARES["postprocess"]
        self._reach(low + (high - low) * min(int(found.group(1)) / int(found.group(2)), 1.0))
        return True

    def _reach(self, percent):
        self.percent = max(self.percent, percent)
