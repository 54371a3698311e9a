#!/usr/bin/env python3
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a tutorial as it is written, and holds what it prints to what the page says.

usage: tools/run-tutorial.py PAGE.md --bin DIR --work DIR [--pictures DIR [--compare DIR]]

PAGE.md   in its order: a block ```toml, ```json or ```python whose first line is "# file: NAME" (in JSON the line above
          the block says it: "`NAME`:") is written to that file; of a block ```console every line "$ COMMAND" is run in
          one shell, and the lines below it have to come out, in that order; others may come between them
--work    an empty folder; it gets the samples and scenes of the project, and build/bin
--pictures  pictures that the page shows are made anew there: "<!-- picture: FILE -->" above a picture names the file
          of the run that it is, a PNG, or a page that Chromium draws
--compare  the pictures have to look like those of the same names there: the colours of squares, 200 across, may
          differ by 0.6 % in the mean, those of a web page by 2 % (it names its day)
Numbers may differ by 3 %, or by one in their last digit: machines sum in other orders. Words may not.
Exit code 1: a command failed, or printed something else; both are shown. Needs no network.
"""
import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
BLOCK = re.compile(r"(?:^`(?P<name>[\w./-]+)`:\n\n)?^```(?P<kind>\w+)\n(?P<body>.*?)^```$", re.M | re.S)
NUMBER = re.compile(r"[-+]?\d[\d,]*(?:\.\d+)?(?:e[-+]?\d+)?")
PICTURE = re.compile(r"<!-- picture: (\S+)(?: (\d+)x(\d+))? -->\n+!\[[^\]]*\]\(([^)\s]+)\)")
TOLERANCE = 0.03
MARK = "----talus-tutorial-mark----"


def steps_of(text):
    """What the page asks for, in order: ("file", name, content) and ("command", line, expected lines)."""
    steps = []
    for block in BLOCK.finditer(text):
        body = block["body"]
        first = re.match(r"(?:#|//) file: (\S+)\n", body)
        if block["kind"] == "console":
            for part in re.split(r"^\$ ", body, flags=re.M)[1:]:
                lines = part.splitlines()
                command = [lines.pop(0)]
                while command[-1].endswith("\\"):
                    command.append(lines.pop(0).removeprefix("> "))
                expected = [line for line in lines if line.strip() not in ("", "...")]
                steps.append(("command", "\n".join(command), expected))
        elif first or block["name"]:
            steps.append(("file", first.group(1) if first else block["name"], body[first.end():] if first else body))
    return steps


def joined(line):
    """Thousands without the space between them, words with one."""
    return " ".join(re.sub(r"(?<=\d) (?=\d{3}(?:\D|$))", "", line).split())


def value(word):
    return float(word.replace(",", ""))


def alike(expected, actual):
    """The words are the same, and each number is within the tolerance or one in its last digit."""
    expected, actual = joined(expected), joined(actual)
    if NUMBER.sub("#", expected) != NUMBER.sub("#", actual):
        return False
    for said, found in zip(NUMBER.findall(expected), NUMBER.findall(actual)):
        digits = len(said.partition("e")[0].partition(".")[2])
        room = max(TOLERANCE * abs(value(said)), 10.0 ** -digits)
        if abs(value(said) - value(found)) > room * 1.0001:
            return False
    return True


def missing_lines(expected, printed):
    """The expected lines that do not come, in their order."""
    place, missing = 0, []
    for line in expected:
        found = next((i for i in range(place, len(printed)) if alike(line, printed[i])), None)
        if found is None:
            missing.append(line)
        else:
            place = found + 1
    return missing


class Shell:
    """One bash that keeps its folder and variables between commands."""

    def __init__(self, folder, environment):
        self.process = subprocess.Popen(["bash", "--norc"], cwd=folder, env=environment, text=True, bufsize=1,
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def run(self, command):
        self.process.stdin.write(f"{command}\ntalus_code=$?; echo; echo {MARK} $talus_code\n")
        self.process.stdin.flush()
        lines = []
        for line in self.process.stdout:
            if line.startswith(MARK):
                return int(line.split()[1]), lines
            lines.append(line.rstrip("\n"))
        return self.process.wait() or 1, lines

    def close(self):
        self.process.stdin.close()
        self.process.wait()


def make_folder(work, programs):
    """What a reader has who stands in the project's folder: samples, scenes, programs."""
    work.mkdir(parents=True, exist_ok=True)
    if any(work.iterdir()):
        sys.exit(f"tools/run-tutorial.py: {work} is not empty (a tutorial begins in a fresh folder). Name another one")
    for name in ("data_samples", "pipelines"):
        shutil.copytree(ROOT / name, work / name, ignore=shutil.ignore_patterns("out", "__pycache__", "*.cpp", "*.hpp"))
    (work / "build").mkdir()
    (work / "build/bin").symlink_to(programs)


def run_page(page, work, environment):
    """Number of commands; ends with exit code 1 at the first that fails or prints something else."""
    shell, count = Shell(work, environment), 0
    for kind, head, rest in steps_of(page.read_text(encoding="utf-8")):
        if kind == "file":
            (work / head).parent.mkdir(parents=True, exist_ok=True)
            (work / head).write_text(rest, encoding="utf-8")
            continue
        count += 1
        code, printed = shell.run(head)
        missing = missing_lines(rest, printed)
        if code != 0 or missing:
            shown = "\n".join(f"    {line}" for line in printed[-60:])
            why = f"ended with {code}" if code else "does not print:\n" + "\n".join(f"    {line}" for line in missing)
            shell.close()
            sys.exit(f"{page.name}: $ {head}\n{why}\nIt printed:\n{shown}\nChange the page to what is right now, or "
                     "mend what it shows")
    shell.close()
    return count


def draw_page(page, picture, size):
    """Chromium's picture of a page."""
    run = subprocess.run(["chromium", "--headless=new", "--disable-gpu", "--no-sandbox", "--hide-scrollbars",
                          "--virtual-time-budget=8000", f"--window-size={size[0]},{size[1]}",
                          f"--screenshot={picture}", page.resolve().as_uri()], capture_output=True, check=False)
    if run.returncode or not picture.exists():
        sys.exit(f"tools/run-tutorial.py: chromium made no picture of {page}: {run.stderr.decode()[-300:]}")


def make_pictures(page, work, folder):
    folder.mkdir(parents=True, exist_ok=True)
    names = []
    for found in PICTURE.finditer(page.read_text(encoding="utf-8")):
        source, picture = work / found.group(1), folder / pathlib.Path(found.group(4)).name
        if not source.exists():
            sys.exit(f"{page.name}: the picture {picture.name} is {found.group(1)}, which the run has not made")
        if source.suffix == ".html":
            draw_page(source, picture, (found.group(2) or 1200, found.group(3) or 900))
        else:
            shutil.copyfile(source, picture)
        names.append(picture.name)
    return names


def difference(first, second):
    """Mean difference of two pictures' colours, of squares 200 across the first: 0 the same, 1 black for white."""
    from PIL import Image, ImageChops, ImageStat  # pylint: disable=import-outside-toplevel
    with Image.open(first) as one, Image.open(second) as other:
        size = (200, round(one.height * 200 / one.width))
        small = [image.convert("RGB").resize(size, Image.BOX) for image in (one, other)]
    return sum(ImageStat.Stat(ImageChops.difference(*small)).mean) / 3 / 255


def compare_pictures(page, made, stored):
    """Ends where a stored picture is not what the run draws now."""
    for found in PICTURE.finditer(page.read_text(encoding="utf-8")):
        name = pathlib.Path(found.group(4)).name
        if not (stored / name).exists():
            sys.exit(f"{page.name}: {stored / name} is missing. Make it: make pictures PICTURES={name}")
        share, room = difference(stored / name, made / name), 0.02 if found.group(1).endswith(".html") else 0.006
        if share > room:
            sys.exit(f"{page.name}: {name} is stale: it differs from what the run draws now by {100 * share:.2g} % "
                     f"of its colours ({100 * room:g} % may be). Make it anew and look at it: make pictures "
                     f"PICTURES={name}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n\n")[0])
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("--bin", type=pathlib.Path, required=True)
    parser.add_argument("--work", type=pathlib.Path, required=True)
    parser.add_argument("--pictures", type=pathlib.Path)
    parser.add_argument("--compare", type=pathlib.Path)
    asked = parser.parse_args()
    work = asked.work.resolve()
    make_folder(work, asked.bin.resolve())
    path = f"{pathlib.Path(sys.executable).parent}:{os.environ['PATH']}"  # the Python of this program, first
    environment = os.environ | {"LC_ALL": "C.UTF-8", "GDAL_PAM_ENABLED": "NO", "PATH": path}
    count = run_page(asked.page, work, environment)
    if count == 0:
        sys.exit(f"{asked.page.name}: no command was found (a tutorial shows commands in blocks of ```console)")
    if asked.pictures:
        make_pictures(asked.page, work, asked.pictures)
        if asked.compare:
            compare_pictures(asked.page, asked.pictures, asked.compare)
    print(f"{asked.page.name}: {count} commands run as written")


if __name__ == "__main__":
    main()
