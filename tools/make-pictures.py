#!/usr/bin/env python3
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the pictures of the documents, each from a run or from a table of figures, with a stamp of what it is made of.

usage: tools/make-pictures.py [NAME...] --bin DIR --work DIR [--data DIR]     make these, or all
       tools/make-pictures.py --check                                       say which are stale or of no known origin

docs/pictures/pictures.json lists every picture: what makes it, the files that decide what it shows ("from"), and the
SHA-256 of these ("stamp"). A tutorial counts by its commands and files alone, so that its prose may change. Sources
of programs are not among them: tests of the tutorials draw their pictures anew and compare.
Pictures of real events need their data (--data), and those of a validation case what make validate leaves beside the
programs; without, they are left as they are.
"""
import argparse
import hashlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDER = ROOT / "docs/pictures"
LIST = FOLDER / "pictures.json"


def content_of(path):
    """What of a file decides a picture: of a page the commands, the files it gives and the names of pictures; of a
    recipe the values; else all of it."""
    if path.suffix == ".toml":
        return json.dumps(tomllib.loads(path.read_text(encoding="utf-8")), sort_keys=True).encode()
    if path.suffix == ".md":
        text = path.read_text(encoding="utf-8")
        blocks = re.findall(r"^```(\w+)\n(.*?)^```$|(<!-- picture: .*? -->)", text, re.M | re.S)
        return "\n".join("\n".join(line for line in (body or mark).splitlines()
                                   if kind != "console" or line.startswith(("$ ", "> ")))
                         for kind, body, mark in blocks).encode()
    return path.read_bytes()


def files_of(patterns):
    found = []
    for pattern in patterns:
        matched = sorted(p for p in ROOT.glob(pattern) if p.is_file())
        if not matched:
            sys.exit(f"{LIST.relative_to(ROOT)}: {pattern} matches no file (it is named as what a picture is made of). "
                     "Correct the name")
        found += matched
    return sorted(set(found))


def stamp_of(patterns):
    digest = hashlib.sha256()
    for path in files_of(patterns):
        digest.update(str(path.relative_to(ROOT)).encode() + b"\0" + content_of(path) + b"\0")
    return digest.hexdigest()[:16]


def read_list():
    return json.loads(LIST.read_text(encoding="utf-8"))


def write_list(entries):
    LIST.write_text(json.dumps(entries, indent=2) + "\n", encoding="utf-8")


def check():
    """Every picture has an entry and every entry a picture, and nothing that it is made of has changed since."""
    entries, faults = read_list(), []
    for picture in sorted(p.name for p in FOLDER.glob("*.png")):
        if picture not in entries:
            faults.append(f"docs/pictures/{picture} has no entry in pictures.json: say what it is made of")
    for picture, entry in entries.items():
        if not (FOLDER / picture).exists():
            faults.append(f"docs/pictures/{picture} is missing. Make it: make pictures PICTURES={picture}")
        elif stamp_of(entry["from"]) != entry["stamp"]:
            faults.append(f"docs/pictures/{picture} is stale: one of {', '.join(entry['from'])} has changed since "
                          f"it was made. Make it anew and look at it: make pictures PICTURES={picture}")
    if faults:
        sys.exit("\n".join(faults))
    print(f"{len(entries)} pictures are those of what they are made of")


def call(words, **more):
    run = subprocess.run([str(w) for w in words], check=False, **more)
    if run.returncode:
        sys.exit(f"tools/make-pictures.py: {' '.join(str(w) for w in words)} ended with {run.returncode}")


def shrink(picture, width=1400):
    """No wider than a page shows it, to keep the repository small. Fewer colours would take those of the legend."""
    from PIL import Image  # pylint: disable=import-outside-toplevel
    with Image.open(picture) as image:
        if image.width > width:
            image = image.convert("RGB").resize((width, round(image.height * width / image.width)), Image.LANCZOS)
        image.save(picture, optimize=True)


def make_tutorial(page, asked, wanted):
    work = asked.work / page
    shutil.rmtree(work, ignore_errors=True)
    made = asked.work / f"{page}-pictures"
    call([sys.executable, ROOT / "tools/run-tutorial.py", ROOT / f"docs/tutorials/{page}.md", "--bin", asked.bin,
          "--work", work, "--pictures", made])
    for picture in wanted:
        shutil.copyfile(made / picture, FOLDER / picture)


def make_scene(scene, asked, wanted):
    """map.png of a scene under pipelines/."""
    data = os.environ | {"TALUS_DATA": str(asked.data.resolve()) if asked.data else ""}
    call([asked.bin / "talus", "run", ROOT / f"pipelines/{scene}/recipe.toml", "--out", asked.work / scene, "-q"],
         env=data, stdout=subprocess.DEVNULL)
    for picture in wanted:
        shutil.copyfile(asked.work / scene / "map.png", FOLDER / picture)


def make_peaks(asked, picture):
    """Peaks of the ISeeSnow avalanche beside other models' (tools/plot-peaks.py)."""
    data, out = asked.data.resolve() / "iseesnow_realtopo", asked.work / "iseesnow-realtopo"
    call([asked.bin / "talus", "run", ROOT / "pipelines/iseesnow-realtopo/recipe.toml", "--out", out, "-q"],
         env=os.environ | {"TALUS_DATA": str(asked.data.resolve())}, stdout=subprocess.DEVNULL)
    others = ("com1DFA=com1DFA", "RAMMS=RAMMSUSER", "r.avaflow=avaflow")
    call([sys.executable, ROOT / "tools/plot-peaks.py", FOLDER / picture, data / "dem.tif", f"Talus, 10 m={out}",
          *(other.replace("=", f"={data}/") for other in others)])


def case_picture(name, asked):
    """Where make validate leaves this picture of a case."""
    return asked.bin.resolve().parent / f"validation/{name}.png"


def make_budget(scene, asked, picture):
    """The table of an error budget in the report of a scene."""
    sys.path.insert(0, str(ROOT / "tests/pipeline"))
    from browser import open_browser  # pylint: disable=import-outside-toplevel
    from selenium.webdriver.common.by import By  # pylint: disable=import-outside-toplevel
    from selenium.webdriver.support.ui import WebDriverWait  # pylint: disable=import-outside-toplevel
    out = asked.work / f"{scene}-budget"
    call([asked.bin / "talus", "run", ROOT / f"pipelines/{scene}/recipe.toml", "--out", out, "--budget", "-q"],
         stdout=subprocess.DEVNULL)
    browser = open_browser((1250, 1000))
    try:
        browser.get((out / "report.html").resolve().as_uri())
        WebDriverWait(browser, 60).until(
            lambda b: b.execute_script("return document.documentElement.dataset.ready === 'yes'"))
        browser.find_element(By.ID, "budget-section").screenshot(str(FOLDER / picture))
    finally:
        browser.quit()


def make_all(names, asked):
    entries = read_list()
    makers = {}
    for picture in names or entries:
        if picture not in entries:
            sys.exit(f"tools/make-pictures.py: {picture} is not in {LIST.relative_to(ROOT)}. Known: "
                     f"{', '.join(entries)}")
        entry = entries[picture]
        if entry.get("needs") and not (asked.data and (asked.data / entry["needs"]).is_dir()):
            print(f"{picture}: left as it is, for --data holds no {entry['needs']}", file=sys.stderr)
            continue
        kind, _, name = entry["by"].partition(" ")
        if kind == "case" and not case_picture(name, asked).exists():
            print(f"{picture}: left as it is, for there is no {case_picture(name, asked)}. Make it: make validate "
                  f"LONG=1 CASES={name.partition('-')[0]}", file=sys.stderr)
            continue
        makers.setdefault(entry["by"], []).append(picture)
    for maker, pictures in makers.items():
        kind, _, name = maker.partition(" ")
        if kind == "tutorial":
            make_tutorial(name, asked, pictures)
        elif kind == "scene":
            make_scene(name, asked, pictures)
        elif kind == "budget":
            make_budget(name, asked, pictures[0])
        elif kind == "peaks":
            make_peaks(asked, pictures[0])
        elif kind == "case":
            shutil.copyfile(case_picture(name, asked), FOLDER / pictures[0])
        else:
            call([sys.executable, ROOT / name])
        for picture in pictures:
            if kind != "script":
                shrink(FOLDER / picture)
            entries[picture]["stamp"] = stamp_of(entries[picture]["from"])
            print(FOLDER / picture)
        write_list(entries)


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n\n")[0])
    parser.add_argument("names", nargs="*")
    parser.add_argument("--bin", type=pathlib.Path)
    parser.add_argument("--work", type=pathlib.Path)
    parser.add_argument("--data", type=pathlib.Path)
    parser.add_argument("--check", action="store_true")
    asked = parser.parse_args()
    if asked.check:
        check()
    elif asked.bin and asked.work:
        asked.work.mkdir(parents=True, exist_ok=True)
        make_all(asked.names, asked)
    else:
        parser.error("name --bin and --work, or --check")


if __name__ == "__main__":
    main()
