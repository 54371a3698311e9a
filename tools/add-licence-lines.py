#!/usr/bin/env python3
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Puts the two SPDX lines (copyright, licence) at the top of every source, behind a #! line where there is one.

usage: tools/add-licence-lines.py [--check]

--check changes nothing and names the sources that lack them (exit code 1). Sources are what git tracks: C++, CUDA, C,
JavaScript, Python, shell, CMake and make. The report's HTML and CSS go into every report, and recipes and documents are
what people copy from: those are under LICENSE without lines of their own.
"""
import pathlib
import subprocess
import sys

LINES = ("SPDX-FileCopyrightText: The Talus authors", "SPDX-License-Identifier: GPL-3.0-or-later")
COMMENTS = {".cpp": "//", ".hpp": "//", ".cu": "//", ".c": "//", ".js": "//", ".py": "#", ".sh": "#", ".cmake": "#",
            ".mk": "#"}
NAMES = {"CMakeLists.txt": "#", "Makefile": "#", "Dockerfile": "#"}


def comment_of(path, text):
    """How a line of comment begins in this file; None where it is no source."""
    if path.name in NAMES or path.suffix in COMMENTS:
        return NAMES.get(path.name) or COMMENTS[path.suffix]
    return "#" if text.startswith(("#!/usr/bin/env bash", "#!/bin/bash")) else None


def with_lines(text, comment):
    first, rest = "", text
    if text.startswith("#!"):
        first, _, rest = text.partition("\n")
        first += "\n"
    return first + "".join(f"{comment} {line}\n" for line in LINES) + rest


def main():
    check = sys.argv[1:] == ["--check"]
    if sys.argv[1:] and not check:
        sys.exit("usage: tools/add-licence-lines.py [--check]")
    tracked = subprocess.run(["git", "ls-files", "-z"], capture_output=True, text=True, check=True).stdout
    lacking, sources = [], 0
    for name in filter(None, tracked.split("\0")):
        path = pathlib.Path(name)
        if path.is_symlink() or not path.is_file():
            continue
        try:
            text = path.read_text(encoding="utf-8")
        except UnicodeDecodeError:
            continue   # rasters and other data
        comment = comment_of(path, text)
        if comment is None:
            continue
        sources += 1
        head = text.split("\n", 4)[:4]
        if all(f"{comment} {line}" in head for line in LINES):
            continue
        lacking.append(name)
        if not check:
            path.write_text(with_lines(text, comment), encoding="utf-8")
    if check and lacking:
        print("\n".join(lacking))
        sys.exit(f"{len(lacking)} of {sources} sources lack their licence lines. Add them: tools/add-licence-lines.py")
    print(f"{sources} sources" + ("" if check else f", {len(lacking)} of them changed"))


if __name__ == "__main__":
    main()
