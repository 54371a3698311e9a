#!/usr/bin/env python3
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the solver's tests on the GPU of this machine and writes which of its cases that used it have passed.

usage: tools/record-gpu-tests.py PROGRAM [--commit C] [--jobs N] [--out docs/benchmarks/gpu-tests.csv]

PROGRAM is talus-tests-solver. N processes share its cases. A case says that it uses a GPU (need_gpu() of
tests/solver/scenes.hpp). The exit status is 1 where a case has failed, on the GPU or beside it. Without --commit the
commit is that of the working tree, whose sources have to be committed.
"""
import argparse
import csv
import datetime
import json
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
COLUMNS = ["test", "result", "machine", "commit", "date"]


def said(*words):
    """The first line that a program prints."""
    return subprocess.run(words, cwd=ROOT, check=True, capture_output=True, text=True).stdout.partition("\n")[0].strip()


def committed():
    """The commit of the working tree."""
    if said("git", "status", "--porcelain", "--", "solver", "common", "tests/solver"):
        sys.exit("tools/record-gpu-tests.py: sources have changed since the last commit. Commit them first")
    return said("git", "rev-parse", "--short=8", "HEAD")


def cases_of(program, jobs, scratch):
    """(name, result) of all cases, as GoogleTest reports them. Ends here where a process has not come to its last."""
    running = []
    for shard in range(jobs):
        report = pathlib.Path(scratch) / f"{shard}.json"
        environment = os.environ | {"TALUS_REQUIRE_GPU": "1", "GTEST_TOTAL_SHARDS": str(jobs),
                                    "GTEST_SHARD_INDEX": str(shard), "GTEST_OUTPUT": f"json:{report}"}
        log = open(report.with_suffix(".log"), "w", encoding="utf-8")
        running.append((subprocess.Popen([program], env=environment, stdout=log, stderr=log), report))
    for process, report in running:
        process.wait()
        if not report.exists():
            sys.exit(f"tools/record-gpu-tests.py: {program} ended with {process.returncode} before its last case:\n" +
                     report.with_suffix(".log").read_text(encoding="utf-8")[-2000:])
        for suite in json.loads(report.read_text(encoding="utf-8"))["testsuites"]:
            for case in suite["testsuite"]:
                yield f"{suite['name']}.{case['name']}", case


def result_of(case):
    return "failed" if case.get("failures") else "passed" if case["result"] == "COMPLETED" else "skipped"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--commit")
    parser.add_argument("--jobs", type=int, default=max(1, (os.cpu_count() or 1) // 2))
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "docs/benchmarks/gpu-tests.csv")
    arguments = parser.parse_args()
    shared = {"commit": arguments.commit or committed(), "date": f"{datetime.date.today()}",
              "machine": said("nvidia-smi", "--query-gpu=name", "--format=csv,noheader")}
    with tempfile.TemporaryDirectory() as scratch:
        cases = sorted(cases_of(arguments.program, arguments.jobs, scratch))
        failed = [f"{name}: {case['failures'][0]['failure']}" for name, case in cases if result_of(case) == "failed"]
    rows = [{"test": name, "result": result_of(case)} | shared for name, case in cases if case.get("on") == "gpu"]
    if not rows:
        sys.exit("tools/record-gpu-tests.py: no case has used a GPU")
    with arguments.out.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    print("\n".join(failed), end="\n" if failed else "")
    print(f"{len(cases)} cases, {len(rows)} of them on one {shared['machine']}, {len(failed)} failed")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
