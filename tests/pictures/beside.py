# SPDX-License-Identifier: GPL-3.0-or-later
"""A live page with recorded panels: they are drawn, compared, greyed under another launch, removed and put back; its copied
commands make what they name. And the top of a page: a line for each panel, one scroll bar, time steps as fractions."""
import glob
import json
import os
import shutil
import subprocess

import numpy

import runs
from checks import Checks
from chromium import Chromium

ENDED = """player.runs.every(run => !run.live || (run.hash && run.reached === run.frames - 1 && run.shown === player.launched())) &&
  player.checked().frames === player.checked().of && player.ready(player.view.frame)"""
TEXT = "document.getElementById($0).textContent"
LINES = "[...document.querySelectorAll('#summary p')].map(line => line.textContent)"
# Of the pixels of a panel's lower half, the largest difference of two channels: 0 where all is grey.
COLOUR = """(i => {
  const stage = document.getElementById("stage"), {left, top, width, height} = player.plan(stage.clientWidth, stage.clientHeight).panels[i];
  const {data} = stage.getContext("2d").getImageData(left, top + height / 2, width, height / 2);
  let most = 0;
  for (let at = 0; at < data.length; at += 4) {
    const [r, g, b] = data.slice(at, at + 3);
    most = Math.max(most, Math.max(r, g, b) - Math.min(r, g, b));
  }
  return most;
})($0)"""
# What scrolls by itself, beside the page.
SCROLLS = """[...document.querySelectorAll("body *")].filter(e => {
  const {overflowX, overflowY} = getComputedStyle(e), beyond = (way, most, there) => /auto|scroll/.test(way) && most > there;
  return beyond(overflowX, e.scrollWidth, e.clientWidth) || beyond(overflowY, e.scrollHeight, e.clientHeight);
}).map(e => e.tagName + e.id)"""
VISIBLE = 0.1  # m: a tenth of the stack's boxes


def largest(one, other):
    """m, of each frame."""
    return numpy.nanmax(numpy.linalg.norm(one["position"].astype(float) - other["position"], axis=2), axis=1)


def open_page(checks, browser, *arguments, **looks):
    checks.twinbox("page", "--live", f"{checks.scenes}/stack.yaml", *arguments, "-o", "beside.html")
    page = browser.open("beside.html", **looks)
    page.wait(ENDED)
    return page


def pick(page, name, value):
    page.run("player.choose($0, $1)", name, value)
    page.wait(ENDED)
    page.settle()


def check_marks(checks, page):
    """Contacts of a recorded run are decoded and drawn when they are wanted, though the live ones have all arrived."""
    for name, frame in ("contacts", 60), ("impulses", 200):  # of two chunks
        page.run("player.change({frame: $0})", frame)
        page.settle()
        page.run("new Promise(done => setTimeout(done, 500))")  # nothing else is due that would draw
        page.click(*page.middle(f"#show-{name}"))
        page.wait("player.ready($0)", frame)
        page.settle()
        page.settle()
        for panel in range(3):
            checks.true(f"{name}: panel {panel} is drawn", page.run(COLOUR, panel) > 50)
        page.click(*page.middle(f"#show-{name}"))


def check_headline(checks, page, loaded):
    names = "engine", "interior", "pair-net (recorded)"
    lines = page.run(LINES)
    checks.equal("lines", len(lines), 3)
    for line, name, run, other in zip(lines, names, ["engine", "interior", "pair-net"], loaded):
        checks.true(f"the line of {name}", line.startswith(name + " "), line)
        words = page.run("player.runs.find(run => run.method === $0).ended", run)
        checks.true("what happens in it", words.split(", first at")[0].split(" (")[0] in line, line)
        apart = largest(loaded[0], other) > VISIBLE
        wanted = f", parts from engine at {apart.argmax() / 60:.2f} s" if apart.any() else ""
        checks.equal(f"when {name} parts", line[line.index(", parts"):] if ", parts" in line else "", wanted)
    style = "[...document.querySelectorAll('#summary p')].map(line => getComputedStyle(line).borderLeftColor)"
    fills = "player.runs.map(run => run.colours.light.fill.match(/\\w\\w/g).map(part => parseInt(part, 16)))"
    checks.equal("their colours", page.run(style), [f"rgb({r}, {g}, {b})" for r, g, b in page.run(fills)])
    heights = page.run("[...document.querySelectorAll('#summary p')].map(line => line.offsetHeight)")
    checks.true("one line each", max(heights) < 30, heights)


def check_layout(checks, page):
    checks.equal("scroll bars beside the page's", page.run(SCROLLS), [])
    step = "document.querySelector('[aria-label=\"time step, s\"]')"
    checks.equal("the time step", page.run(f"{step}.value"), "1/60")
    for typed, shown, chosen in ("1/120", "1/120", "dt=0.008333333333333333"), ("x/2", "1/120", "dt=0.008333333333333333"):
        page.run(f"({step}.value = $0, {step}.onchange())", typed)
        checks.equal(f"'{typed}' as a time step", [page.run(f"{step}.value"), page.run("player.set_text()")], [shown, chosen])
    page.wait(ENDED)
    state = json.loads(checks.twinbox("simulate", f"{checks.scenes}/stack.yaml", "--set", f"dt={1 / 120}", "--json").stdout)["state"]
    checks.equal("its run", page.run("player.runs[0].hash"), state)
    pick(page, "dt", 1 / 60)


def check_elsewhere(checks, page, pair_net):
    """Under another launch a recorded panel is grey and says which it shows; it is compared again with its own."""
    page.run("player.change({frame: 30, show: new Set()})")
    page.settle()
    before = page.run("[...player.runs[2].distances]")
    checks.true("a colour", page.run(COLOUR, 2) > 50)
    pick(page, "bomb_x", 1.5)
    checks.true("no colour", page.run(COLOUR, 2) <= 4, page.run(COLOUR, 2))
    checks.true("the live panel's colour", page.run(COLOUR, 0) > 50)
    checks.equal("its line", page.run(LINES)[2], "pair-net (recorded) shows another launch: bomb x 5\u00a0m")
    page.run("audit.drawn.length = 0")
    page.run("player.draw()")
    drawn = [text["text"] for text in page.run("audit.drawn")]
    checks.true("the panel says so", "Another launch" in drawn and "bomb x 5\u00a0m" in drawn, drawn)
    checks.true("nothing is left empty", "()" not in page.run("document.body.innerText"))
    checks.true("no moment of another launch", "pair-net" not in page.run(TEXT, "moments"), page.run(TEXT, "moments"))
    pick(page, "dt", 0.01)
    checks.equal("settings that differ", page.run("player.runs[2].elsewhere"), "bomb x 5\u00a0m, time step 1/60\u00a0s")
    x, y = map(float, pair_net["position"][30, 11])
    far = page.run("""((plan, frame) => {
      const camera = player.camera(plan, frame), wanted = player.to_pixel(plan, camera, 2, $0, $1);
      const found = player.corners(plan, camera, 2, 2, frame, 11);
      return Math.hypot(...["x", "y"].map(axis => found.reduce((sum, corner) => sum + corner[axis] / 4, -wanted[axis])));
    })(player.plan(900, 600), 50)""", x, y)
    checks.near("pixels from where it is at 0.5 s", far, 0, 0.1)
    pick(page, "dt", 1 / 60)
    pick(page, "bomb_x", 5)
    checks.equal("back", page.run("[player.runs[2].elsewhere, player.runs[2].compared]"), ["", True])
    checks.equal("compared as before", page.run("[...player.runs[2].distances]"), before)


def check_list(checks, browser, page, loaded):
    """A recorded panel can be removed and put back; so can what it is compared with."""
    remove = "document.querySelector('[aria-label=\"Remove $0\"]').click()"
    page.run(remove.replace("$0", "pair-net (recorded)"))
    page.wait("player.runs.length === 2 && location.hash.includes('without=2') && location.hash")
    other = browser.open("beside.html", page.run("location.hash").lstrip("#"))
    other.wait("player.runs.length === 2")
    other.wait(ENDED)
    checks.quiet("a link without a panel", other)
    other.close()
    page.run("document.querySelector('[aria-label=\"Add pair-net (recorded)\"]').click()")
    page.wait("player.runs.length === 3")
    page.run(remove.replace("$0", "engine"))
    page.wait("player.runs.length === 2")
    page.wait(ENDED)
    found, wanted = page.run("[...player.runs[1].distances]"), largest(loaded[1], loaded[2])
    checks.near("compared with what is first now", max(abs(a - b) for a, b in zip(found, wanted, strict=True)), 0, 1e-4)
    page.run("player.change({frame: 290, show: new Set(['contacts'])})")
    page.wait("player.ready(290) || document.getElementById('summary').textContent.includes('damaged')")
    checks.equal("its own contacts, in another place", page.run("player.ready(290)"), True)
    checks.equal("states that are checked", page.run("player.checked()"), {"frames": 301, "of": 301, "wrong": 0})


def check_command(checks, page, panels, left):
    """The copied line runs where the scene is, which it names without its folder, and draws so many panels; the page names what
    it leaves out."""
    page.run("document.getElementById('copy-command').click()")
    command = page.wait("navigator.clipboard.readText().then(text => text.startsWith('twinbox') && text)")
    said = page.run(TEXT, "status")
    for name in left:
        checks.true("what is left out is said", f"without {name}" in said, said)
    os.mkdir("empty")
    for name in os.listdir(checks.scenes):
        os.symlink(f"{checks.scenes}/{name}", f"empty/{name}")
    tools = f"{os.path.dirname(checks.program)}:{os.environ['PATH']}"
    result = subprocess.run(["bash", "-ec", command], cwd="empty", env={**os.environ, "PATH": tools}, capture_output=True, text=True)
    if checks.equal(f"exit status of {command}: {result.stderr[:200]}", result.returncode, 0):
        with open(glob.glob("empty/frame/manifest.json")[0], encoding="utf-8") as file:
            checks.equal(f"panels of {command}", len(json.load(file)["runs"]), panels)
    shutil.rmtree("empty")


def check_others(checks, browser):
    """A run of other settings, from the start; one that the page made itself; a page without a live panel."""
    checks.twinbox("simulate", f"{checks.scenes}/stack.yaml", "--set", "bomb_x=2", "-o", "two.npz")
    page = open_page(checks, browser, "two.npz", "--method", "engine", "--method", "playback")
    checks.equal("other settings", page.run("player.runs.map(run => run.elsewhere)"), ["", "", "its settings are not those of the page"])
    check_command(checks, page, 2, ["engine (recorded)"])
    pick(page, "bomb_x", 2)
    checks.equal("its own launch", page.run("player.runs.map(run => run.elsewhere)"), ["", "bomb x 5\u00a0m", ""])
    checks.equal("there both are equal", page.run(LINES)[2].split(", ")[-1], "bit for bit")
    check_command(checks, page, 1, ["playback (recorded), engine (recorded)"])
    checks.quiet("other settings", page)
    page.close()
    checks.twinbox("page", f"{checks.scenes}/stack.yaml", "--set", "bomb_x=2", "-o", "two.html")
    page = browser.open("two.html")
    page.wait("player.ready(0)")
    check_command(checks, page, 2, [])
    page.close()


def main():
    with Checks() as checks, Chromium("!!window.player?.data") as browser:
        browser.allow("clipboardReadWrite", "clipboardSanitizedWrite")
        for method in "engine", "interior", "pair-net":
            checks.twinbox("simulate", f"{checks.scenes}/stack.yaml", "--method", method, "-o", f"{method}.npz")
        loaded = [runs.load(f"{method}.npz") for method in ("engine", "interior", "pair-net")]
        with open(os.path.join(checks.sources, "tests/pictures/audit.js"), encoding="utf-8") as file:
            page = open_page(checks, browser, "pair-net.npz", "--method", "engine", "--method", "interior", before=file.read())
        check_marks(checks, page)
        check_headline(checks, page, loaded)
        check_layout(checks, page)
        check_elsewhere(checks, page, loaded[2])
        check_command(checks, page, 2, ["pair-net (recorded)"])
        check_list(checks, browser, page, loaded)
        checks.quiet("recorded beside live", type("Seen", (), {"requests": page.requests, "messages": [
            text for text in page.messages if "willReadFrequently" not in text]}))  # both read pixels
        page.close()
        check_others(checks, browser)


main()
