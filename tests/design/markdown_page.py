# SPDX-License-Identifier: GPL-3.0-or-later
"""A Markdown page, taken apart for pages.py: headings, links, commands in sentences, and fenced blocks."""
import os
import re
from typing import NamedTuple


class Link(NamedTuple):
    line: int
    is_picture: bool
    text: str
    target: str


class Block:
    def __init__(self, line, fence, info):
        words = info.split()
        self.line, self.fence, self.language, self.marks = line, fence, words[0] if words else "", words[1:]
        self.lines = []

    def text(self):
        return "".join(line + "\n" for line in self.lines)

    def value(self, key, default=None):
        """Of a mark `key=value`."""
        return next((mark[len(key) + 1:] for mark in self.marks if mark.startswith(key + "=")), default)


def slug(heading, seen):
    """An anchor as GitHub makes it."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).strip().lower()
    text = re.sub(r"[^\w\- ]", "", text).replace(" ", "-")
    seen[text] = seen.get(text, -1) + 1
    return text if seen[text] == 0 else f"{text}-{seen[text]}"


class Page:
    def __init__(self, root, path):
        self.path, self.anchors, self.links, self.blocks, self.commands = path, set(), [], [], []
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
        self.is_closed = block is None
        self.read_prose(prose)

    def read_prose(self, prose):
        """Commands and links may continue in the next line; code in a sentence is no link."""
        text = "".join(f"{line}\n" for _, line in prose)
        for code in re.finditer(r"`(twinbox [^`]*)`", text):
            self.commands.append((prose[text.count("\n", 0, code.start())][0], code[1]))
        text = re.sub(r"`[^`\n]*`", lambda code: " " * len(code[0]), text)
        for found in re.finditer(r"(!?)\[([^\]]*)\]\(([^)\s]+)\)|<(?:a|img)\s[^>]*>", text):
            number = prose[text.count("\n", 0, found.start())][0]
            if found[3]:
                self.links.append(Link(number, found[1] == "!", found[2], found[3]))
                continue
            values = dict(re.findall(r'(\w+)="([^"]*)"', found[0]))
            target = values.get("src", values.get("href", ""))
            self.links.append(Link(number, "src" in values, values.get("alt", ""), target))
