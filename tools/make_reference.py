# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pages of the reference from what the programs say of themselves: keys from --template, options from --help.

Part of tools/make-site.py. Nothing about a key or an option is written down here.
"""
import importlib.util
import pathlib
import re
import subprocess
import sys

STAGES = ["preprocess", "solve", "postprocess"]
TABLE = re.compile(r"^(?:# )?(\[\[?)([a-z_.]+)\]\]?$")
KEY = re.compile(r"^(?:# )?([A-Za-z][A-Za-z0-9_]*) = (.*)$")
RANGE = re.compile(r" \[([^\[\]]*)\]$")


def manuals():
    """tools/make-manuals.py as a module: it reads --help, for the man pages too."""
    spec = importlib.util.spec_from_file_location("manuals", pathlib.Path(__file__).with_name("make-manuals.py"))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def said_by(program, option):
    if not pathlib.Path(program).exists():
        sys.exit(f"tools/make-site.py: {program} was not found (keys and options are what the programs say). "
                 "Build them first: make build")
    run = subprocess.run([str(program), option], capture_output=True, text=True, check=False)
    if run.returncode != 0:
        sys.exit(f"tools/make-site.py: {program} {option} ended with {run.returncode}: {run.stderr.strip()}")
    return run.stdout


def read_template(text):
    """Tables in their order: (header as in a recipe, what it is for, rows of (key, default, range, meaning)). The
    example of [scene] above the stage's own table is left out: it is the same for all stages."""
    tables, comment, optional = [], "", False
    for line in text.partition("\n\n")[2].splitlines():
        if not line.strip():
            comment, optional = "", False
            continue
        bare = line.removeprefix("# ") if optional or line.startswith("# # ") else line
        table, key = TABLE.match(line), KEY.match(line)
        if table:
            optional = line.startswith("# ")
            brackets = (table.group(1), "]" * len(table.group(1)))
            tables.append((brackets[0] + table.group(2) + brackets[1], comment, []))
            comment = ""
        elif key and tables:
            found = RANGE.search(comment)
            meaning = comment[:found.start()] if found else comment
            default = "none" if key.group(2) == "..." else key.group(2)
            tables[-1][2].append((key.group(1), default, found.group(1) if found else "", meaning))
            comment = ""
        elif bare.startswith("#"):
            comment = bare.lstrip("# ")
    return tables


def cell(text):
    return re.sub(r"([|*<])", r"\\\1", text)


def page_of_keys(stage, program):
    """Markdown: a section for each table of the stage, a row for each key."""
    tables = read_template(said_by(program, "--template"))
    keys = sum(len(rows) for _, _, rows in tables)
    if keys < 10:
        sys.exit(f"tools/make-site.py: only {keys} keys were found in what {program} --template says")
    lines = [f"# Keys of [{stage}]", "",
             f"Every key that `talus-{stage}` reads, as `talus-{stage} --template` prints it: {keys} keys. A table in",
             "double brackets may be given many times.", ""]
    for header, purpose, rows in tables:
        lines += [f"## {header}", ""] + ([purpose[:1].upper() + purpose[1:] + ".", ""] if purpose else [])
        if rows:
            lines += ["| key | default | allowed | meaning |", "| --- | --- | --- | --- |"]
            for key, default, allowed, meaning in rows:
                lines.append(f"| `{key}` | `{default}` | {cell(allowed)} | {cell(meaning)} |")
            lines.append("")
    return "\n".join(lines)


def options_table(items):
    lines = ["| option | meaning |", "| --- | --- |"]
    for item in items:
        names = ", ".join(item.names) + (f" {item.value}" if item.value else "")
        lines.append(f"| `{names.replace('|', chr(92) + '|')}` | {cell(item.text)} |")
    return lines + [""]


def section_of(page, level):
    lines = [f"{'#' * level} {page.name}", "", page.summary, "", "```text", page.usage or page.name, "```", ""]
    for kind in ("Positionals", "Options"):
        if page.items[kind]:
            lines += options_table(page.items[kind])
    return lines


def page_of_options(program):
    reader = manuals()
    top = reader.read_help(program)
    lines = section_of(top, 1)
    for item in top.items["Subcommands"]:
        lines += section_of(reader.read_help(program, item.names[0]), 2)
    for heading, text in top.paragraphs():
        if heading == "Examples":
            lines += ["## Examples", "", "```text", *(line.strip() for line in text), "```", ""]
        else:
            lines += [f"## {heading}", ""] if heading else []
            lines += [*text, ""]
    return "\n".join(lines)


def write_pages(programs, folder):
    """Writes keys-STAGE.md and PROGRAM.md; gives (file, heading) of each. `programs` is the folder of the programs."""
    pages = [(f"keys-{stage}.md", f"Keys of [{stage}]", page_of_keys(stage, programs / f"talus-{stage}"))
             for stage in STAGES]
    names = ["talus", *(f"talus-{stage}" for stage in STAGES), "talus-make-terrain"]
    pages += [(f"{name}.md", f"Options of {name}", page_of_options(programs / name))
              for name in names if (programs / name).exists()]
    for file, _, text in pages:
        (folder / file).write_text(text, encoding="utf-8")
    return [(file, heading) for file, heading, _ in pages]
