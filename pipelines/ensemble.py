#!/usr/bin/python3
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""An ensemble in parts over machines that share a folder, with Dask (Debian's python3-distributed):

  talus-preprocess recipe.toml --out DIR
  dask scheduler --scheduler-file DIR/dask.json                # on one machine
  dask worker --scheduler-file DIR/dask.json --nthreads 1      # on each machine, at any time
  ensemble.py recipe.toml DIR PARTS [OPTION...]                # at the end talus-postprocess adds the parts up

talus-solve takes the options. Each part is a task that runs ensemble.sbatch, which lies beside this file. When a
worker dies, another one computes its part from the finished members. Started again, ensemble.py computes the missing
parts. TALUS_BIN is the folder of the programs where PATH lacks them, for workers too.
"""
import os
import subprocess
import sys
from pathlib import Path

from distributed import Client, as_completed


def solve(command, parts, part):
    """Computes a part. When the worker dies, talus-solve gets SIGTERM: it saves its finished members and ends."""
    environment = {**os.environ, "PARTS": str(parts), "PART": str(part)}
    done = subprocess.run(["setpriv", "--pdeathsig", "TERM", *command], env=environment, text=True, capture_output=True)
    if done.returncode != 0:
        raise RuntimeError(f"part {part} of {parts}, exit code {done.returncode}: {done.stderr}")


def main(recipe, out, parts, *options):
    script = Path(__file__).resolve().with_name("ensemble.sbatch")
    command = [str(script), str(Path(recipe).resolve()), str(Path(out).resolve()), *options]
    failed = 0
    with Client(scheduler_file=f"{out}/dask.json") as client:
        # No list holds the tasks: Dask would compute those again whose results, which are empty, died with a worker.
        for done, task in enumerate(as_completed(client.submit(solve, command, parts, part, pure=False, retries=2)
                                                 for part in range(parts)), 1):
            failed += task.status != "finished"
            print(f"{done} of {parts} parts" if task.status == "finished" else f"{task.status}: {task.exception()}",
                  file=sys.stderr)
    if failed:
        sys.exit(f"{failed} of {parts} parts failed")
    merge = os.path.join(os.environ.get("TALUS_BIN", ""), "talus-postprocess")
    sys.exit(subprocess.run([merge, recipe, "--out", out]).returncode)


if __name__ == "__main__":
    if len(sys.argv) < 4 or not sys.argv[3].isdecimal():
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2], int(sys.argv[3]), *sys.argv[4:])
