#!/usr/bin/env python3
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Holds the documents to their style, and citations to the bibliography.

usage: tools/check-style.py sentences|words|citations [ROOT]

sentences  in every page for readers (README, docs without the log, scenes, samples): half of the sentences at most have
           25 words or more, and no paragraph or item of a list has 120 words. Tables, code and equations do not count.
words      no page for readers and no decision speaks of how the project is run ("goal", "session", "sprint", ...)
citations  every "Author Year" of pages and sources stands in docs/reference/bibliography.md
Each fault is said with its place and how to mend it; exit code 1 if there are any.
"""
import pathlib
import re
import statistics
import subprocess
import sys
import unicodedata

LONG_SENTENCE, LONG_PARAGRAPH = 25, 120
FOR_READERS = re.compile(r"(README|docs/(index|(tutorials|how-to|reference|explanation)/[\w-]+)|"
                         r"pipelines/[\w-]+/README|data_samples/README)\.md$")
DECISIONS = re.compile(r"docs/decisions/[\w-]+\.md$")
INTERNAL = re.compile(r"\b(goals?|sprints?|sessions?|backlog|milestones?|(?:this|the|that) issue|issue text|the brief|"
                      r"(?:we|was) asked to|task list|co-worker|workers? land)\b", re.I)
NAME = r"(?:(?:de|van|von|der|du|Mc) ?)*[A-ZÅÄÖÜÉ][\w'’-]+"
CITED = re.compile(rf"({NAME})(?:(?:,? {NAME})*,? (?:&|and) {NAME}(?: {NAME})*| et al\.?|'s)?,? "
                   r"\(?((?:18|19|20)\d\d)[a-z]?\b")
# Names before a year that are no authors: events, months, standards, software.
NO_AUTHORS = set("""January February March April May June July August September October November December Slide Xinmo
Cascade Range System GRS WGS CPU GPU In Until Since Of By On Before After Commit Version Debian Ubuntu Studio
Visual CMake H200 Bingham Alps Event Frank Washington Table Figure Copyright Unreleased The And From Today Day Mar Apr
Jun Jul Aug Sep Oct Nov Dec Jan Feb Fig Turtle ISO UTC Part Tonga AD IEEE""".split())
SOURCES = (".md", ".hpp", ".cpp", ".cu", ".py", ".toml", ".js", ".sh")


def files_of(root):
    run = subprocess.run(["git", "-C", str(root), "ls-files", "--cached", "--others", "--exclude-standard"],
                         capture_output=True, text=True, check=False)
    if run.returncode == 0:
        names = run.stdout.splitlines()
    else:
        names = [str(p.relative_to(root)) for p in root.rglob("*") if p.is_file()]
    return [n for n in names if not n.startswith(("build", "tests/golden")) and (root / n).is_file()]


def blocks(text):
    """(line, prose) of every paragraph and item of a list; code, tables, headings and indented equations left out."""
    found, lines, start, fenced = [], [], 0, False
    for number, line in enumerate([*text.splitlines(), ""], 1):
        bare = line.strip()
        if bare.startswith("```"):
            fenced = not fenced
        item = re.match(r"\s*([-*]|\d+\.) ", line)
        other = fenced or not bare or bare.startswith(("```", "|", "#", "<!--")) or re.match(r"\[[^\]]+\]: ", bare)
        if (other or item) and lines:
            found.append((start, " ".join(lines)))
            lines = []
        if not other and (lines or not line.startswith("    ") or item):
            start = start if lines else number
            lines.append(re.sub(r"^([-*]|\d+\.) ", "", bare))
    return found


def plain(prose):
    """Words as they are read: links by their text, code as one word, no marks."""
    prose = re.sub(r"!\[[^\]]*\]\([^)]*\)", "", prose)
    prose = re.sub(r"\[([^\]]*)\](\([^)]*\)|\[[^\]]*\])?", r"\1", prose)
    prose = re.sub(r"`[^`]*`", "code", prose)
    return re.sub(r"[*_]{1,2}", "", prose)


def words_of(sentence):
    return re.findall(r"[^\W_][\w'’.,/-]*", sentence)


def sentences_of(prose):
    return [s for s in re.split(r"(?<=[.!?:;])\s+(?=[A-ZÄÖÜ0-9*(\"])|(?<=[.!?])\s+(?=code)", plain(prose))
            if words_of(s)]


def check_sentences(root):
    faults, pages = [], 0
    for name in files_of(root):
        if not FOR_READERS.search(name):
            continue
        pages += 1
        lengths, longest = [], (0, "", 0)
        for line, prose in blocks((root / name).read_text(encoding="utf-8")):
            count = len(words_of(plain(prose)))
            if count >= LONG_PARAGRAPH:
                faults.append(f"{name}:{line}: a paragraph of {count} words, fewer than {LONG_PARAGRAPH} are asked for "
                              f"(it begins '{prose[:60]}'). Divide it by an empty line, or make a list of it")
            for sentence in sentences_of(prose):
                lengths.append(len(words_of(sentence)))
                longest = max(longest, (lengths[-1], sentence[:70], line))
        if len(lengths) >= 5 and statistics.median(lengths) >= LONG_SENTENCE:
            faults.append(f"{name}: half of its {len(lengths)} sentences have {statistics.median(lengths):.0f} "
                          f"words or more, fewer than {LONG_SENTENCE} are asked for. Divide long ones; the longest, "
                          f"line {longest[2]}, has {longest[0]}: '{longest[1]}...'")
    return faults, f"{pages} pages"


def check_words(root):
    faults, pages = [], 0
    for name in files_of(root):
        if not (FOR_READERS.search(name) or DECISIONS.search(name)):
            continue
        pages += 1
        for number, line in enumerate((root / name).read_text(encoding="utf-8").splitlines(), 1):
            for word in INTERNAL.finditer(line):
                faults.append(f"{name}:{number}: '{word.group(0)}' speaks of how the project is run. Say what holds "
                              "for the reader: a bound, a tolerance, what was measured")
    return faults, f"{pages} pages"


def folded(name):
    """One spelling of a name: Kääb, Kaeaeb and Kaab are one author."""
    text = unicodedata.normalize("NFKD", name.replace("ß", "ss")).encode("ascii", "ignore").decode().lower()
    return re.sub(r"(?<=[aou])e", "", text.replace("'", ""))


def listed_works(root):
    """(first author, year) of every entry: '- Surname, I., & Other, J. (1999). Title. ...'."""
    text = (root / "docs/reference/bibliography.md").read_text(encoding="utf-8")
    entries = re.findall(r"^- (?:<a[^>]*></a>)?([^,(]+?)(?:,[^(]*?)? ?\((\d{4})[a-z]?\)", text, re.M)
    return {(folded(author.split()[-1]), year) for author, year in entries}


def joined(text):
    """Lines of a comment or paragraph as one, so that a citation may cross them."""
    return re.sub(r"\s*\n[ \t]*(///?<?|#|\*|//!)?[ \t]*", " ", text)


def check_citations(root):
    works, faults, count = listed_works(root), {}, 0
    for name in files_of(root):
        if not name.endswith(SOURCES) or name.endswith("bibliography.md") or name.startswith("docs/log/"):
            continue
        for cited in CITED.finditer(joined((root / name).read_text(encoding="utf-8", errors="replace"))):
            whole, year = cited.group(0), cited.group(2)
            first = cited.group(1).split()[-1]
            before_year = re.findall(r"[^\W\d_][\w'-]*", whole)[-1].removesuffix("'s")
            if first in NO_AUTHORS or before_year in NO_AUTHORS or first.isupper() and len(first) > 1:
                continue
            count += 1
            if (folded(first.removesuffix("'s")), year) not in works:
                faults.setdefault(whole.replace("(", ""), name)
    said = [f"{name}: '{whole}' is cited and is not in docs/reference/bibliography.md. Add an entry there: '- Author, "
            "I. (Year). Title. *Journal* volume, pages. https://doi.org/...', the DOI only where it was looked up"
            for whole, name in sorted(faults.items())]
    return said, f"{count} citations of {len(works)} works"


def main():
    checks = {"sentences": check_sentences, "words": check_words, "citations": check_citations}
    if len(sys.argv) not in (2, 3) or sys.argv[1] not in checks:
        sys.exit(__doc__)
    root = pathlib.Path(sys.argv[2]) if len(sys.argv) == 3 else pathlib.Path(__file__).resolve().parent.parent
    faults, looked = checks[sys.argv[1]](root)
    if faults:
        sys.exit("\n".join(faults))
    print(f"{looked}: no fault")


if __name__ == "__main__":
    main()
