#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks the Markdown pages of the repository.

    pages.py TWINBOX SOURCES [blocks]

- Every page can be reached from README.md. Every relative link, picture and anchor exists in a fresh clone.
- README.md keeps its limits.
- Every file of src, tests, scenes, golden or shaders that a page names exists, or a block of the page writes it. NAME,
  ROOM, COMMAND and WHAT stand for any text. So does every test that a page names, every source that it names without
  its folder, and every name of C, such as `scene_read`, that the pages of src and tests have.
- Every option after `twinbox COMMAND` in a shell block or a sentence is one of that command. (Examples of --help: cli/examples.)
- With `blocks`, marked blocks run instead, page by page from top to bottom, in a fresh copy of the sources with twinbox on
  PATH, as a user would type them. The marks are words after the language of a block and are invisible when rendered:

      ```sh quick            is run by bash and must succeed
      ```sh quick status=1   must end with this status
      ```python quick        is run by Python, without warnings
      ```yaml file=NAME      is written to a file; so is any other language
      ```text output         is the output of the block before: "..." is any text or lines, times are not compared

  README.md is typed in an empty folder instead, with twinbox installed: its marked blocks and every `twinbox ...` in its
  sentences and tables, but those with a word in capitals and those that its page follows by "(minutes)" or "(hours)".
"""
import fnmatch
import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile
import urllib.parse

from markdown_page import Page

README_LINES, README_WORDS = 150, 1300
NOT_IN_A_CLONE = {".git", "build", "out", "node_modules"}
PLACEHOLDER = re.compile("NAME|ROOM|COMMAND|WHAT")
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
            if file.endswith(".md"):
                yield os.path.relpath(os.path.join(folder, file), root)


pages = {path: Page(root, path) for path in find_pages()}


def check_link(page, link):
    """Returns the path that it leads to."""
    place, target = f"{page.path}:{link.line}", link.target
    if re.match(r"[a-z]+:", target):
        check(target.startswith("https://"), place, f"'{target}' is not an https link")
        return None
    check(not link.is_picture or len(link.text) > 10, place, f"the picture {target} has no description")
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
    targets = {path: {check_link(page, link) for link in page.links} for path, page in pages.items()}
    while new:
        reached |= new
        new = {target for path in new for target in targets[path] if target in pages} - reached
    for path in pages:
        check(path in reached, path, "no link leads from README.md to this page")


def check_blocks_end():
    for page in pages.values():
        check(page.is_closed, page.path, "a block has no end")


def check_readme():
    lines = pages["README.md"].lines
    words = sum(len(line.split()) for line in lines)
    check(len(lines) - 1 <= README_LINES, "README.md", f"{len(lines) - 1} lines, at most {README_LINES} are allowed")
    check(words <= README_WORDS, "README.md", f"{words} words, at most {README_WORDS} are allowed")


def read_sources():
    """The names of all files, and the words with an underscore in them and in sources."""
    names, words = set(), set()
    for top in ("src", "tests", "golden", "scenes", "shaders"):
        for folder, _, files in os.walk(os.path.join(root, top)):
            names.update(files)
            for file in files:
                words.add(file.split(".")[0])
                if file.endswith((".c", ".h", ".py", ".sh", ".cmake", ".txt")):
                    with open(os.path.join(folder, file), encoding="utf-8") as source:
                        words.update(re.findall(r"[a-z]+(?:_[a-z]+)+", source.read()))
    return names, words


file_names, words_of_code = read_sources()


def check_names(page, number, line):
    place = f"{page.path}:{number}"
    for name in re.findall(r"`([\w*]+\.(?:c|h|py|sh|cmake))`", line):
        check(fnmatch.filter(file_names, PLACEHOLDER.sub("*", name)), place, f"there is no {name}")
    for word in re.findall(r"`([a-z]+(?:_[a-z]+)+)(?:\(\))?`", line) if page.path.startswith(("src/", "tests/")) else []:
        check(word in words_of_code, place, f"no source has {word}")


def check_paths(page):
    written = {block.value("file") for block in page.blocks}
    for number, line in enumerate(page.lines, 1):
        for path in re.findall(r"(?<![\w/.-])(?:src|tests|scenes|golden|shaders)/[\w./*-]*[\w*]", line):
            known = path in written or glob.glob(os.path.join(root, PLACEHOLDER.sub("*", path)))
            check(known, f"{page.path}:{number}", f"there is no {path}")
        check_names(page, number, line)
        for folder, what in re.findall(r"`([a-z_]+)/([a-z_]+)`", line):
            if os.path.isdir(os.path.join(root, "tests", folder)) and not os.path.exists(os.path.join(root, folder)):
                known = glob.glob(os.path.join(root, "tests", folder, f"test_{what}.*"))
                check(known, f"{page.path}:{number}", f"there is no test {folder}/{what}")


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


def check_commands(page):
    """In sentences and in blocks."""
    for number, command in page.commands:
        check_options(f"{page.path}:{number}", command.replace("\n", " "))
    for block in page.blocks:
        if block.language == "sh":
            check_options(f"{page.path}:{block.line}", block.text())


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
    shell = ["bash", "-c", f"set -e -o pipefail\n{text}"]
    command = shell if block.language == "sh" else ["/usr/bin/python3", "-c", text]
    done = subprocess.run(command, cwd=folder, env=environment, stdin=subprocess.DEVNULL, capture_output=True,
                          text=True)
    check(done.returncode == status, place,
          f"exit status {done.returncode}, not {status}: {(done.stderr + done.stdout)[-800:]}")
    check(block.language != "python" or not done.stderr, place, f"warnings: {done.stderr}")
    return done.stdout if status < 2 else done.stdout + done.stderr


def run_blocks(page, folder):
    printed = None
    for block in page.blocks:
        place = f"{page.path}:{block.line}"
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


def typed_lines(page):
    """(line, command) from top to bottom."""
    blocks = {block.line: block.text() for block in page.blocks if "quick" in block.marks}
    inside = {number for block in page.blocks for number in range(block.line, block.line + len(block.lines) + 2)}
    for number, line in enumerate(page.lines, 1):
        if number in blocks:
            yield number, blocks[number]
        elif number not in inside:
            for command, behind in re.findall(r"`(twinbox [^`]*)`( \((?:minutes|hours)\))?", line):
                if not behind and not re.search(r"\b[A-Z]{2,}\b", command):
                    yield number, command


def type_readme():
    with tempfile.TemporaryDirectory() as folder:
        program, empty = f"{folder}/prefix/bin/twinbox", f"{folder}/empty"
        os.mkdir(empty)
        subprocess.run(["cmake", "--install", os.path.dirname(twinbox), "--prefix", f"{folder}/prefix"], check=True, capture_output=True)
        environment = {**os.environ, "PATH": f"{os.path.dirname(program)}:{os.environ['PATH']}"}
        for number, command in typed_lines(pages["README.md"]):
            done = subprocess.run(["bash", "-ec", command], cwd=empty, env=environment, stdin=subprocess.DEVNULL, capture_output=True,
                                  text=True)
            if "this build has no module for live pages" in done.stderr:
                continue
            status = 1 if command.startswith("twinbox compare") else 0  # the runs differ
            check(done.returncode == status, f"README.md:{number}",
                  f"{command}: exit status {done.returncode}: {(done.stderr + done.stdout)[-800:]}")


def check_blocks():
    type_readme()
    for page in pages.values():
        if page.path != "README.md" and any(block.marks for block in page.blocks):
            with tempfile.TemporaryDirectory() as folder:
                clone = os.path.join(folder, "twinbox")
                shutil.copytree(root, clone, ignore=lambda _, names: NOT_IN_A_CLONE & set(names))
                run_blocks(page, clone)


def check_pages():
    check_blocks_end()
    check_links()
    check_readme()
    for page in pages.values():
        check_paths(page)
        check_commands(page)


check_blocks() if sys.argv[3:] == ["blocks"] else check_pages()
print(f"{len(pages)} pages, {checks} checks, {failures} failures")
sys.exit(failures > 0)
