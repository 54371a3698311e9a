#!/usr/bin/env python3
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the site of documents: stages the Markdown files of the tree, adds what the programs say of themselves (keys
of recipes from --template, options from --help) and calls Sphinx with MyST. A warning of Sphinx is an error.

usage: tools/make-site.py --out DIR [--bin DIR] [--code DIR]

--bin holds the built programs; without it the pages of keys and options are left out, and the site says so.
--code holds the pages that Doxygen made (tools/make-docs.sh): they come into the site as DIR/html/code.
Prints the path of the first page. Needs python3-sphinx, python3-myst-parser and furo of Debian or Ubuntu.
"""
import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys

import make_reference

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGES = ["README.md", "CHANGELOG.md", "CONTRIBUTING.md", "CODE_OF_CONDUCT.md", "docs/**/*.md",
         "pipelines/*/README.md", "data_samples/README.md"]
LINK = re.compile(r"(!?\[[^\]]*\]\(|^\[[^\]\n]+\]: +)([^)\s#]+)((?:#[^)\s]*)?\)?)", re.M)
OUTSIDE = re.compile(r"(https?|mailto):")


def staged_pages():
    return sorted({path for pattern in PAGES for path in ROOT.glob(pattern)})


def without_code(text):
    """Fenced blocks blanked out, so that nothing in them is taken for a link."""
    return re.sub(r"^ *```.*?^ *```$", lambda block: "\n" * block.group(0).count("\n"), text, flags=re.M | re.S)


def links_of(text):
    """Relative targets in the order in which they stand."""
    plain = without_code(text)
    found = [m.group(2) for m in LINK.finditer(plain)] + re.findall(r'<img src="([^"]+)"', plain)
    return [target for target in found if not OUTSIDE.match(target)]


def stage(page, source, pages):
    """Copies a page with the files that it links to. A link to a folder becomes plain text: a site lists none."""
    text = page.read_text(encoding="utf-8")
    for target in links_of(text):
        path = (page.parent / target).resolve()
        if path in pages or not path.is_relative_to(ROOT):
            continue
        if path.is_dir():
            text = re.sub(r"\[([^\]]*)\]\(" + re.escape(target) + r"(#[^)]*)?\)", r"\1", text)
        elif path.exists():
            copy = source / path.relative_to(ROOT)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(path, copy)
    here = source / page.relative_to(ROOT)
    here.parent.mkdir(parents=True, exist_ok=True)
    here.write_text(text, encoding="utf-8")


def tree_of(entries, caption=""):
    lines = ["", "```{toctree}", ":hidden:"]
    return "\n".join(lines + ([f":caption: {caption}"] if caption else []) + ["", *entries, "```", ""])


def entry(page, folder):
    return os.path.relpath(page.with_suffix(""), folder)


def add_tree(index, source):
    """Gives an index page the tree of what it links to in its own folder and below, and of all else that lies there."""
    folder = index.parent
    text = index.read_text(encoding="utf-8")
    linked = [(folder / target).resolve() for target in links_of(text) if target.endswith(".md")]
    inside = [p for p in linked if p.is_relative_to(folder) and p.exists() and p != index]
    rest = [p for p in sorted(folder.rglob("*.md")) if p not in inside and p != index]
    nested = {p.parent for p in rest + inside if p.name == "index.md" and p.parent != folder}
    listed = [p for p in dict.fromkeys(inside + rest) if p.name == "index.md" or p.parent not in nested]
    index.write_text(text + tree_of([entry(p, folder) for p in listed]), encoding="utf-8")


def add_root_tree(source):
    """The first page: the four parts, then what is for those who change the program, then pages beside docs/."""
    index = source / "docs/index.md"
    parts = [f"{part}/index" for part in ("tutorials", "how-to", "reference", "explanation")]
    beside = [p for p in sorted(source.rglob("*.md")) if not p.is_relative_to(index.parent)]
    scenes = [entry(p, index.parent) for p in beside if p.parent != source]
    project = [entry(p, index.parent) for p in beside if p.parent == source]
    with index.open("a", encoding="utf-8") as out:
        out.write(tree_of(parts) + tree_of(scenes, "Scenes and samples") + tree_of(project, "The project") +
                  tree_of(["notes/index"], "For developers"))


def add_reference(source, programs):
    """Pages of keys and options behind the list of the reference's first page; ends where a program is missing."""
    folder = source / "docs/reference"
    written = make_reference.write_pages(programs, folder) if programs else []
    with (folder / "index.md").open("a", encoding="utf-8") as out:
        if written:
            out.write("\nMade from what the programs say of themselves:\n\n")
            out.writelines(f"- [{heading}]({name})\n" for name, heading in written)
        else:
            out.write("\nThis site was made without the programs, so the pages of keys and options are missing.\n")


def call_sphinx(source, html, version):
    shutil.rmtree(html, ignore_errors=True)
    run = subprocess.run([sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-b", "html", "-c",
                          str(ROOT / "docs"), "-d", str(html.parent / "doctrees"), str(source), str(html)],
                         env=os.environ | {"TALUS_VERSION": version}, capture_output=True, text=True, check=False)
    if run.returncode != 0:
        sys.exit(f"{run.stderr.replace(str(source) + '/', '')}tools/make-site.py: Sphinx found faults. Mend the pages "
                 "that are named above")


def add_first_page(html):
    (html / "index.html").write_text(
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>Talus</title>\n'
        '<meta http-equiv="refresh" content="0; url=docs/index.html"></head>\n'
        '<body><a href="docs/index.html">Talus: documents</a></body></html>\n', encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n\n")[0])
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--bin", type=pathlib.Path)
    parser.add_argument("--code", type=pathlib.Path)
    asked = parser.parse_args()
    try:
        import furo, myst_parser, sphinx  # noqa: E401, F401 pylint: disable=unused-import,import-outside-toplevel
    except ImportError as missing:
        sys.exit(f"tools/make-site.py: {missing.name} was not found (the site is made with it). Install it: "
                 "apt-get install python3-sphinx python3-myst-parser furo")
    source, html = asked.out / "source", asked.out / "html"
    shutil.rmtree(source, ignore_errors=True)
    pages = staged_pages()
    for page in pages:
        stage(page, source, pages)
    add_reference(source, asked.bin)
    if asked.code:
        with (source / "docs/index.md").open("a", encoding="utf-8") as out:
            out.write('\nThe programmers\' reference of all headers: <a href="../code/index.html">code</a>.\n')
    for index in (source / "docs").glob("*/index.md"):
        add_tree(index.resolve(), source)
    add_root_tree(source)
    version = re.search(r"^project\(talus VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text(), re.M).group(1)
    call_sphinx(source, html, version)
    add_first_page(html)
    if asked.code:
        shutil.copytree(asked.code, html / "code")
    print(html / "index.html")


if __name__ == "__main__":
    main()
