#!/usr/bin/env python3
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The QGIS plugin as a zip file: make-qgis-plugin.py --version 1.2.3 --to talus_provider.zip

It holds qgis/talus_provider with the version filled in, and the licence. The same sources give the same bytes.
"""
import argparse
import pathlib
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
NAME = "talus_provider"


def contents(version):
    """(name in the zip, bytes) of every file, sorted by name."""
    folder = ROOT / "qgis" / NAME
    found = [(path.relative_to(folder.parent).as_posix(), path.read_bytes())
             for path in sorted(folder.rglob("*")) if path.suffix in (".py", ".svg", ".txt")]
    found.append((f"{NAME}/LICENSE", (ROOT / "LICENSE").read_bytes()))
    return [(name, data.replace(b"@VERSION@", version.encode()) if name.endswith("metadata.txt") else data)
            for name, data in sorted(found)]


def main():
    parser = argparse.ArgumentParser(description="Makes the QGIS plugin's zip file.")
    parser.add_argument("--version", required=True)
    parser.add_argument("--to", required=True, type=pathlib.Path)
    asked = parser.parse_args()
    asked.to.parent.mkdir(parents=True, exist_ok=True)
    aside = asked.to.with_suffix(".part")
    with zipfile.ZipFile(aside, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in contents(asked.version):
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            entry.external_attr = 0o644 << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, data)
    aside.rename(asked.to)


main()
