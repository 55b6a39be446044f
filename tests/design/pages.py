#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks the Markdown pages of the repository.

    pages.py TWINBOX SOURCES

- Every page can be reached from README.md. Every relative link, picture and anchor exists in a fresh clone.
- README.md keeps its limits.
- Every file of src, tests, scenes, golden or shaders that a page names exists, or a block of the page writes it. NAME,
  FOLDER, COMMAND and WHAT stand for any text.
- Every option after `twinbox COMMAND` in a shell block or a sentence, or in an example of its
  help, is one of that command.
- Marked blocks run, page by page from top to bottom, in a fresh copy of the sources with twinbox on PATH, as a user
  would type them. The marks are words after the language of a block and are invisible when rendered:

      ```sh quick            is run by bash and must succeed
      ```sh quick status=1   its last command must end with this status
      ```python quick        is run by Python
      ```yaml file=NAME      is written to a file; so is any other language
      ```text output         is the output of the block before; "..." stands for any text or lines, and times are not compared
"""
import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile
import urllib.parse

README_LINES, README_WORDS = 150, 1300
NOT_IN_A_CLONE = {".git", "build", "out"}
TEMPLATE = "src/paper/report/report.md"  # its links are to files beside the report that is made of it
PLACEHOLDER = re.compile("NAME|FOLDER|COMMAND|WHAT")
TIME = re.compile(r"\d[\d.]*(e[+-]?\d+)?( ?(ns|µs|us|ms|s|min)\b)")

twinbox, root = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
failures = checks = 0


def check(ok, place, message):
    global failures, checks
    checks += 1
    if not ok:
        failures += 1
        print(f"{place}: {message}")


def find_pages():
    for folder, names, files in os.walk(root):
        names[:] = sorted(name for name in names if name not in NOT_IN_A_CLONE)
        for file in sorted(files):
            path = os.path.relpath(os.path.join(folder, file), root)
            if path.endswith(".md") and path != TEMPLATE:
                yield path


class Block:
    def __init__(self, line, fence, info):
        words = info.split()
        self.line, self.fence, self.language, self.marks = line, fence, words[0] if words else "", words[1:]
        self.lines = []

    def text(self):
        return "".join(line + "\n" for line in self.lines)

    def value(self, key, default=None):
        return next((mark[len(key) + 1:] for mark in self.marks if mark.startswith(key + "=")), default)


def slug(heading, seen):
    """An anchor as GitHub makes it."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).strip().lower()
    text = re.sub(r"[^\w\- ]", "", text).replace(" ", "-")
    seen[text] = seen.get(text, -1) + 1
    return text if seen[text] == 0 else f"{text}-{seen[text]}"


class Page:
    """Headings, links and blocks of a page."""

    def __init__(self, path):
        self.path, self.anchors, self.links, self.blocks = path, set(), [], []
        block, seen, prose = None, {}, []
        with open(os.path.join(root, path), encoding="utf-8") as file:
            self.lines = file.read().split("\n")
        for number, line in enumerate(self.lines, 1):
            fence = re.match(r" *(```+)(.*)", line)
            if fence and block is None:
                block = Block(number, fence[1], fence[2])
                self.blocks.append(block)
            elif fence and fence[1] >= block.fence and not fence[2].strip():
                block = None
            elif block is not None:
                block.lines.append(line)
            else:
                if heading := re.match(r"#+ (.*)", line):
                    self.anchors.add(slug(heading[1], seen))
                prose.append((number, line))
        check(block is None, path, "a block has no end")
        self.find_links(prose)

    def find_links(self, prose):
        # Links may break over lines; code in a sentence is no link.
        text = "".join(f"{line}\n" for _, line in prose)
        self.commands = [(prose[text.count("\n", 0, code.start())][0], code[1])
                         for code in re.finditer(r"`(twinbox [^`]*)`", text)]
        text = re.sub(r"`[^`\n]*`", lambda code: " " * len(code[0]), text)
        for link in re.finditer(r"(!?)\[([^\]]*)\]\(([^)\s]+)\)|<(?:a|img)\s[^>]*>", text):
            number = prose[text.count("\n", 0, link.start())][0]
            if link[3]:
                self.links.append((number, link[1] == "!", link[2], link[3]))
                continue
            values = dict(re.findall(r'(\w+)="([^"]*)"', link[0]))
            self.links.append((number, "src" in values, values.get("alt", ""), values.get("src", values.get("href", ""))))


pages = {path: Page(path) for path in find_pages()}


def check_link(page, line, picture, text, target):
    place = f"{page.path}:{line}"
    if re.match(r"[a-z]+:", target):
        check(target.startswith("https://"), place, f"'{target}' is not an https link")
        return None
    check(not picture or len(text) > 10, place, f"the picture {target} has no description")
    file, _, anchor = urllib.parse.unquote(target).partition("#")
    path = os.path.normpath(os.path.join(os.path.dirname(page.path), file)) if file else page.path
    inside = not path.startswith("..") and path.split(os.sep)[0] not in NOT_IN_A_CLONE
    check(inside and os.path.exists(os.path.join(root, path)), place, f"'{target}' does not exist")
    if os.path.isdir(os.path.join(root, path)) and os.path.join(path, "README.md") in pages:
        path = os.path.join(path, "README.md")
    if anchor and path in pages:
        check(anchor in pages[path].anchors, place, f"{path} has no heading for '#{anchor}'")
    return path


def check_links():
    reached, new = set(), {"README.md"}
    targets = {path: {check_link(page, *link) for link in page.links} for path, page in pages.items()}
    while new:
        reached |= new
        new = {target for path in new for target in targets[path] if target in pages} - reached
    for path in pages:
        check(path in reached, path, "no link leads from README.md to this page")


def check_readme():
    lines = pages["README.md"].lines
    words = sum(len(line.split()) for line in lines)
    check(len(lines) - 1 <= README_LINES, "README.md", f"{len(lines) - 1} lines, at most {README_LINES} are allowed")
    check(words <= README_WORDS, "README.md", f"{words} words, at most {README_WORDS} are allowed")


def check_paths(page):
    written = {block.value("file") for block in page.blocks}
    for number, line in enumerate(page.lines, 1):
        for path in re.findall(r"(?<![\w/.-])(?:src|tests|scenes|golden|shaders)/[\w./*-]*[\w*]", line):
            known = path in written or glob.glob(os.path.join(root, PLACEHOLDER.sub("*", path)))
            check(known, f"{page.path}:{number}", f"there is no {path}")


helps = {}


def options_of(command):
    if command not in helps:
        done = subprocess.run([twinbox, command, "--help"], capture_output=True, text=True)
        known = done.returncode == 0
        words = re.findall(r"(?<![\w-])--?[a-z][\w-]*", done.stdout.partition("Example:")[0])
        helps[command] = set(words) if known else None
    return helps[command]


def check_options(place, text):
    """Of commands, which may go on in the next line after a backslash."""
    for line in text.replace("\\\n", " ").split("\n"):
        for call in re.finditer(r"(?:^|[/\s(])twinbox ([a-z]+)\b([^|;&]*)", line.split(" #")[0]):
            known = options_of(call[1])
            check(known is not None, place, f"there is no command 'twinbox {call[1]}'")
            for option in re.findall(r"(?<=\s)--?[a-z][\w-]*", call[2]) if known else []:
                check(option in known, place, f"twinbox {call[1]} has no option {option}")


def check_examples():
    """Of the help of all commands, in lines that are not wrapped."""
    environment = {**os.environ, "ARGP_HELP_FMT": "rmargin=1000"}
    listed = subprocess.run([twinbox, "--help"], capture_output=True, text=True).stdout
    for command in re.findall(r"^  ([a-z]+) ", listed, re.MULTILINE):
        done = subprocess.run([twinbox, command, "--help"], env=environment, capture_output=True, text=True)
        check_options(f"twinbox {command} --help", done.stdout.partition("Example:")[2])


def is_output(shown, printed):
    """Whether the lines are those printed; "..." stands for any text, alone in a line for any lines."""
    if not shown:
        return not printed
    if shown[0].strip() == "...":
        return any(is_output(shown[1:], printed[i:]) for i in range(len(printed) + 1))
    pattern = ".*".join(re.escape(part) for part in shown[0].split("..."))
    return bool(printed) and re.fullmatch(pattern, printed[0]) is not None and is_output(shown[1:], printed[1:])


def lines_without_times(text):
    return [TIME.sub(r"TIME\2", line).rstrip() for line in text.rstrip("\n").split("\n")]


def run(place, block, folder):
    """Returns what the block prints."""
    status = int(block.value("status", "0"))
    environment = {**os.environ, "PATH": f"{os.path.dirname(twinbox)}:{os.environ['PATH']}"}
    text = block.text()
    command = ["bash", "-c", f"set -e -o pipefail\n{text}"] if block.language == "sh" else ["/usr/bin/python3", "-c", text]
    done = subprocess.run(command, cwd=folder, env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    check(done.returncode == status, place,
          f"exit status {done.returncode}, not {status}: {(done.stderr + done.stdout)[-800:]}")
    check(block.language != "python" or not done.stderr, place, f"warnings: {done.stderr}")
    return done.stdout if status < 2 else done.stdout + done.stderr


def run_blocks(page, folder):
    printed = None
    for number, command in page.commands:
        check_options(f"{page.path}:{number}", command.replace("\n", " "))
    for block in page.blocks:
        place = f"{page.path}:{block.line}"
        if block.language == "sh":
            check_options(place, block.text())
        if name := block.value("file"):
            path = os.path.normpath(os.path.join(folder, name))
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, "w", encoding="utf-8") as file:
                file.write(block.text())
        if "quick" in block.marks:
            check(block.language in ("sh", "python"), place, f"'{block.language}' cannot be run")
            printed = run(place, block, folder)
        if "output" in block.marks:
            shown = lines_without_times(block.text())
            check(printed is not None and is_output(shown, lines_without_times(printed)), place,
                  f"the output is another:\n{printed}")


def check_blocks():
    for page in pages.values():
        with tempfile.TemporaryDirectory() as folder:
            clone = os.path.join(folder, "twinbox")
            if any(block.marks for block in page.blocks):
                shutil.copytree(root, clone, ignore=lambda _, names: NOT_IN_A_CLONE & set(names))
            run_blocks(page, clone)


check_links()
check_readme()
for page in pages.values():
    check_paths(page)
check_examples()
check_blocks()
print(f"{len(pages)} pages, {checks} checks, {failures} failures")
sys.exit(failures > 0)
