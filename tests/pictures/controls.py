# SPDX-License-Identifier: GPL-3.0-or-later
"""Keys, time, mouse, fingers, links and measured values, on a page of three runs of the stack."""
import json
import re
import shutil

import numpy

import runs
from checks import Checks
from chromium import Chromium
from keys import Keys, view
from links import SHARP, check_command, check_link, check_malformed, check_saved
from measure import Measured
from pointer import check_mouse, check_touch

METHODS = "engine", "pair-net", "momentum"
FRAMES = 75


def moments(loaded):
    """Frames of the impact, and of where each run first has another bit than run 0 and is first 1 mm away."""
    first, found = loaded[0], []
    bomb, fixed = int(first["bomb"]), first["fixed"]
    for step in range(1, len(first["angle"])):
        pairs = first["contact_bodies"][slice(*first["contact_start"][step:step + 2])]
        if any(bomb in pair and not fixed[pair].any() for pair in pairs):
            found.append(step)
            break
    for other in loaded[1:]:
        found += parting(first, other)
    return sorted(found)


def parting(first, other):
    """The first frames with a different bit, and with a body a millimetre away."""
    bits = runs.states(other).view(numpy.uint32) != runs.states(first).view(numpy.uint32)
    apart = numpy.linalg.norm(other["position"].astype(float) - first["position"], axis=2)
    return [int(bits.any(axis=(1, 2)).argmax()), int((numpy.nanmax(apart, axis=1) >= 0.001).argmax())]


def check_marks(checks, page, loaded):
    """The frames of the page's moments in their order. Those of verdicts are as the runs state them. Where runs differ in a bit
    is none if their methods differ."""
    stored = page.run("player.runs.flatMap(run => [run.differs, run.apart]).filter(Boolean).map(mark => mark.frame)"
                      ".concat(player.data.impact)")
    checks.equal("frames of impact, first different bits and first millimetres", sorted(stored), moments(loaded))
    marked = page.run("player.runs.flatMap(run => [run.apart, run.verdict, run.method === player.runs[0].method && run.differs])"
                      ".filter(mark => mark?.frame >= 0).map(mark => mark.frame).concat(player.data.impact)")
    checks.true("variables of the style are colours", page.run("![...document.documentElement.style].some(name => "
                "name.startsWith('--') && !/^#/.test(document.documentElement.style.getPropertyValue(name)))"))
    return sorted(set(marked))


def check_equal_methods(checks, browser):
    """Where runs of one method first differ in a bit has a mark: a step in another place, and nothing else of the run."""
    moved = dict(numpy.load("engine.npz"))
    moved["position"][9, 3, 0] = numpy.nextafter(moved["position"][9, 3, 0], numpy.float32(9))
    numpy.savez("moved.npz", **moved)
    checks.twinbox("page", "engine.npz", "moved.npz", "-o", "equal.html")
    page = browser.open("equal.html")
    marks = page.run("[...document.querySelectorAll('#marks button')].map(mark => mark.ariaLabel)")
    checks.equal("marks of a different bit", [mark for mark in marks if "differs from here on, body\u00a03" in mark],
                 [mark for mark in marks if " 0.150 s" in mark])
    checks.true("there is one", any(" 0.150 s" in mark for mark in marks), marks)
    page.close()


def check_words(checks, page, loaded):
    """Where each run comes from, and where they part: in the table and in the summary."""
    checks.twinbox("render", *(f"{method}.npz" for method in METHODS), "-o", "drawn", "--size", "320x180", "--frames",
                   0)
    with open("drawn/manifest.json") as file:
        manifest = json.load(file)
    shutil.rmtree("drawn")
    page.click(*page.middle("#figures"))
    table, figures = (page.run(f"document.getElementById('{part}').innerText") for part in ("runs", "facts"))
    page.click(*page.middle("#figures"))
    checks.equal("the figures are hidden again", page.run("document.getElementById('facts').offsetHeight"), 0)
    for run, method in zip(manifest["runs"], METHODS):
        for word in run["hash"], run["scene_hash"], method:
            checks.true(f"'{word}' in the table of runs", word in table, table)
    checks.true("the version", manifest["twinbox"] in table, table)
    checks.true("no date", not re.search(r"20\d\d-\d\d|GMT|UTC", page.run("document.body.innerText")))
    for i, other in enumerate(loaded[1:], 1):
        for frame in parting(loaded[0], other):
            checks.true(f"{METHODS[i]} parts at frame {frame}", f"at {frame / 60:.3f} s" in figures, figures)


def check_time(checks, browser):
    """A second of the page's clock at each speed, and in slow motion, moves on as many frames as it should."""
    page = browser.open("three.html", clock=True)
    impact = page.run("player.data.impact")
    page.wait("player.ready(player.data.frames - 1)")
    for speed in 1 / 16, 1 / 4, 1, 2, 4:
        page.run("player.change({frame: 0, speed: $0, slow: false, playing: false})", speed)
        page.settle()
        page.press("Space")
        page.tick(0.3, 30)
        checks.near(f"frames in 0.3 s at speed {speed}", view(page)["frame"], 0.3 * 60 * speed, 0.3 * speed)
        page.press("Space")
        before = view(page)["frame"]
        page.tick(0.3, 10)
        checks.equal("frames after a pause", view(page)["frame"], before)
    # From 0.15 s before the impact to 0.6 s after it: frames from there, and how much slower it is.
    for first, times in (-11, 1), (-8, 4), (0, 4), (34, 4), (37, 1):
        page.run("player.change({frame: $0, speed: 1, slow: true, playing: false})", impact + first)
        page.press("Space")
        page.tick(0.025, 10)
        checks.near(f"frames in 0.025 s at {first} frames from the impact", view(page)["frame"] - impact - first,
                    0.025 * 60 / times, 0.02)
        page.press("Space")
    page.run("player.change({frame: player.data.frames - 2, slow: false})")
    page.press("Space")
    page.tick(1, 60)
    checks.equal("plays to the end and stops", [view(page)[name] for name in ("frame", "playing")], [FRAMES, False])
    checks.quiet("playing", page)
    page.close()


def check_cut(checks, browser):
    """A page of some frames has their times: frame F is at F dt, in words, in the link and on the axis of the plot."""
    checks.twinbox("page", "engine.npz", "momentum.npz", "--frames", "30:60", "-o", "cut.html")
    page = browser.open("cut.html")
    for frame in 0, 12:
        page.run("player.change({frame: $0})", frame)
        page.settle()
        at = (30 + frame) / 60
        checks.equal(f"time of frame {frame}", page.run("document.getElementById('time').textContent"),
                     f"t = {at:.3f} s, frame {30 + frame} of {FRAMES}")
        page.wait(f"Math.abs(new URLSearchParams(location.hash.slice(1)).get('t') - {at}) < 1e-3")
    width = page.run("document.getElementById('marks').clientWidth")
    found = page.run("[...document.querySelectorAll('#plot text')].map(each => [Number(each.getAttribute('x')), each.textContent])")
    times = [(x, float(text[:-2])) for x, text in found if re.fullmatch(r"[\d.]+ s", text)]
    checks.true("times on the axis", len(times) > 2, found)
    for x, t in times:
        checks.near(f"place of {t} s", (x - 44) / width * 30, t * 60 - 30, 0.05)
    page.close()


def check_moments(checks, page, frames):
    """The marks on the time axis and the rows of the list lead to their frames."""
    for part in "marks", "moments":
        count = page.run(f"document.querySelectorAll('#{part} :is(button, tr)').length")
        checks.equal(f"#{part}", count, len(frames))
        for i, frame in enumerate(frames):
            page.click(*page.middle(f"#{part} :is(button, tr):nth-of-type({i + 1})"))
            checks.equal(f"a click on number {i + 1} of #{part}", view(page)["frame"], frame)


# The panels as a picture, below which the legend has one row.
PANELS = """(() => {
  const {panels} = player.plan(stage.clientWidth, stage.clientHeight), {left, top} = panels[0], {width, height, ...end} = panels.at(-1);
  const part = new OffscreenCanvas(end.left + width - left, end.top + height - top).getContext("2d");
  player.draw();
  part.drawImage(stage, -left, -top);
  return part.canvas.convertToBlob().then(blob => blob.arrayBuffer()).then(bytes => crypto.subtle.digest("SHA-256", bytes))
    .then(hash => [left, top, end.left, end.top, width, height, ...new Uint8Array(hash)].join());
})()"""


def check_marks_are_drawn(checks, page):
    """Each mark changes pixels of the panels, beside another one: not only the legend."""
    def panel_with(*show):
        page.run("player.change({frame: 40, body: -1, compare: 'split', show: new Set($0), playing: false})", show)
        page.wait("player.ready(40)")
        page.settle()
        return page.run(PANELS)
    marks = page.run("Object.keys(player.data.shows)")
    for name in marks:
        other = "trails" if name != "trails" else "contacts"
        checks.true(f"{name} is drawn in panels", panel_with(name, other) != panel_with(other))
    page.run("player.change({show: new Set()})")
    page.settle()


def check_buttons(checks, page):
    """Each control changes the view, and shows it when a key has changed it."""
    page.run("player.change({frame: 10, body: -1, compare: 'split', show: new Set(), playing: false})")
    page.settle()
    for name in "overlay", "difference", "split":
        page.click(*page.middle(f"#compare-{name}"))
        checks.equal(f"radio button {name}", view(page)["compare"], name)
    for name in page.run("Object.keys(player.data.shows)"):
        page.click(*page.middle(f"#show-{name}"))
        checks.equal(f"check box {name}", view(page)["show"], [name])
        page.click(*page.middle(f"#show-{name}"))
        checks.equal(f"check box {name} again", view(page)["show"], [])
    page.run("document.getElementById('scrubber').focus()")
    page.press("End")
    checks.equal("End on the scrubber", view(page)["frame"], FRAMES)
    page.run("document.getElementById('play').focus()")
    page.press("Space")
    checks.equal("Space on the button plays once", view(page)["playing"], True)
    page.press("Space")
    checks.equal("and pauses", view(page)["playing"], False)
    page.run("player.change({compare: 'overlay', show: new Set(['trails']), speed: 0.25})")
    page.settle()
    checks.equal("controls show the view",
                 page.run("[document.getElementById('compare-overlay').checked, document.getElementById('show-trails')"
                                                    ".checked, Number(document.getElementById('speed').value)]"),
                                                    [True, True, 0.25])


HOST = """<!DOCTYPE html><title>Host</title><body style="height: 3000px">
<iframe src="three.html#stage&t=0.5" width="640" height="360"></iframe>"""
SHOWN = """[...document.querySelectorAll("body [id]")].filter(each => each.checkVisibility?.() ?? each.getClientRects().length > 0)
  .map(each => each.id).sort()"""
STAGE = sorted(["player", "frame", "stage", "play", "scrubber", "marks", "bare", "status"])  # the last is empty, and speaks


def check_stage(checks, browser):
    """The stage and its time line alone: nothing else is shown, nothing scrolls, and a button leads to all controls and back."""
    for size in (1440, 900), (1920, 1080), (640, 360), (320, 240):
        page = browser.open("three.html", "stage&t=0.5", width=size[0], height=size[1])
        page.settle()
        checks.equal(f"{size}: what is shown", page.run(SHOWN), STAGE)
        whole = page.run("(e => [e.scrollWidth, e.scrollHeight])(document.documentElement)")
        checks.equal(f"{size}: the page is the window", whole, list(size))
        checks.true(f"{size}: share of the stage", page.run("stage.clientHeight / innerHeight") > 0.6)
        link = page.run("location.hash = '#t=0.25'; 0") or page.wait("player.view.frame === 15 && !player.view.stage")
        page.settle()
        checks.true(f"{size}: the whole page by a link without it", link and "keys" in page.run(SHOWN))
        page.click(*page.middle("#bare"))
        checks.equal(f"{size}: the stage by the button", page.run(SHOWN), STAGE)
        page.wait("location.hash.includes('stage=1')")
        page.click(*page.middle("#bare"))
        checks.true(f"{size}: all controls by the button", "keys" in page.run(SHOWN))
        checks.quiet(f"{size}: stage", page)
        page.close()


def check_embedded(checks, browser):
    """In another page, the wheel scrolls that page."""
    with open("host.html", "w", encoding="utf-8") as file:
        file.write(HOST)
    browser.ready, ready = "true", browser.ready
    page = browser.open("host.html")
    browser.ready = ready
    page.wheel(300, 200, 400)
    page.wait("scrollY > 100")
    checks.true("the wheel over an embedded stage scrolls the page around it", True)
    page.close()


def check_labels(checks, browser):
    """Numbers of bodies and masses, by the control and by a link; not of a run without masses."""
    page = browser.open("three.html", "labels=mass&t=0.5")
    checks.equal("labels by a link", [page.run("player.view.labels"), page.run("document.getElementById('labels').value")],
                 ["mass", "mass"])
    checks.near("mass of the bomb in the page", page.run("player.runs[0].mass[player.runs[0].bomb]"), 50, 0)
    masses = runs.load("engine.npz")["mass"]
    checks.equal("masses in the page", page.run("[...player.runs[0].mass]"), masses.tolist())
    drawn = "(player.draw(), stage.toDataURL())"
    with_masses = page.run(drawn)
    page.run("player.change({labels: 'number'})")
    page.settle()
    checks.true("numbers are drawn otherwise than masses", page.run(drawn) != with_masses)
    checks.quiet("labels", page)
    page.close()
    old = dict(runs.load("engine.npz"))
    del old["mass"]
    numpy.savez("massless.npz", **old)
    checks.twinbox("page", "massless.npz", "-o", "massless.html")
    page = browser.open("massless.html", "labels=mass")
    checks.equal("no masses, no labels", page.run("player.view.labels"), "none")
    checks.true("the choice is disabled", page.run("[...document.getElementById('labels').options].find(each => each.value === 'mass').disabled"))
    page.close()


def check_names(checks, browser):
    """Names of bodies, of a stored run and of a live one."""
    with open("named.yaml", "w", encoding="utf-8") as file:
        file.write("{gravity: [0, -10], dt: 1/60, iterations: 10, frames: 60, bodies: [{static: true, size: [9, 1], position: [0, 0]},"
                   "{mass: 1, size: [1, 1], position: [0, 1], name: M\u00e4x}, {mass: 1, size: [1, 1], position: [2, 1]}]}")
    checks.twinbox("simulate", "named.yaml", "-o", "named.npz")
    checks.twinbox("page", "named.npz", "-o", "named.html")
    checks.twinbox("page", "--live", "named.yaml", "-o", "named-live.html")
    for file in "named.html", "named-live.html":
        page = browser.open(file, "labels=name&body=1")
        page.settle()
        checks.equal(f"names in {file}", page.run("[player.view.labels, ...player.runs[0].named]"), ["name", "", "M\u00e4x", ""])
        checks.true(f"name of the pinned body in {file}",
                    page.run("document.getElementById('named').textContent").startswith("Body 1, M\u00e4x, in "))
        drawn = "(player.draw(), stage.toDataURL())"
        with_names = page.run(drawn)
        page.run("player.change({labels: 'none'})")
        page.settle()
        checks.true(f"{file}: names are drawn", page.run(drawn) != with_names)
        checks.quiet(file, page)
        page.close()
    page = browser.open("three.html", "labels=name")
    checks.equal("no names, no labels", page.run("player.view.labels"), "none")
    page.close()


def check_sizes(checks, browser):
    """Windows of all shapes, and screens with more pixels, one after the other in one page."""
    page = browser.open("three.html")
    for size in (700, 600, 2), (320, 480, 1), (2200, 700, 1.5), (1440, 900, 1):
        page.resize(*size)
        page.settle()
        page.wait(SHARP)
    checks.quiet("other windows", page)
    page.close()


def main():
    with Checks() as checks, Chromium("!!window.player?.data") as browser:
        browser.allow("clipboardReadWrite", "clipboardSanitizedWrite")
        files = [f"{method}.npz" for method in METHODS]
        for method, file in zip(METHODS, files):
            checks.twinbox("simulate", f"{checks.scenes}/stack.yaml", "--frames", FRAMES, "--method", method, "-o",
                           file)
        checks.twinbox("page", *files, "-o", "three.html")
        loaded = [runs.load(file) for file in files]
        page = browser.open("three.html", clock=True)
        page.wait("player.ready(player.data.frames - 1)")
        frames = check_marks(checks, page, loaded)
        Keys(checks, page, frames).all()
        check_moments(checks, page, frames)
        check_equal_methods(checks, browser)
        check_words(checks, page, loaded)
        check_mouse(checks, page, FRAMES)
        check_buttons(checks, page)
        check_marks_are_drawn(checks, page)
        measured = Measured(checks, page, loaded, METHODS)
        for run, frame, body in (0, 16, 3), (1, 20.5, 10), (2, 75, 11), (1, 0, 1), measured.most_friction():
            measured.check(run, frame, body)
        for frame, body in (16, -1), (60, -1), (60, 4):
            measured.curves(frame, body)
        measured.times()
        check_link(checks, browser, page)
        check_command(checks, page)
        check_saved(checks, browser, page)
        check_malformed(checks, browser, page)
        checks.quiet("the page", page)
        page.close()
        check_sizes(checks, browser)
        check_stage(checks, browser)
        check_embedded(checks, browser)
        check_labels(checks, browser)
        check_names(checks, browser)
        check_time(checks, browser)
        check_cut(checks, browser)
        check_touch(checks, browser)


main()
