# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a power cut may leave, from the recorded order of a program's calls: what was written and not forced to the disk
may be lost, in any order, and so may names."""
import os
import pathlib


def is_aside(path):
    """A file that is being made, or the lock: nobody counts on it."""
    name = os.path.basename(path)
    return ".partial" in name or name == ".talus.lock"


def faults_of(log):
    """The places where a power cut would lose what is counted on, as lines (none where the order is right), and counts.
    `log` is what the shim wrote: "write", "fsync", "rename", "unlink", "mkdir" or "open", a path, and bytes or a second
    path.

    - a name must not be given to a file whose content is not on the disk
    - nothing that carries a name may be removed while the name that takes its place is not on the disk
    - a name must not lie in a folder whose own name is not on the disk
    - no file that carries a name is written in place
    """
    unsynced, names, folders, gone, found = set(), {}, set(), {}, []
    counts = {"renames": 0, "unlinks": 0}
    for line in pathlib.Path(log).read_text().splitlines():
        op, path, other = line.split("\t")
        parent = os.path.dirname(path)
        if op == "write":
            unsynced.add(path)
            if not is_aside(path):
                found.append(f"written in place: {path}")
        elif op == "fsync":
            unsynced.discard(path)
            names.pop(path, None)
            gone.pop(path, None)
            folders = {folder for folder in folders if os.path.dirname(folder) != path}
        elif op == "mkdir":
            folders.add(path)
        elif op == "rename":
            counts["renames"] += 1
            if path in unsynced:
                found.append(f"named before its content was on the disk: {other}")
            if any(other.startswith(folder + "/") for folder in folders):
                found.append(f"in a folder that may be lost: {other}")
            names.setdefault(os.path.dirname(other), set()).add(other)
        elif op == "unlink" and not is_aside(path):
            counts["unlinks"] += 1
            if any(names.values()):
                found.append(f"removed before {sorted(map(sorted, names.values()))} were on the disk: {path}")
            if "/.frames/" in path and any(one.endswith("checkpoint.h5") for some in gone.values() for one in some):
                found.append(f"removed before the checkpoint that counts on it: {path}")
            gone.setdefault(parent, set()).add(path)
    return found, counts
