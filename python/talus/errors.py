# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What goes wrong, and what is warned of."""
import logging
import warnings


class TalusError(Exception):
    """Something is wrong with a file, a key or a value; the message says what and how to mend it."""


class RecipeError(TalusError):
    """The recipe is wrong."""


class DataError(TalusError):
    """A file or an array is wrong."""


class NumericalError(TalusError):
    """The computation failed."""


class ProgramError(TalusError):
    """A program of Talus ended with an error. The message is what it said."""

    def __init__(self, command, code, said):
        """`command`: the words of the command; `code`: its exit code; `said`: all that it wrote for people."""
        self.command = [str(word) for word in command]
        self.code = code  # 1 a bug, 2 recipe or command line, 3 a file, 4 the computation, 130 ended by a signal
        self.said = said
        super().__init__(_errors_in(said) or f"{self.command[0]} ended with exit code {code} and said nothing")


class TalusWarning(UserWarning):
    """What a program warned of."""


def log(level, text):
    """Takes a line of a log of talus._core; `level`: that of talus::LogLevel."""
    if level == 4:
        warnings.warn(text, TalusWarning, stacklevel=3)
    else:
        logging.getLogger("talus").log(logging.DEBUG if level == 0 else logging.INFO, text)


def _errors_in(said):
    """The lines of errors, which begin with the program's name, and what is indented below them."""
    lines, inside = [], False
    for line in said.splitlines():
        inside = line.startswith("talus") or (inside and line.startswith(" "))
        if inside:
            lines.append(line)
    return "\n".join(lines or said.splitlines()[-20:])
