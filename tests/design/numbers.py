#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks that each number of a page comes from somewhere.

    numbers.py SOURCES

- What golden/findings/write writes into the pages of results is what stands there; it mends what differs.
- Every other number in their sentences and tables, and in those of the figures' page, is in given.txt: with the file that it
  comes from, which has it. Code, links, headings, years and ordinals do not count.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile

root = os.path.abspath(sys.argv[1])
RESULTS = ["README.md", "src/studies/README.md"]
PAGES = [*RESULTS, "golden/figures/README.md"]
NUMBER = re.compile(r"(?<![\w.])(?<!\w-)-?\d[\d,]*(?:\.\d+)?(?:e[+-]?\d+)?(?![\w.]*\w)")
YEAR = re.compile(r"(?:18|19|20)\d\d")
failures = 0


def fail(message):
    global failures
    failures += 1
    print(message)


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def write(folder):
    return subprocess.run([f"{root}/golden/findings/write", folder], capture_output=True, text=True)


def check_written():
    with tempfile.TemporaryDirectory() as folder:
        for page in RESULTS:
            os.makedirs(os.path.dirname(f"{folder}/{page}"), exist_ok=True)
        texts = {page: read(f"{root}/{page}") for page in RESULTS}

        def written(change=lambda text: text):
            for page in RESULTS:
                with open(f"{folder}/{page}", "w", encoding="utf-8") as file:
                    file.write(change(texts[page]))
            done = write(folder)
            return done.stderr, {page: read(f"{folder}/{page}") for page in RESULTS}

        for page, text in written()[1].items():
            if text != texts[page]:
                fail(f"{page} has other numbers than golden/findings: run golden/findings/write")
        # A digit of every written number is changed, and a line of every written table lost.
        spoilt = {page: re.sub(r"(<!--\w+-->)[\d.,e+-]*\d", r"\g<1>7777", re.sub(r"(<!-- findings \S+ -->\n\n)(?!<!-- end).*\n", r"\1", text))
                  for page, text in texts.items()}
        if spoilt[RESULTS[1]] == texts[RESULTS[1]] or written(lambda text: spoilt[next(p for p in RESULTS if texts[p] == text)])[1] != texts:
            fail("golden/findings/write does not mend changed numbers")
        for change, message in ((lambda text: text.replace("<!--net_time-->", "<!--no_such-->"), "no number no_such in numbers.txt"),
                                (lambda text: text.replace("<!--net_time-->", ""), "net_time: in no page"),
                                (lambda text: text.replace("findings rates -->", "findings rate -->"), "there are no findings rate")):
            error, kept = written(change)
            if message not in error or kept != {page: change(text) for page, text in texts.items()}:
                fail(f"no '{message}', or a page is changed: {error}")


def loose_numbers(page):
    """(section, number) of those that nothing writes."""
    text = read(f"{root}/{page}")
    for pattern in (r"<!-- findings .*?<!-- end -->", r"^ *(```+).*?^ *\1", r"<!--\w+-->\S+", r"`[^`]*`", r"(?<=\])\([^)]*\)", r"<[^>]*>",
                    r"\bdoi:[^\]]*", r"\*\*\d\. "):
        text = re.sub(pattern, " ", text, flags=re.DOTALL | re.MULTILINE)
    section = ""
    for line in text.split("\n"):
        if heading := re.match(r"#+ (.*)", line):
            section = heading[1]
            continue
        for number in NUMBER.findall(line):
            number = number.rstrip(",")
            if not YEAR.fullmatch(number):
                yield section, number


def value(text):
    try:
        return float(text)
    except ValueError:
        return text  # of a version


def check_given():
    """A line of given.txt: PAGE | SECTION | FILE | NUMBER[=NUMBER in the file]..."""
    given = {}
    for line in read(f"{root}/tests/design/given.txt").splitlines():
        if not line or line[0] == "#":
            continue
        page, section, path, numbers = (part.strip() for part in line.split("|"))
        source = {value(number) for number in re.findall(r"(?<![\w.])-?\d[\d.]*(?:e[+-]?\d+)?", read(f"{root}/{path}"))}
        for number in numbers.split():
            shown, _, there = number.partition("=")
            given.setdefault((page, section), {})[shown] = path
            if value(there or shown) not in source:
                fail(f"given.txt: {path} has no {there or shown} ({page}, {section})")
    for page in PAGES:
        for section, number in loose_numbers(page):
            if number not in given.get((page, section), {}):
                fail(f"{page}: {section}: {number} comes from no file: mark it for golden/findings/write, or give its file in given.txt")
    used = {(page, section, number) for page in PAGES for section, number in loose_numbers(page)}
    for (page, section), numbers in given.items():
        for number in numbers:
            if (page, section, number) not in used:
                fail(f"given.txt: {page}: {section} has no {number}")


check_written()
check_given()
print(f"{sum(1 for page in PAGES for _ in loose_numbers(page))} given numbers, {failures} failures")
sys.exit(failures > 0)
