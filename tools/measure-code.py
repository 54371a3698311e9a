#!/usr/bin/env python3
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sizes, docstrings, formatting, cycles and compile times of the code.

    tools/measure-code.py [--source DIR] [--build DIR]

Definitions and their lengths come from Universal Ctags, formatting from clang-format, compile times from the log of
Ninja in the build folder. What is counted as what stands beside each row's function.
"""
import argparse
import collections
import json
import pathlib
import re
import shutil
import statistics
import subprocess

FOLDERS = ("common", "preprocess", "solver", "postprocess", "data_samples")
SUFFIXES = (".cpp", ".hpp", ".cu")


def tracked(root):
    names = subprocess.run(["git", "-C", str(root), "ls-files"], capture_output=True, text=True, check=True).stdout
    return [root / name for name in names.splitlines() if (root / name).is_file()]


def percentile(values, share):
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))] if ordered else 0


def file_sizes(sources):
    lines = [sum(1 for _ in open(file)) for file in sources]
    return f"{statistics.median(lines):.0f} / {percentile(lines, 0.9)} / {max(lines)}"


def tags(sources):
    """One dictionary for each definition and declaration, from Universal Ctags; what it takes for one in a line that
    uses a macro of the project (TALUS_ELSEWHERE) or begins with `requires` is left out."""
    command = [
        "ctags",
        "--output-format=json",
        "--languages=C++",
        "--langmap=C++:+.cu.hpp.cpp",
        "--fields=+neaKS",
        "--kinds-C++=+p",
        "-f",
        "-",
        *map(str, sources),
    ]
    out = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    found = [json.loads(line) for line in out.splitlines() if line.startswith("{")]
    return [tag for tag in found if tag["kind"] == "macro" or not re.match(r"TALUS_|requires$", tag["name"])]


def function_lengths(found):
    """Lines from the name to the closing brace of every function that has a body."""
    lengths = [tag["end"] - tag["line"] + 1 for tag in found if tag["kind"] == "function" and "end" in tag]
    longest = max((t for t in found if t["kind"] == "function" and "end" in t), key=lambda t: t["end"] - t["line"])
    return (
        f"{percentile(lengths, 0.9)} / {percentile(lengths, 0.99)} / {max(lengths)}",
        f"{longest['name']} in {longest['path']}",
    )


def class_members(found):
    """Data members of the classes with private data; plain structs, which are tables of fields or options, left out."""
    count = collections.Counter()
    hidden = ("private", "protected")
    for tag in found:
        if tag["kind"] == "member" and tag.get("scopeKind") == "class" and tag.get("access") in hidden:
            count[tag["scope"].split("::")[-1]] += 1
    most = ", ".join(f"{name} {n}" for name, n in count.most_common(3))
    return f"{sum(n > 12 for n in count.values())} of {len(count)} over 12 ({most})"


def documented(found, root):
    """Share of the declarations in headers (classes, enumerations, functions; private ones, constructors, operators and
    what stands in a namespace `detail` left out) with a `///` comment above or behind them."""
    kinds = {"class", "struct", "enum", "function", "prototype"}
    with_comment, missing = 0, []
    texts = {}
    for tag in found:
        scope = tag.get("scope", "")
        name = tag["name"]
        if not tag["path"].endswith(".hpp") or tag["kind"] not in kinds:
            continue
        if tag.get("access") in ("private", "protected"):
            continue
        if "detail" in scope.split("::") or "__anon" in scope + name or name.startswith(("operator", "~")):
            continue
        if tag.get("scopeKind") in ("function",) or name == scope.split("::")[-1]:
            continue
        text = texts.setdefault(tag["path"], open(tag["path"]).read().splitlines())
        at = tag["line"] - 1
        above = at - 1
        while above >= 0 and re.match(r"\s*(template\b|requires\b|\[\[|TALUS_)", text[above]):
            above -= 1
        if (above >= 0 and text[above].lstrip().startswith("///")) or "///<" in text[at]:
            with_comment += 1
        else:
            missing.append(f"{pathlib.Path(tag['path']).relative_to(root)}:{tag['line']}: {name}")
    total = with_comment + len(missing)
    return with_comment / max(total, 1), missing


def long_lines(files):
    """Lines over 120 columns in sources, scripts and documents; tables of figures (.csv) and licences left out."""
    kinds = {".cpp", ".hpp", ".cu", ".md", ".sh", ".py", ".cmake", ".txt", ".js", ".css", ".html", ".json", ".toml"}
    count = collections.Counter()
    for file in files:
        if file.suffix in kinds or file.name == "Makefile":
            count[file] = sum(len(line.rstrip("\n")) > 120 for line in open(file, errors="replace"))
    return sum(count.values()), [(n, f) for f, n in count.most_common(12) if n]


def unformatted(sources):
    if not shutil.which("clang-format"):
        return "clang-format is missing"
    wrong = sum(
        subprocess.run(["clang-format", "--dry-run", "-Werror", str(f)], capture_output=True).returncode != 0
        for f in sources
    )
    return f"{wrong} of {len(sources)} files"


def floors(root):
    """The folders that are floors of their own, from the table in tests/structure/floors_test.sh."""
    text = (root / "tests/structure/floors_test.sh").read_text()
    table = re.search(r"^floors\(\) \{.*?^\}", text, re.MULTILINE | re.DOTALL).group(0)
    names = set()
    for stage in ("common", "preprocess", "solver", "postprocess"):
        out = subprocess.run(["bash", "-c", table + f"\nfloors {stage}"], capture_output=True, text=True, check=True)
        names |= {stage if name == "." else f"{stage}/{name}" for name in out.stdout.split()}
    return names


def cycles(root, sources):
    """Knots among the floors of the stages and of common/: sets that include one another round about. A folder that
    the table of floors does not name belongs to the one above it, as the table has it: laws to the list of laws."""
    names = floors(root)
    arrows = collections.defaultdict(set)

    def floor(folder):
        return next((f for f in [folder, *folder.parents] if f.as_posix() in names), folder).as_posix()

    for file in sources:
        here = floor(file.relative_to(root).parent)
        for line in open(file):
            found = re.match(r'\s*#\s*include "([^"]+)/[^/"]+"', line)
            if not found or not (root / found.group(1)).is_dir():
                continue
            there = floor(pathlib.PurePosixPath(found.group(1)))
            if there != here:
                arrows[here].add(there)
    reach = {}

    def reached(folder):
        seen, stack = set(), [folder]
        while stack:
            for other in arrows[stack.pop()]:
                if other not in seen:
                    seen.add(other)
                    stack.append(other)
        return seen

    for folder in list(arrows):
        reach[folder] = reached(folder)
    knots = {frozenset(o for o in reach[f] if f in reach.get(o, ())) for f in reach if f in reach[f]}
    return [sorted(knot) for knot in knots], sum(len(to) for to in arrows.values())


def slowest_unit(build):
    """The longest compilation in Ninja's log [s]. Meaningful when little else ran on the machine."""
    log = build / ".ninja_log"
    if not log.is_file():
        return "no build"
    times = {}
    for line in open(log):
        part = line.rstrip("\n").split("\t")
        if len(part) >= 4 and part[3].endswith(".o"):
            times[part[3]] = (int(part[1]) - int(part[0])) / 1000
    name = max(times, key=times.get)
    return f"{times[name]:.0f} s of {sum(times.values()):.0f} s: {pathlib.Path(name).name}"


def equations(root):
    """Numbered equations of docs/explanation/theory.md, and those that a source names where it computes them."""
    number = re.compile(r"\((T\d+[a-z]?)\)")
    stated = set()
    for line in open(root / "docs/explanation/theory.md"):
        found = re.search(r"\((T\d+[a-z]?)\)[.,;]?\s*$", line)
        if found:
            stated.add(found.group(1))
    named = set()
    for folder in FOLDERS:
        for file in (root / folder).rglob("*"):
            if file.suffix in SUFFIXES:
                text = open(file).read()
                named |= set(number.findall(text)) | set(re.findall(r"\bT\d+[a-z]?\b", text))
    return f"{len(stated & named)} of {len(stated)}", sorted(stated - named)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--source", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent)
    parser.add_argument("--build", type=pathlib.Path, help="build folder with the compile times (default: build)")
    parser.add_argument("--missing", action="store_true", help="list what has no docstring, and equations not named")
    given = parser.parse_args()
    root = given.source.resolve()
    files = tracked(root)
    sources = [f for f in files if f.suffix in SUFFIXES and f.relative_to(root).parts[0] in FOLDERS]
    everything = [f for f in files if f.suffix in SUFFIXES]
    found = tags(sources)
    lengths, longest = function_lengths(found)
    share, missing = documented(found, root)
    long, where = long_lines(files)
    knots, arrows = cycles(root, sources)
    named, unnamed = equations(root)
    rows = [
        ("file median / p90 / max lines", file_sizes(sources)),
        ("function p90 / p99 / max lines", lengths),
        ("longest function", longest),
        ("classes by data members", class_members(found)),
        ("public declarations with a docstring", f"{share:.2f}"),
        ("lines over 120 columns", str(long)),
        ("clang-format differs in", unformatted(everything)),
        ("include cycles among floors", f"{len(knots)}" + "".join(f"; {', '.join(k)}" for k in knots)),
        ("arrows among floors", str(arrows)),
        ("slowest unit of the build", slowest_unit(given.build or root / "build")),
        ("equations named where computed", named),
    ]
    print("| what | figure |\n| --- | --- |")
    for what, figure in rows:
        print(f"| {what} | {figure} |")
    if given.missing:
        print("\n".join(["", "without a docstring:", *missing, "", "equations not named:", *unnamed]))
        print("\nlong lines:")
        print("\n".join(f"{n} {f.relative_to(root)}" for n, f in where))
    return 0


if __name__ == "__main__":
    main()
