#!/usr/bin/env python3
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the man page and the completions (bash, zsh) of a program from its own --help, and the man page of the recipe
from the stages' --template. No option is written down here: what a program does not say of itself is not in them.

usage: tools/make-manuals.py PROGRAM... --to DIR --version VERSION [--pages NAME...]
       tools/make-manuals.py --recipe PROGRAM... --to DIR --version VERSION [--pages NAME...]

Writes DIR/man/NAME.1, DIR/bash/NAME and DIR/zsh/_NAME, or DIR/man/talus-recipe.5.
"""
import argparse
import gzip
import pathlib
import re
import subprocess
import sys

SECTION = re.compile(r"^(Positionals|Options|Subcommands|Commands):$")
ITEM = re.compile(r"^ {1,4}(\S.*?)(?: {2,}(\S.*))?$")
COLUMN = 30   # where CLI11 begins the help of an item; names that fill the way there are one space away from it
MORE = re.compile(r"^ {12,}(\S.*)$")
WORDS = re.compile(r"^[\w.+-]+(\|[\w.+-]+)+$")


class Item:
    """An option, a positional or a subcommand: its names, what stands for its value ("" for none), its help."""

    def __init__(self, head, text):
        head = re.sub(r" (Excludes|Needs): .*", "", head)
        names, _, value = head.partition(" ")
        self.names = [name.strip() for name in names.split(",")]
        self.required = value.endswith("REQUIRED")
        self.value = value.removesuffix("REQUIRED").strip()
        self.text = text

    def finish(self):
        """What depends on the machine that asked goes out of the help."""
        self.text = re.sub(r"\s+", " ", self.text).strip()
        self.text = re.sub(r", \d+ here\)", ")", self.text)
        bare = self.value.strip("[]")
        self.choices = bare.split("|") if WORDS.match(bare) else []
        return self


class Help:
    """What a program says of itself: summary, usage, positionals, options, subcommands and the paragraphs after."""

    def __init__(self, name, text):
        self.name = name
        self.summary, self.usage, self.after = "", "", []
        self.items = {"Positionals": [], "Options": [], "Subcommands": []}
        section, item = None, None
        for line in text.splitlines():
            start = SECTION.match(line)
            if start:
                section, item = start.group(1).replace("Commands", "Subcommands"), None
            elif section and self.after == [] and item and MORE.match(line):
                item.text += " " + line.strip()
            elif section and self.after == [] and ITEM.match(line):
                head, help_text = ITEM.match(line).groups()
                if help_text is None and line[COLUMN - 1:COLUMN] == " ":
                    head, help_text = line[:COLUMN].strip(), line[COLUMN:]
                item = Item(head, help_text or "")
                self.items[section].append(item)
            elif line.startswith("Usage: "):
                self.usage = line.removeprefix("Usage: ")
            elif not section:
                self.summary = f"{self.summary} {line}".strip()
            elif line.strip() or self.after:
                self.after.append(line)
        for items in self.items.values():
            for entry in items:
                entry.finish()
        if not self.items["Options"] or not self.summary:
            sys.exit(f"tools/make-manuals.py: the --help of {name} has no options or no summary that this can read")

    def paragraphs(self):
        """The text after the options, in paragraphs: (heading or None, lines)."""
        found = []
        for block in re.split(r"\n\s*\n", "\n".join(self.after).strip("\n")):
            lines = block.splitlines()
            if not lines:
                continue
            if re.match(r"^[A-Z][A-Za-z ]*:$", lines[0]):
                found.append((lines[0][:-1], lines[1:]))
            elif lines[0].startswith("Exit codes: "):
                found.append(("Exit codes", [lines[0].removeprefix("Exit codes: "), *lines[1:]]))
            else:
                found.append((None, lines))
        return found


def read_help(program, *subcommand):
    words = [str(program), *subcommand, "--help"]
    run = subprocess.run(words, capture_output=True, text=True, check=False)
    if run.returncode != 0:
        sys.exit(f"tools/make-manuals.py: {' '.join(words)} ended with {run.returncode}: {run.stderr.strip()}")
    return Help(" ".join([program.name, *subcommand]), run.stdout)


def roff(text):
    """Text as troff takes it: hyphens that can be copied, no request at the start of a line."""
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + text if text.startswith((".", "'")) else text


def roff_items(items):
    lines = []
    for item in items:
        names = ", ".join(f"\\fB{roff(name)}\\fR" for name in item.names)
        value = f" \\fI{roff(item.value)}\\fR" if item.value else ""
        lines += [".TP", names + value, roff(item.text) or "\\&"]
    return lines


def roff_example(lines):
    return [".nf", *(roff(line) for line in lines), ".fi"]


def title(name, section, version):
    return f'.TH {name.upper()} {section} "" "Talus {version}" "Talus"'


def closing(name, section, pages):
    """What every page ends on; `pages` are the programs that have one."""
    others = [page for page in [*(f"{p}(1)" for p in pages), "talus-recipe(5)"] if page != f"{name}({section})"]
    return [".SH REPORTING BUGS", "The file CONTRIBUTING.md of the sources says where, and what a report should hold.",
            ".SH SEE ALSO", *(re.sub(r"(.*)\((\d)\)", r".BR \1 (\2)", page) for page in others), ".SH COPYRIGHT",
            "The Talus authors. GNU General Public License, version 3 or later."]


def synopsis(name, items):
    """The program's options in groups, as its table has them."""
    words = [f"\\fB{roff(name)}\\fR"]
    for item in items["Positionals"]:
        shown = f"\\fI{roff(item.value or item.names[0])}\\fR"
        words.append(shown if item.required else f"[{shown}]")
    words.append("[\\fIoptions\\fR]")
    return " ".join(words)


def man_page(top, subcommands, asked):
    lines = ['.\\" Made by tools/make-manuals.py from --help; changes here are lost.',
             title(top.name, 1, asked.version),
             ".SH NAME", f"{roff(top.name)} \\- {roff(top.summary.rstrip('.'))}", ".SH SYNOPSIS",
             synopsis(top.name, top.items)]
    for sub in subcommands:
        lines += [".br", synopsis(sub.name, sub.items)]
    if top.items["Positionals"]:
        lines += [".SH ARGUMENTS", *roff_items(top.items["Positionals"])]
    lines += [".SH OPTIONS", *roff_items(top.items["Options"])]
    for sub in subcommands:
        lines += [f".SH {sub.name.upper()}", roff(sub.summary)]
        lines += roff_items(sub.items["Positionals"]) + roff_items(sub.items["Options"])
    for heading, text in top.paragraphs():
        heading = {"Exit codes": "EXIT STATUS", None: "DESCRIPTION OF OUTPUT"}.get(heading, (heading or "").upper())
        lines.append(f".SH {heading}")
        lines += roff_example(text) if heading == "EXAMPLES" else [roff(line) for line in text]
    return "\n".join(lines + closing(top.name, 1, asked.pages)) + "\n"


def bash_reply(item):
    """What completes the value of an item, as a line of bash; nothing where only the user knows."""
    value = item.value.strip("[]")
    if item.choices:
        return f"mapfile -t COMPREPLY < <(compgen -W '{' '.join(item.choices)}' -- \"$current\")"
    if value == "DIR":
        return 'mapfile -t COMPREPLY < <(compgen -d -- "$current")'
    if value.endswith(".toml"):
        return ('mapfile -t COMPREPLY < <(compgen -f -X \'!*.toml\' -- "$current"; compgen -d -- "$current")')
    if value == "FILE":
        return 'mapfile -t COMPREPLY < <(compgen -f -- "$current")'
    return ""


def bash_options(indent, page):
    """The cases of one command: values of the option before, names of options, else what its arguments take."""
    lines = [f"{indent}case $previous in"]
    for item in page.items["Options"]:
        if item.value:
            reply = bash_reply(item)
            end = "" if item.value.startswith("[") else "return"
            body = "; ".join(part for part in (reply, end) if part)
            lines.append(f"{indent}  {'|'.join(item.names)}) {body or ':'} ;;")
    names = " ".join(name for item in page.items["Options"] for name in item.names)
    lines += [f"{indent}esac", f"{indent}if [[ $current == -* ]]; then",
              f"{indent}  mapfile -t COMPREPLY < <(compgen -W '{names}' -- \"$current\")"]
    rest = [reply for item in page.items["Positionals"] for reply in [bash_reply(item)] if reply]
    if rest:
        lines += [f"{indent}elif [[ ${{#COMPREPLY[@]}} -eq 0 ]]; then", f"{indent}  {rest[0]}"]
    return lines + [f"{indent}fi"]


def bash_completion(top, subcommands):
    function = "_" + re.sub(r"\W", "_", top.name)
    lines = ["# Made by tools/make-manuals.py from --help; changes here are lost.", f"{function}() {{",
             "  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]}", "  COMPREPLY=()"]
    if subcommands:
        names = " ".join(sub.name.split()[-1] for sub in subcommands)
        lines += ["  case ${COMP_WORDS[1]} in"]
        for sub in subcommands:
            lines += [f"    {sub.name.split()[-1]})", "      if [[ $COMP_CWORD -gt 1 ]]; then"]
            lines += bash_options("        ", sub) + ["        return", "      fi", "      ;;"]
        lines += ["  esac", "  if [[ $COMP_CWORD -eq 1 && $current != -* ]]; then",
                  f"    mapfile -t COMPREPLY < <(compgen -W '{names}' -- \"$current\")", "    return", "  fi"]
    lines += bash_options("  ", top) + ["}", f"complete -o filenames -o default -F {function} {top.name}"]
    return "\n".join(lines) + "\n"


def zsh_value(item):
    value = item.value.strip("[]")
    if item.choices:
        return f":{value.replace(':', '')}:({' '.join(item.choices)})"
    action = {"DIR": "_files -/", "FILE": "_files", "recipe.toml": '_files -g "*.toml"'}.get(value, " ")
    return f":{re.sub('[^A-Za-z.]', '', value) or 'value'}:{action}"


def zsh_arguments(page):
    def quoted(text):
        return "'" + text.replace("'", "'\\''") + "'"

    lines = []
    for item in page.items["Options"]:
        text = re.sub(r"([\[\]:])", r"\\\1", item.text)
        value = zsh_value(item) if item.value else ""
        if item.value.startswith("["):
            value = ":" + value
        for name in item.names:
            others = f"({' '.join(item.names)})" if len(item.names) > 1 else ""
            lines.append(quoted(f"{others}{name}[{text}]{value}"))
    for place, item in enumerate(page.items["Positionals"], 1):
        lines.append(quoted(f"{place}{zsh_value(item)}"))
    return lines


def zsh_completion(top, subcommands):
    lines = [f"#compdef {top.name}", "# Made by tools/make-manuals.py from --help; changes here are lost."]
    if subcommands:
        names = " ".join(sub.name.split()[-1] for sub in subcommands)
        lines += [f"if (( CURRENT == 2 )); then compadd {names}; fi", "case $words[2] in"]
        for sub in subcommands:
            lines += [f"  {sub.name.split()[-1]})", "    shift words; (( CURRENT-- ))",
                      "    _arguments -s \\", " \\\n".join("      " + word for word in zsh_arguments(sub)), "    ;;"]
        lines += ["  *)", "    _arguments -s \\", " \\\n".join("      " + w for w in zsh_arguments(top)), "    ;;",
                  "esac"]
    else:
        lines += ["_arguments -s \\", " \\\n".join("  " + word for word in zsh_arguments(top))]
    return "\n".join(lines) + "\n"


def recipe_page(asked):
    """talus-recipe(5): the stages' templates as they print them."""
    lines = ['.\\" Made by tools/make-manuals.py from --template; changes here are lost.',
             title("talus-recipe", 5, asked.version),
             ".SH NAME", "talus\\-recipe \\- one TOML file that drives the stages", ".SH DESCRIPTION",
             "Each stage reads its own table and [scene]. Below stands every key with its default, its range and its",
             "meaning, as the stage prints it (\\fB\\-\\-template\\fR)."]
    for program in asked.programs:
        run = subprocess.run([str(program), "--template"], capture_output=True, text=True, check=True)
        table = program.name.removeprefix("talus-").upper()
        lines += [f".SH {table}", *roff_example(run.stdout.splitlines())]
    return "\n".join(lines + closing("talus-recipe", 5, asked.pages)) + "\n"


def write(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    if path.parent.name == "man":   # as man pages are installed; no date in it, so that it is the same every time
        path.with_name(path.name + ".gz").write_bytes(gzip.compress(text.encode(), 9, mtime=0))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("programs", nargs="+", type=pathlib.Path)
    parser.add_argument("--recipe", action="store_true")
    parser.add_argument("--to", type=pathlib.Path, required=True)
    parser.add_argument("--version", required=True)
    parser.add_argument("--pages", nargs="*", default=[], help="programs that have a page, for SEE ALSO")
    asked = parser.parse_args()
    if asked.recipe:
        write(asked.to / "man/talus-recipe.5", recipe_page(asked))
        return
    for program in asked.programs:
        top = read_help(program)
        subcommands = [read_help(program, item.names[0]) for item in top.items["Subcommands"]]
        write(asked.to / f"man/{program.name}.1", man_page(top, subcommands, asked))
        write(asked.to / f"bash/{program.name}", bash_completion(top, subcommands))
        write(asked.to / f"zsh/_{program.name}", zsh_completion(top, subcommands))


if __name__ == "__main__":
    main()
