#!/usr/bin/env python3
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the pictures of the documents, each from a run, a table of figures or a case of the validation.

usage: tools/make-pictures.py [NAME...] --bin DIR --work DIR [--data DIR]     make these, or all

docs/pictures/pictures.json lists every picture and what makes it. Tests of the tutorials draw their pictures again and
compare. Pictures of real events need their data (--data), those of a validation case what make validate leaves beside
the programs; without, they are left as they are.
"""
import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDER = ROOT / "docs/pictures"
LIST = FOLDER / "pictures.json"


def read_list():
    return json.loads(LIST.read_text(encoding="utf-8"))


def call(words, **more):
    run = subprocess.run([str(w) for w in words], check=False, **more)
    if run.returncode:
        sys.exit(f"tools/make-pictures.py: {' '.join(str(w) for w in words)} ended with {run.returncode}")


def in_few_colours(image):
    """The picture in a palette of 256, without dithering; as it is where that would be seen: where a colour in a
    thousand moves by more than 12 of 255, or any by more than 40."""
    from PIL import Image, ImageChops  # pylint: disable=import-outside-toplevel
    plain = image.convert("RGB")
    if "A" in image.getbands() and image.getchannel("A").getextrema()[0] < 255:
        return image
    few = plain.quantize(256, method=Image.Quantize.MAXCOVERAGE, kmeans=1, dither=Image.Dither.NONE)
    counts = [ImageChops.difference(plain, few.convert("RGB")).getchannel(c).histogram() for c in range(3)]
    seen = any(sum(count[13:]) > 1e-3 * sum(count) or sum(count[41:]) > 0 for count in counts)
    return image if seen else few


def shrink(picture, width=1400):
    """No wider than a page shows it, and in few colours, to keep the repository small."""
    from PIL import Image  # pylint: disable=import-outside-toplevel
    with Image.open(picture) as image:
        if image.width > width:
            image = image.convert("RGB").resize((width, round(image.height * width / image.width)), Image.LANCZOS)
        (image if image.mode == "P" else in_few_colours(image)).save(picture, optimize=True)


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


# Scenes whose peaks are drawn beside other models': the folder of their data, and NAME=PREFIX of each model.
PEAKS = {"iseesnow-realtopo": ("iseesnow_realtopo", ("com1DFA=com1DFA", "RAMMS=RAMMSUSER", "r.avaflow=avaflow")),
         "avaframe-alr": ("avaframe_alr", ("com1DFA=com1dfa",)),
         "avaframe-gar": ("avaframe_gar", ("com1DFA=com1dfa",))}


def make_peaks(scene, asked, picture):
    """Peaks of an avalanche beside other models' (tools/plot-peaks.py)."""
    folder, others = PEAKS[scene]
    data, out = asked.data.resolve() / folder, asked.work / scene
    call([asked.bin / "talus", "run", ROOT / f"pipelines/{scene}/recipe.toml", "--out", out, "-q"],
         env=os.environ | {"TALUS_DATA": str(asked.data.resolve())}, stdout=subprocess.DEVNULL)
    call([sys.executable, ROOT / "tools/plot-peaks.py", FOLDER / picture, data / "dem.tif", f"Talus, 10 m={out}",
          *(other.replace("=", f"={data}/") for other in others)])


def case_picture(name, asked):
    """Where make validate leaves this picture of a case."""
    return asked.bin.resolve().parent / f"validation/{name}.png"


def make_budget(scene, asked, picture):
    """The table of an error budget on its page."""
    sys.path.insert(0, str(ROOT / "tests/pipeline"))
    from browser import open_browser  # pylint: disable=import-outside-toplevel
    from selenium.webdriver.common.by import By  # pylint: disable=import-outside-toplevel
    from selenium.webdriver.support.ui import WebDriverWait  # pylint: disable=import-outside-toplevel
    out = asked.work / f"{scene}-budget"
    call([asked.bin / "talus", "run", ROOT / f"pipelines/{scene}/recipe.toml", "--out", out, "--budget", "-q"],
         stdout=subprocess.DEVNULL)
    browser = open_browser((1250, 1000))
    try:
        browser.get((out / "ensemble.html").resolve().as_uri())
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
            make_peaks(name, asked, pictures[0])
        elif kind == "case":
            shutil.copyfile(case_picture(name, asked), FOLDER / pictures[0])
        else:
            call([sys.executable, ROOT / name])
        for picture in pictures:
            shrink(FOLDER / picture)
            print(FOLDER / picture)


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n\n")[0])
    parser.add_argument("names", nargs="*")
    parser.add_argument("--bin", type=pathlib.Path, required=True)
    parser.add_argument("--work", type=pathlib.Path, required=True)
    parser.add_argument("--data", type=pathlib.Path)
    asked = parser.parse_args()
    asked.work.mkdir(parents=True, exist_ok=True)
    make_all(asked.names, asked)


if __name__ == "__main__":
    main()
