# SPDX-License-Identifier: GPL-3.0-or-later
"""Pages of runs that are strange, large or hostile (hostile_runs.py): they show what there is, say what there is not, and
run nothing."""
import os
import re
import subprocess

import hostile_runs
import runs
from checks import Checks
from chromium import Chromium
from keys import view

FILE = "it's $(touch owned) `touch owned`; \"x\".npz"
TEXT = "document.getElementById($0).textContent"
HASHES = """(async () => {
  const found = [];
  for (let frame = 0; frame < player.runs[$0].frames; frame++) {
    await player.load(frame);
    found.push(player.state_hash($0, frame));
  }
  return found;
})()"""
FINITE = "Object.values(player.view.camera).every(x => typeof x === 'string' || Number.isFinite(x))"
# Every frame with everything shown, near and far: drawing must not throw, nor leave the canvas empty.
DRAW_ALL = """(async () => {
  const shows = Object.keys(player.data.shows), frames = player.data.frames;
  for (const compare of ["split", "overlay", "difference"])
    for (const frame of new Set([0, (frames - 1) / 2 + 0.25, frames - 1].map(frame => Math.min(frame, frames - 1)))) {
      await player.load(frame);
      player.change({frame, compare, show: new Set(shows), body: player.runs[0].bodies - 1});
      player.draw();
    }
  player.change({frame: 0, compare: "split", show: new Set(), body: -1});
})()"""


class Pages:
    def __init__(self, checks, browser):
        self.checks, self.browser = checks, browser

    def open(self, *names, options=(), **looks):
        """The page of these runs, drawn in all ways."""
        files = [name if name.endswith(".npz") else name + ".npz" for name in names]
        self.checks.twinbox("page", *files, *options, "-o", "page.html")
        page = self.browser.open("page.html", clock=True, **looks)
        page.run(DRAW_ALL)
        page.settle()
        self.checks.quiet(" and ".join(names), page)
        return page

    def names(self):
        """Markup in names is text, wherever it stands."""
        checks = self.checks
        for looks in {}, {"width": 390, "height": 844}:
            page = self.open("names", FILE, **looks)
            checks.equal("pictures in the page", page.run("document.images.length"), 0)
            checks.true("the title", hostile_runs.MARKUP.lower() in page.run("document.title.toLowerCase()"),
                        page.run("document.title"))
            for text in hostile_runs.MARKUP, hostile_runs.COMMENT:
                checks.true(f"'{text}' in the table of runs", text in page.run(TEXT, "runs"),
                            page.run(TEXT, "runs")[:300])
            checks.equal("comments and scripts",
                         page.run("[document.scripts.length, document.createNodeIterator(document, 128).nextNode()]"),
                         [page.run("document.querySelectorAll('script[id], script:not([id])').length"), None])
            page.close()
        page = self.open(FILE)
        page.click(*page.middle("#copy-command"))
        command = page.run("navigator.clipboard.readText()").replace("twinbox ", f"'{checks.program}' ", 1)
        result = subprocess.run(["bash", "-c", command], capture_output=True, text=True, stdin=subprocess.DEVNULL)
        checks.equal(f"exit status of {command}: {result.stderr[:200]}", result.returncode, 0)
        checks.true("the name of a file is no command", not os.path.exists("owned"))
        page.close()

    def letters(self):
        """Letters beyond ASCII, and names as long as they can be."""
        for name in "letters", "most_letters":
            for looks in {}, {"width": 390, "height": 844}:
                page = self.open(name, name, **looks)
                self.checks.true(f"{name}: no wider than the window",
                                 page.run("document.documentElement.scrollWidth <= innerWidth"))
                page.close()

    def worlds(self):
        """Runs that cannot be compared are shown, and the page says why not."""
        checks = self.checks
        page = self.open("plain", "seven")
        checks.true("the summary says so", re.search(r"cannot be compared", page.run(TEXT, "summary")),
                    page.run(TEXT, "summary"))
        checks.equal("bodies", page.run("player.runs.map(run => run.bodies)"), [3, 7])
        checks.equal("panels", page.run("player.plan(900, 600).panels.length"), 2)
        page.run("player.change({compare: 'overlay'})")
        page.settle()
        checks.equal("no overlay of other worlds", view(page)["compare"], "split")
        checks.equal("a body that one run has not", page.run(
            "(plan => player.corners(plan, player.camera(plan, 0), 1, 1, 0, 6).length)(player.plan(900, 600))"), 4)
        page.close()
        page = self.open("stack", "short")
        page.run("player.change({frame: 40})")
        page.settle()
        last = "(f => { const p = player.plan(900, 600); return player.corners(p, player.camera(p, f), 1, 1, f, 5); })"
        checks.equal("a run that has ended keeps its last poses", page.run(last + "(40)"), page.run(last + "(20)"))
        checks.true("and is compared no more",
                    page.run("Number.isNaN(player.runs[1].distances[20]) || player.runs[1].frames === 21"))
        page.close()

    def comings(self):
        """A body is drawn, found and hashed only while it is there."""
        checks, names = self.checks, ("stays", "comes")
        page = self.open(*names)
        for i, name in enumerate(names):
            checks.equal(f"{name}: hashes", page.run(HASHES, i), runs.hashes(runs.load(name + ".npz")))
        there = {1: range(2, 6), 2: range(4), 3: ()}
        for frame in range(6):
            for body, frames in there.items():
                found = page.run("""(() => {
                  const plan = player.plan(900, 600), camera = player.camera(plan, $0), [one, two] = plan.panels;
                  const at = player.corners(plan, camera, 0, 0, $0, $1), right = two.left - one.left, down = two.top - one.top;
                  const mean = axis => at.reduce((sum, p) => sum + p[axis], 0) / 4;
                  const hit = player.body_at(plan, camera, $0, mean("x") + right, mean("y") + down);
                  return hit && hit.run === 1 ? hit.body : -1; })()""", frame, body)
                checks.equal(f"frame {frame}: body {body} where it would be", found, body if frame in frames else -1)
        page.run("player.change({frame: 0, body: 1, run: 1})")
        page.settle()
        checks.true("the measures say that it is not there", re.search(r"\bnot\b", page.run(TEXT, "body")),
                    page.run(TEXT, "body"))
        page.close()

    def no_velocities(self):
        checks, page = self.checks, self.open("plain")
        page.run("player.change({body: 1, show: new Set(['velocities'])})")
        page.settle()
        checks.equal("unknown velocities are not drawn", view(page)["show"], [])
        checks.true("nor measured", "m/s" not in page.run(TEXT, "body"), page.run(TEXT, "body"))
        checks.equal("the check box is disabled", page.run("document.getElementById('show-velocities').disabled"), True)
        page.close()

    def one_frame(self):
        checks, page = self.checks, self.open("one")
        page.press("Space", "ArrowRight", "End", "]", "Home")
        checks.equal("one frame", [view(page)[name] for name in ("frame", "playing")], [0, False])
        checks.quiet("one frame", page)
        page.close()

    def numbers(self):
        for name in "far", "tiny", "wide", "static", "nothing":
            page = self.open(name)
            page.press("+", "-", "f", "n", "b", "End")
            page.wheel(*page.middle("#stage"), -100)
            self.checks.true(f"{name}: the view",
                             page.run(FINITE))
            self.checks.quiet(name, page)
            page.close()

    def many(self):
        checks, page = self.checks, self.open("many")
        page.wait("player.checked().frames === player.checked().of")
        checks.equal("5,000 bodies: wrong hashes", page.run("player.checked().wrong"), 0)
        checks.equal("5,000 bodies", page.run("player.runs[0].bodies"), 5000)
        page.press("ArrowRight", "n", "n")
        checks.equal("5,000 bodies: frame", view(page)["frame"], 1)
        page.close()

    def long(self):
        checks, page = self.checks, self.open("long")
        page.press("End")
        checks.equal("100,000 frames: the last", view(page)["frame"], 99999)
        page.run("location.hash = '#t=1000'")
        page.wait("player.view.frame === 60000")
        page.wait("player.checked().frames === player.checked().of")
        checks.equal("100,000 frames: what was checked", page.run("player.checked()"),
                     {"frames": 100000, "of": 100000, "wrong": 0})
        checks.quiet("100,000 frames", page)
        page.close()

    def parts(self):
        """A part of the frames: their own hashes, times, and a word about the rest."""
        checks, page = self.checks, self.open("stack", options=("--frames", "10:40", "--every", 3))
        wanted = runs.hashes(runs.load("stack.npz"))[10:41:3]
        checks.equal("hashes of every third frame", page.run(HASHES, 0), wanted)
        page.press("ArrowRight")
        checks.true("the time of the second", re.search(r"0\.216|0\.217", page.run(TEXT, "time")),
                    page.run(TEXT, "time"))
        checks.true("its number in the run", "frame 13 of 60" in page.run(TEXT, "time"), page.run(TEXT, "time"))
        words = page.run("document.body.innerText")
        checks.true("what is left out", "10 to 40" in words and re.search(r"frame in 3|3rd frame", words), words[-600:])
        page.run("location.hash = '#t=0.416'")
        page.wait("player.view.frame === 5")
        page.close()

    def damage(self):
        """A page that was cut or changed on its way says so, and throws nothing."""
        self.checks.twinbox("page", "stack.npz", "-o", "whole.html")
        with open("whole.html", encoding="utf-8") as file:
            text = file.read()
        at = text.index('id="s0-0">') + 400
        with open("damaged.html", "w", encoding="utf-8") as file:
            file.write(text[:at] + text[at + 400:])
        page = self.browser.open("damaged.html")
        words = "damaged|cannot be decoded|do not have the hash|not decoded"
        said = page.wait(f"document.body.innerText.match(/[^.\\n]*({words})[^.\\n]*/)?.[0]")
        self.checks.true("a damaged page says so", said, said)
        self.checks.quiet("a damaged page", page)
        page.close()


def main():
    with Checks() as checks, Chromium("!!window.player?.data") as browser:
        browser.allow("clipboardReadWrite", "clipboardSanitizedWrite")
        for name, arrays in hostile_runs.RUNS.items():
            if name not in ("too_long", "many_letters"):
                hostile_runs.save(name, **arrays)
        hostile_runs.save("nothing", **hostile_runs.absent(5, 3, (0, 0, 5), (1, 0, 5), (2, 0, 5)))
        os.rename("plain.npz", FILE)
        hostile_runs.save("plain")
        checks.twinbox("simulate", f"{checks.scenes}/stack.yaml", "--frames", 60, "-o", "stack.npz")
        checks.twinbox("simulate", f"{checks.scenes}/stack.yaml", "--frames", 20, "--method", "momentum", "-o",
                       "short.npz")
        pages = Pages(checks, browser)
        for part in (pages.names, pages.letters, pages.worlds, pages.comings, pages.no_velocities, pages.one_frame,
                     pages.numbers, pages.many, pages.long, pages.parts, pages.damage):
            part()


main()
