# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the talus command: its lines as they come, its results, and an end that leaves a checkpoint."""
import os
import selectors
import signal
import subprocess
import time

PATIENCE_S = 120.0  # after being asked to end, for what is being saved
LINES_EVERY_S = "1"  # how often the solver tells its progress

MEANINGS = {1: "a bug of Talus", 2: "the recipe or the settings are wrong", 3: "a file is wrong or cannot be written",
            4: "the computation failed", 130: "it was cancelled"}


class Outcome:
    """How a command ended: exit code, paths of its results (stdout), lines for people (stderr)."""

    def __init__(self, code, results, lines, cancelled):
        self.code, self.results, self.lines, self.cancelled = code, results, lines, cancelled

    def meaning(self):
        """The exit code in words; empty for 0."""
        if self.code == 0:
            return ""
        return MEANINGS.get(self.code, f"it ended with code {self.code}")

    def faults(self):
        """The lines that name what is wrong; the last ones where none does so by its form."""
        named = [line for line in self.lines if line.startswith(("talus", "preprocess", "solve", "postprocess"))]
        return "\n".join((named or self.lines)[-12:])


def _ask(process, what):
    """Send a signal to the command and the stage that it runs."""
    try:
        os.killpg(process.pid, what)
    except ProcessLookupError:
        pass


class _Lines:
    """Bytes of a stream, line by line."""

    def __init__(self):
        self.rest = b""

    def take(self, data):
        *whole, self.rest = (self.rest + data).split(b"\n")
        return [line.decode("utf-8", "replace").rstrip("\r") for line in whole]

    def end(self):
        last, self.rest = self.rest, b""
        return [last.decode("utf-8", "replace")] if last else []


class _Ending:
    """What is done once the user has cancelled: asked to end, then told to."""

    def __init__(self, process, patience):
        self.process, self.patience, self.since, self.told = process, patience, None, 0

    def begin(self):
        if self.since is None:
            self.since = time.monotonic()
            _ask(self.process, signal.SIGINT)

    def insist(self):
        if self.since is None:
            return
        waited = time.monotonic() - self.since
        orders = [(self.patience, signal.SIGTERM), (self.patience + 10, signal.SIGKILL)]
        for step, (after, what) in enumerate(orders, 1):
            if waited > after and self.told < step:
                self.told = step
                _ask(self.process, what)


def run(command, on_line=lambda line: None, is_cancelled=lambda: False, patience=PATIENCE_S):
    """Run a list of words. `on_line` gets each line of stderr. Once `is_cancelled()` is true the command and its stage
    get SIGINT, as from Ctrl-C, so that the solver saves a checkpoint. Returns an Outcome; raises OSError where the
    program cannot be started."""
    environment = dict(os.environ, TALUS_PROGRESS_S=LINES_EVERY_S)
    process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                               env=environment, start_new_session=True)
    texts = {process.stdout: _Lines(), process.stderr: _Lines()}
    results, lines, ending = [], [], _Ending(process, patience)

    def deliver(stream, found):
        for line in found:
            (results if stream is process.stdout else lines).append(line)
            if stream is process.stderr:
                on_line(line)

    with selectors.DefaultSelector() as selector:
        for stream in texts:
            selector.register(stream, selectors.EVENT_READ)
        while selector.get_map():
            for key, _ in selector.select(0.2):
                data = os.read(key.fd, 65536)
                deliver(key.fileobj, texts[key.fileobj].take(data) if data else texts[key.fileobj].end())
                if not data:
                    selector.unregister(key.fileobj)
                    key.fileobj.close()
            if is_cancelled():
                ending.begin()
            ending.insist()
    code = process.wait()
    return Outcome(code if code >= 0 else 128 - code, [path for path in results if path], lines,
                   ending.since is not None)
