#!/usr/bin/env python3
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Faults on purpose, in all three stages: the n-th call fails or kills, memory runs out, processes meet in one
folder, the power goes. After each: every file that carries a name is whole and of one recipe, what went wrong is said,
and the next run ends with the results of a run that nothing disturbed.

    tests/faults/faults.py --bin build/bin --shim build/bin/talus-faults.so --work DIR [--full] [--only TABLE]
      [--stage STAGE] [--scene SCENE] [--part K/N] [--table FILE]

Without --full a few places of each kind, in seconds; with it every rename and sync, and the tables that
docs/explanation/reliability.md shows. Needs gdalinfo, h5dump and an x86-64 Linux; exit code 77 where there is none
of it.
"""
import argparse
import errno
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from bowl import SCENES, STAGES, digests, fresh_copy, hidden, make_scene  # noqa: E402
from power_cut import faults_of  # noqa: E402

LONGEST = 600  # seconds that a stage may take on a busy machine; on an idle one it takes one
HANDLED = {0, 2, 3}  # 2: the recipe itself cannot be read
CRASHES = {-signal.SIGSEGV, -signal.SIGABRT, -signal.SIGBUS, -signal.SIGFPE, -signal.SIGILL, -signal.SIGSYS, 255}
KINDS = ("write", "fsync", "rename", "open", "read", "unlink", "mkdir", "lock")  # of calls, in the shim's order
ERRORS = {"EIO": errno.EIO, "ENOSPC": errno.ENOSPC, "EDQUOT": errno.EDQUOT}


class Bench:
    """Folders of the scene before each stage (with the results of an older recipe in them), and what is right."""

    def __init__(self, arguments):
        self.bin, self.shim, self.full, self.scene = arguments.bin, arguments.shim, arguments.full, arguments.scene
        self.stages = arguments.stage or STAGES  # what is disturbed; beside it, and before it, all of them run
        self.work, self.part = arguments.work, arguments.part
        self.rows, self.wrong = [], []
        shutil.rmtree(self.work, ignore_errors=True)
        self.place = self.work / "place"  # every trial runs here, so that no path differs
        make_scene(self.place, layer=4.0, end=0.5, scene=self.scene)
        for stage in STAGES:
            self.must(stage)
        make_scene(self.place, scene=self.scene)
        self.base, self.old, self.counts = {}, digests(self.place / "out"), {}
        for stage in STAGES:
            self.base[stage] = self.work / f"before-{stage}"
            fresh_copy(self.place, self.base[stage])
            self.counts[stage] = self.counted(stage)
        self.right = digests(self.place / "out")
        broken = [name for name, said in {**self.old, **self.right}.items() if said.startswith("BROKEN")]
        if broken:
            sys.exit(f"undisturbed, these are broken: {broken}")

    def command(self, stage):
        more = ["--on", "cpu", "--resume"] if stage == "solve" else []
        return [self.bin / f"talus-{stage}", self.place / "recipe.toml", "--out", self.place / "out", *more]

    def must(self, stage):
        done = subprocess.run(self.command(stage), capture_output=True, text=True, timeout=LONGEST)
        if done.returncode != 0:
            sys.exit(f"undisturbed, talus-{stage} ends with {done.returncode}: {done.stderr}")

    def start(self, stage, **wishes):
        """The stage with the shim; wishes as the shim's variables without FAULT_."""
        counter = self.work / "counter"
        counter.write_bytes(bytes(8 * (2 + len(KINDS))))
        environment = dict(os.environ, LD_PRELOAD=str(self.shim), FAULT_ROOT=str(self.place), FAULT_COUNT=str(counter),
                           **{f"FAULT_{key.upper()}": str(value) for key, value in wishes.items()})
        return subprocess.Popen(self.command(stage), env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, text=True)

    def run(self, stage, **wishes):
        """Exit code and stderr; "late" where it did not end in time."""
        process = self.start(stage, **wishes)
        try:
            _, said = process.communicate(timeout=LONGEST)
        except subprocess.TimeoutExpired:
            process.kill()
            return "late", process.communicate()[1]
        return process.returncode, said

    def counted(self, stage):
        """How many calls of each kind the stage makes, and allocations, where the shim watches it and does no more."""
        code, said = self.run(stage, ops=",".join(KINDS), at=0, alloc=10 ** 12)
        if code == 96:
            print("SKIPPED: this machine does not let a process watch its own system calls", file=sys.stderr)
            sys.exit(77)
        if code != 0:
            sys.exit(f"undisturbed under the shim, talus-{stage} ends with {code}: {said}")
        _, *numbers = memoryview((self.work / "counter").read_bytes()).cast("q")
        return dict(zip(("allocation", *KINDS), numbers))

    def count(self, stage, ops):
        return sum(self.counts[stage][op] for op in ops.split(","))

    def complain(self, trial, words):
        self.wrong.append(f"{trial}: {words}")
        print(f"WRONG {trial}: {words}", file=sys.stderr)

    def look(self, trial, killed):
        """Every file of a final name is the old one or the new one, whole; nothing is left that nobody will remove."""
        for name, said in digests(self.place / "out").items():
            if said not in (self.old.get(name), self.right.get(name)):
                self.complain(trial, f"{name} is neither the old file nor the new one ({said})")
        if not killed:
            left = [name for name in hidden(self.place / "out") if "/.frames/" not in f"/{name}"]
            if left:
                self.complain(trial, f"left behind: {left}")

    def again(self, trial, stage):
        """The next run, undisturbed, ends with the results of one that nothing disturbed before."""
        done = subprocess.run(self.command(stage), capture_output=True, text=True, timeout=LONGEST)
        if done.returncode != 0:
            self.complain(trial, f"the next run ends with {done.returncode}: {done.stderr.strip()[-300:]}")
            return
        for name, said in digests(self.place / "out").items():
            right = self.right.get(name)
            if said != right and (self.is_of(stage, name) or said != self.old.get(name)):
                self.complain(trial, f"after the next run {name} differs ({said})")
        if hidden(self.place / "out"):
            self.complain(trial, f"the next run leaves {hidden(self.place / 'out')}")

    @staticmethod
    def is_of(stage, name):
        if stage == "preprocess":
            names = ("domain.vdb", "obstacles.vdb", "preprocess.used.toml", "members.h5")
            return name.startswith("survey/") or name.endswith("domain.vdb") or name in names
        if stage == "solve":
            return name.endswith("run.h5") or name in ("solve.used.toml", "counts.h5")
        return not Bench.is_of("preprocess", name) and not Bench.is_of("solve", name)

    def places(self, total, few, many):
        """Numbers of the calls to try, of which this process takes its part: all of them where `many` is None."""
        wanted = many if self.full else few
        if wanted is None or total <= wanted:
            numbers = range(1, total + 1)
        elif wanted == 1:
            numbers = [1 + total // 2]
        else:
            numbers = sorted({1 + round(i * (total - 1) / (wanted - 1)) for i in range(wanted)})
        return numbers[self.part[0]::self.part[1]]

    def row(self, table, stage, what, counts):
        self.rows.append((table, stage, what, counts))
        print(f"{table:12} {stage:12} {what:28} " + ", ".join(f"{n} {word}" for word, n in counts.items()), flush=True)

    def trials(self, table, stage, what, numbers, wishes, allowed, killed=False, again=True):
        """One trial for each number; counts how they ended. `again`: the next run is tried too."""
        counts = {"trials": 0}
        for number in numbers:
            trial = f"{table} {stage} {what} {number}"
            fresh_copy(self.base[stage], self.place)
            code, said = self.run(stage, **wishes(number))
            counts["trials"] += 1
            ends = {0: "ended well", 3: "refused", 4: "failed", 130: "interrupted", -9: "killed"}
            name = ends.get(code, f"exit {code}")
            counts[name] = counts.get(name, 0) + 1
            if code not in allowed:
                self.complain(trial, f"exit code {code}: {said.strip()[-300:]}")
            if code == 3 and f"talus-{stage}: " not in said:
                self.complain(trial, f"it does not say what is wrong: {said.strip()[-200:]}")
            self.look(trial, killed or code in CRASHES)
            if again:
                self.again(trial, stage)
        self.row(table, stage, what, counts)


def kills(bench):
    """SIGKILL before every rename and sync, and before writes."""
    for stage in bench.stages:
        for ops, few, many in (("rename,fsync", 2, None), ("write", 2, 60), ("unlink,mkdir", 1, 20)):
            numbers = bench.places(bench.count(stage, ops), few, many)
            bench.trials("kill", stage, f"before {ops.replace(',', ' or ')}", numbers,
                         lambda n, ops=ops: {"ops": ops, "at": n, "do": "kill"}, {-9}, killed=True)


def interruptions(bench):
    """SIGTERM at a write: the stage ends by itself and leaves nothing half done."""
    for stage in bench.stages:
        numbers = bench.places(bench.count(stage, "write"), 3, 30)
        bench.trials("interrupt", stage, "SIGTERM at a write", numbers,
                     lambda n: {"ops": "write", "at": n, "do": "signal:15"}, {0, 130})


def errors(bench):
    """The n-th call fails, alone or with all that follow; a write takes half of its bytes."""
    for stage in bench.stages:
        # A disk that takes no sync keeps no promise: such a stage never ends well.
        for ops, names in (("write", ERRORS), ("fsync", ERRORS), ("rename", ERRORS), ("open,mkdir", ("ENOSPC",))):
            total, allowed = bench.count(stage, ops), {3} if ops == "fsync" else HANDLED
            for name in names if bench.full else list(names)[:1]:
                for on in ("", "on") if bench.full else ("on",):
                    numbers = bench.places(total, 2, 12)
                    bench.trials("error", stage, f"{ops.replace(',', ' or ')}: {name}{' from there on' if on else ''}",
                                 numbers, lambda n, ops=ops, name=name, on=on:
                                 {"ops": ops, "at": n, "do": f"errno:{getattr(errno, name)}", "on": on}, allowed)
        numbers = bench.places(bench.count(stage, "write"), 2, 20)
        bench.trials("error", stage, "write: half the bytes", numbers,
                     lambda n: {"ops": "write", "at": n, "do": "short"}, HANDLED)


def readings(bench):
    """The n-th reading fails, alone or with all that follow: nothing is taken for missing that could not be read."""
    # A domain that cannot be read fails its member, and too many of them the stage (exit code 4).
    handled = HANDLED | ({4} if bench.scene != "run" else set())
    for stage in bench.stages:
        numbers = bench.places(bench.count(stage, "read"), 6, None)
        for on in ("", "on") if bench.full else ("on",):
            bench.trials("read", stage, f"read: EIO{' from there on' if on else ''}", numbers,
                         lambda n, on=on: {"ops": "read", "at": n, "do": f"errno:{errno.EIO}", "on": on}, handled,
                         again=False)


def allocations(bench):
    """The n-th allocation fails. Libraries that do not look end the process; no file may suffer, no member fail."""
    for stage in bench.stages:
        numbers = bench.places(bench.count(stage, "allocation"), 3 if bench.scene == "run" else 16, 60)
        bench.trials("allocation", stage, "the n-th fails", numbers, lambda n: {"alloc": n}, HANDLED | CRASHES | {1})


def processes(bench):
    """While one stage is stopped in the middle of a write, others ask for the same folder; readers may go on."""
    for first in bench.stages:
        total = bench.count(first, "write")
        counts = {"pairs": 0, "triples": 0, "refused": 0, "readers": 0}
        for number in bench.places(total, 1, 4):
            trial = f"processes {first} {number}"
            fresh_copy(bench.base[first], bench.place)
            holder = bench.start(first, ops="write", at=number, do="signal:19")
            wait_until_stopped(holder)
            named = f"talus-{first} (process {holder.pid} on "
            if number == 1:  # in the middle of saying who it is
                named = "another process, which has not said its name"
            for second in STAGES:
                done = subprocess.run(bench.command(second), capture_output=True, text=True, timeout=LONGEST)
                counts["pairs"] += 1
                if done.returncode != 3 or f"in use by {named}" not in done.stderr:
                    bench.complain(trial, f"talus-{second} beside it: {done.returncode}, {done.stderr.strip()[-200:]}")
                else:
                    counts["refused"] += 1
            both = [subprocess.Popen(bench.command(stage), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                    for stage in STAGES[:2]]
            counts["triples"] += 1
            if [one.wait(LONGEST) for one in both] != [3, 3]:
                bench.complain(trial, "two more at once are not both refused")
            reader = subprocess.run([*bench.command("solve"), "--check"], capture_output=True, timeout=LONGEST)
            counts["readers"] += reader.returncode == 0
            holder.send_signal(signal.SIGCONT)
            _, said = holder.communicate(timeout=LONGEST)
            if holder.returncode != 0:
                bench.complain(trial, f"the first ends with {holder.returncode}: {said.strip()[-200:]}")
            bench.look(trial, killed=False)
            bench.again(trial, first)
        bench.row("processes", first, "stopped in a write", counts)
    without_locks(bench)
    at_once(bench)


def wait_until_stopped(process):
    for _ in range(LONGEST * 50):
        if pathlib.Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()[0] == "T":
            return
        time.sleep(0.02)
    sys.exit("the shim did not stop the process")


def without_locks(bench):
    """A file system that knows no locks: said, and the stage goes on."""
    for stage in bench.stages:
        fresh_copy(bench.base[stage], bench.place)
        code, said = bench.run(stage, ops="lock", at=1, do=f"errno:{errno.ENOLCK}", on="on")
        if code != 0 or "this file system knows no locks" not in said:
            bench.complain(f"no locks {stage}", f"exit code {code}: {said.strip()[-200:]}")
        bench.look(f"no locks {stage}", killed=False)
        bench.row("processes", stage, "no locks to be had", {"trials": 1, "ended well": int(code == 0)})


def at_once(bench):
    """Three stages at the same moment, again and again: each ends well or is refused, and nothing is broken."""
    counts = {"triples": 0, "ended well": 0, "refused": 0}
    # Where the first takes its time they come one after another: a run of another id has the same results.
    fresh_copy(bench.base["postprocess"], bench.place)
    for stage in STAGES:
        bench.must(stage)
    bench.look("one after another", killed=False)
    for turn in range(30 if bench.full else 2):
        fresh_copy(bench.base["postprocess"], bench.place)
        crowd = [subprocess.Popen(bench.command(stage), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
                 for stage in (STAGES, ("solve",) * 3, ("preprocess", "preprocess", "solve"))[turn % 3]]
        counts["triples"] += 1
        for one in crowd:
            said = one.communicate(timeout=LONGEST)[1]
            counts["ended well"] += one.returncode == 0
            counts["refused"] += one.returncode == 3
            if one.returncode not in HANDLED:
                bench.complain(f"at once {turn}", f"exit code {one.returncode}: {said.strip()[-200:]}")
        bench.look(f"at once {turn}", killed=False)
    bench.row("processes", "all", "three at the same moment", counts)


def power_cuts(bench):
    """The order of writes, syncs, renames and removals: what a power cut could lose that is counted on."""
    for stage in bench.stages:
        log = bench.work / "calls"
        log.unlink(missing_ok=True)
        fresh_copy(bench.base[stage], bench.place)
        code, said = bench.run(stage, ops="write,fsync,rename,open,unlink,mkdir", at=0, log=log)
        if code != 0:
            bench.complain(f"power {stage}", f"exit code {code}: {said.strip()[-200:]}")
        found, counts = faults_of(log)
        for line in found:
            bench.complain(f"power {stage}", line)
        bench.row("power cut", stage, "order of calls", {"calls": len(log.read_text().splitlines()), **counts})


TABLES = {"kill": kills, "interrupt": interruptions, "error": errors, "read": readings, "allocation": allocations,
          "processes": processes, "power": power_cuts}


def part(text):
    """K/N as (K - 1, N)."""
    number, count = map(int, text.split("/"))
    if not 1 <= number <= count:
        raise argparse.ArgumentTypeError(f"{text}: no part of {count}")
    return number - 1, count


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--bin", type=lambda p: pathlib.Path(p).resolve(), required=True)
    options.add_argument("--shim", type=lambda p: pathlib.Path(p).resolve(), required=True)
    options.add_argument("--work", type=lambda p: pathlib.Path(p).resolve(), required=True)
    options.add_argument("--full", action="store_true")
    options.add_argument("--only", choices=TABLES, action="append")
    options.add_argument("--stage", choices=STAGES, action="append", help="disturb this one alone")
    options.add_argument("--scene", choices=SCENES, default="run", help="what is computed")
    options.add_argument("--part", type=part, default=(0, 1), metavar="K/N",
                         help="every N-th place, from the K-th, for N processes that share the trials")
    options.add_argument("--table", type=pathlib.Path, help="write the counts there, as Markdown")
    arguments = options.parse_args()
    for tool in ("gdalinfo", "h5dump"):
        if shutil.which(tool) is None:
            print(f"SKIPPED: {tool} is not installed", file=sys.stderr)
            sys.exit(77)
    bench = Bench(arguments)
    for name in arguments.only or TABLES:
        TABLES[name](bench)
    if arguments.table:
        lines = ["| table | stage | fault | counts |", "| --- | --- | --- | --- |"]
        lines += [f"| {table} | {stage} | {what} | " + ", ".join(f"{n} {word}" for word, n in counts.items()) + " |"
                  for table, stage, what, counts in bench.rows]
        arguments.table.write_text("\n".join(lines) + "\n")
    print(f"{len(bench.wrong)} wrong")
    sys.exit(1 if bench.wrong else 0)


if __name__ == "__main__":
    main()
