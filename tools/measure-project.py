#!/usr/bin/env python3
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sizes of a source tree and costs of a run, as a table of two columns. Run it on two trees to compare them.

    tools/measure-project.py [--source DIR] [--bin DIR] [--repeats N]

--source  the tree (default: this one): lines of C++ and CUDA, words of Markdown
--bin     the programs of that tree: keys of the templates; and of a run of pipelines/synthetic-valley the wall time of
          the three stages, best of N, the processes that `talus run` starts, and how often a solver opens domain.vdb.
          Needs strace.
"""
import argparse
import os
import pathlib
import re
import subprocess
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
SOURCES = {".cpp", ".hpp", ".cu", ".cuh"}
STAGES = ("preprocess", "solve", "postprocess")


def tracked(source):
    """Paths of the files of a tree that git knows."""
    listed = subprocess.run(["git", "-C", str(source), "ls-files", "-z"], capture_output=True, text=True, check=True)
    return [source / name for name in listed.stdout.split("\0") if name and (source / name).is_file()]


def lines_of(files):
    return sum(len(file.read_bytes().splitlines()) for file in files)


def sizes(source):
    """(row, number) of a tree."""
    files = tracked(source)
    code = [file for file in files if file.suffix in SOURCES]
    tests = [file for file in code if "tests" in file.relative_to(source).parts]
    outside = [file for file in code if file not in set(tests)]
    pages = [file for file in files if file.suffix == ".md"]
    words = sum(len(file.read_text(errors="replace").split()) for file in pages)
    return [
        ("C++ and CUDA lines outside tests", lines_of(outside)),
        ("C++ and CUDA lines of tests", lines_of(tests)),
        ("words of Markdown", words),
    ]


def keys(binaries):
    """Keys of all templates, by table; [[solve.part]] repeats [solve.material] and counts its own keys alone."""
    found, table = set(), ""
    for stage in STAGES:
        text = subprocess.run([binaries / f"talus-{stage}", "--template"], capture_output=True, text=True, check=True)
        for line in text.stdout.splitlines():
            if head := re.match(r"#? ?\[\[?([a-z_.]+)\]\]?", line):
                table = head.group(1)
            elif key := re.match(r"(?:# )?([A-Za-z_0-9]+) = ", line):
                found.add((table, key.group(1)))
    return {(t, k) for t, k in found if t != "solve.part" or ("solve.material", k) not in found}


def traced(command, calls, log):
    """Runs a command and returns the lines of its system calls."""
    subprocess.run(["strace", "-f", "-qq", "-e", f"trace={calls}", "-o", str(log), *map(str, command)], check=True,
                   capture_output=True)
    return [line for line in log.read_text().splitlines() if "ENOENT" not in line and "resumed" not in line]


def run_costs(source, binaries, repeats):
    """(row, number) of a run of the demo."""
    recipe = source / "pipelines/synthetic-valley/recipe.toml"
    environment = {**os.environ, "TALUS_DATA": str(source.parent / "shared/data")}
    best = float("inf")
    with tempfile.TemporaryDirectory() as scratch:
        out = pathlib.Path(scratch) / "out"
        for _ in range(repeats):
            begun = time.perf_counter()
            for stage in STAGES:
                subprocess.run([binaries / f"talus-{stage}", recipe, "--out", out, "--on", "cpu", "-q"], check=True,
                               env=environment, capture_output=True)
            best = min(best, time.perf_counter() - begun)
        log = pathlib.Path(scratch) / "calls"
        solve = [binaries / "talus-solve", recipe, "--out", out, "--on", "cpu", "-q"]
        opened = [line for line in traced(solve, "open,openat", log) if "domain.vdb\"" in line]
        fresh = pathlib.Path(scratch) / "fresh"
        run = [binaries / "talus", "run", recipe, "--out", fresh, "--on", "cpu", "-q"]
        started = [line for line in traced(run, "execve", log) if "execve(" in line]
    return [
        ("wall time of the demo recipe, preprocess to report, best of "
         f"{repeats} on {len(os.sched_getaffinity(0))} threads [s]", f"{best:.2f}"),
        ("times that a run opens domain.vdb", len(opened)),
        ("processes of `talus run` of three stages", len(started)),
    ]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--source", type=pathlib.Path, default=ROOT)
    parser.add_argument("--bin", type=pathlib.Path)
    parser.add_argument("--repeats", type=int, default=3)
    given = parser.parse_args()
    rows = sizes(given.source.resolve())
    if given.bin:
        binaries = given.bin.resolve()
        rows.append(("recipe keys", len(keys(binaries))))
        rows += run_costs(given.source.resolve(), binaries, given.repeats)
    for row, number in rows:
        print(f"| {row} | {number} |")


if __name__ == "__main__":
    main()
