#!/usr/bin/env python3
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The QGIS plugin and the projects that Talus writes, in QGIS itself, without a window: make check-qgis.

check_qgis.py --bin DIR --plugin ZIP --work DIR [--only NAME...]

Each check is a function check_NAME(place); it ends with an exception that says what was seen. What there is to look at
stays in the work folder: layout.png.
"""
import argparse
import os
import pathlib
import shutil
import subprocess
import sys
import traceback
import zipfile

HERE = pathlib.Path(__file__).resolve().parent
PROCESS = shutil.which("qgis_process.bin") or shutil.which("qgis_process")  # Debian's wrapper adds an unknown option


class Place:
    """Where the checks work: programs, plugin, and a scene of their own."""

    def __init__(self, asked):
        self.bin, self.work = asked.bin.resolve(), asked.work.resolve()
        self.scene, self.tests = self.work / "scene", HERE.parent
        shutil.rmtree(self.work, ignore_errors=True)
        (self.work / "run").mkdir(parents=True, mode=0o700)
        with zipfile.ZipFile(asked.plugin) as archive:
            archive.extractall(self.work / "plugins")
        os.environ.update(
            QT_QPA_PLATFORM="offscreen",
            QGIS_CUSTOM_CONFIG_PATH=str(self.work / "profile"),
            QGIS_PLUGINPATH=str(self.work / "plugins"),
            XDG_RUNTIME_DIR=str(self.work / "run"),
            TALUS=str(self.bin / "talus"),
            LC_ALL="C.UTF-8",
        )
        self.write_scene()

    def write_scene(self):
        """The bowl of tests/pipeline/scene.sh in UTM 11N, with frames, a gauge and a survey."""
        script = (f'TALUS_SOURCE=x TALUS_BUILD=x TALUS_SCRATCH=x; source "{HERE.parent}/pipeline/scene.sh"; scene')
        self.scene.mkdir(parents=True)
        subprocess.run(["bash", "-c", script], cwd=self.scene, check=True)
        recipe = self.scene / "recipe.toml"
        text = recipe.read_text()
        for name in ["before", "after", "survey"]:
            subprocess.run(["gdal_translate", "-q", "-a_srs", "EPSG:32611", f"{name}.asc", f"{name}.tif"],
                           cwd=self.scene, check=True)
        text = text.replace(".asc", ".tif").replace("end_time_s = 3.0", "end_time_s = 3.0\nframe_interval_s = 0.5")
        recipe.write_text(text)

    def process(self, *words, code=0):
        """qgis_process; returns what it says."""
        done = subprocess.run([PROCESS, *words], capture_output=True, text=True, check=False)
        said = done.stdout + done.stderr
        assert done.returncode == code, f"qgis_process {' '.join(words)} ended with {done.returncode}:\n{said[-3000:]}"
        return said


def check_lists_its_algorithms(place):
    place.process("plugins", "enable", "talus_provider")
    said = place.process("list")
    for name in ["runrecipe", "checkrecipe", "newrecipe", "loadresults", "compareruns"]:
        assert f"talus:{name}\t" in said, f"talus:{name} is not listed"
        words = place.process("help", f"talus:{name}")
        assert "Description" in words and len(words) > 300, f"talus:{name} has no help: {words}"


def check_runs_by_qgis_process(place):
    said = place.process("run", "talus:runrecipe", "--", f"RECIPE={place.scene}/recipe.toml", "ON=1", "THREADS=2",
                         f"OUT={place.work}/by-process", "LOAD=0")
    out = place.work / "by-process"
    assert (out / "report.html").is_file() and (out / "maps" / "bowl.qgs").is_file(), said
    assert f"REPORT:\t{out}/report.html" in said, said
    said = place.process("run", "talus:checkrecipe", "--", f"RECIPE={place.scene}/recipe.toml")
    assert "WORDS:" in said, said
    bad = place.scene / "bad.toml"
    bad.write_text((place.scene / "recipe.toml").read_text().replace("end_time_s", "end_tim_s"))
    said = place.process("run", "talus:checkrecipe", "--", f"RECIPE={bad}", code=1)
    assert "end_tim_s" in said and "end_time_s" in said, f"the fault is not named: {said}"
    said = place.process("run", "talus:newrecipe", "--", f"BEFORE={place.scene}/before.tif",
                         f"AFTER={place.scene}/after.tif", f"RECIPE={place.work}/new.toml")
    assert "[solve]" in (place.work / "new.toml").read_text(), said


def main():
    parser = argparse.ArgumentParser(description="Checks plugin and projects in QGIS.")
    parser.add_argument("--bin", type=pathlib.Path, required=True)
    parser.add_argument("--plugin", type=pathlib.Path, required=True)
    parser.add_argument("--work", type=pathlib.Path, required=True)
    parser.add_argument("--only", nargs="*", default=[])
    asked = parser.parse_args()
    if PROCESS is None:
        sys.exit("qgis_process was not found. Install QGIS: tools/install-dependencies.sh qgis")
    place = Place(asked)
    from in_qgis import in_qgis_checks  # imports QGIS, once the environment is set

    checks = [check_lists_its_algorithms, check_runs_by_qgis_process, *in_qgis_checks]
    failed = 0
    for check in checks:
        name = check.__name__.replace("check_", "", 1)
        if asked.only and name not in asked.only:
            continue
        try:
            check(place)
            print(f"passed: {name}", flush=True)
        except Exception:  # each is told, and the others run
            failed += 1
            print(f"FAILED: {name}\n{traceback.format_exc()}", flush=True)
    words = f"{failed} of the checks in QGIS failed" if failed else "all checks in QGIS passed"
    print(f"{words}; to look at: {place.work}/layout.png", flush=True)
    os._exit(1 if failed else 0)  # QGIS crashes now and then while Python takes it down


main()
