# SPDX-License-Identifier: GPL-3.0-or-later
"""Hashes of all states of golden runs, corners of boxes beside the manifest's camera. (Pixels: alike.py.)"""
import csv
import json
import os
import re

import numpy

import runs
from checks import Checks
from chromium import Chromium

FRAMES = {"single": (0, 33, 70), "stack": (8, 16, 40), "pyramid": (0, 30, 60), "pyramid_settled": (20, 180, 200)}
METHODS = "engine", "pair-net"
SIZE = 1280, 720
HALF = 0.5  # pixels

HASHES = """(async () => {
  const all = [];
  for (let run = 0; run < player.runs.length; run++) {
    const found = [];
    for (let frame = 0; frame < player.runs[run].frames; frame++) {
      await player.load(frame);
      found.push(player.state_hash(run, frame));
    }
    all.push(found);
  }
  return all;
})()"""
CORNERS = """(async () => {
  await player.load(Math.floor($2));
  const plan = player.plan($0, $1), camera = player.camera(plan, $2);
  return plan.panels.map((panel, i) => player.runs[panel.run].fixed.map((fixed, body) =>
    player.corners(plan, camera, i, panel.run, $2, body)));
})()"""


def check_hashes(checks, page, files, reference=None):
    """Of all frames, against NumPy's of the files, and what the page says of its own check."""
    found = page.run(HASHES)
    for file, of_page in zip(files, found, strict=True):
        wanted = runs.hashes(runs.load(file))
        wrong = [frame for frame, pair in enumerate(zip(of_page, wanted)) if pair[0] != pair[1]]
        checks.equal(f"{file}: frames", len(of_page), len(wanted))
        checks.empty(f"{file}: frames with another hash", wrong)
        if reference is not None:
            checks.equal(f"{file}: hash of Box2D-Lite's own run", runs.run_hash(of_page), reference)
    frames = sum(map(len, found))
    page.wait("player.checked().frames === player.checked().of")
    checks.equal("what the page checked", page.run("player.checked()"), {"frames": frames, "of": frames, "wrong": 0})
    said = page.run("document.getElementById('check').textContent")
    checks.true("what it says of it", said.startswith(f"All {frames} states"), said)


def apart(found, wanted):
    """The largest distance of two boxes' corners, whichever corner comes first."""
    found = numpy.array([[point["x"], point["y"]] for point in found])
    orders = [numpy.roll(turned, k, axis=0) for turned in (found, found[::-1]) for k in range(4)]
    return min(numpy.abs(order - wanted).max() for order in orders)


def corner_faults(page, panels, loaded, frame, size=SIZE):
    """Boxes whose corners are more than half a pixel from where the manifest's camera has them; and the number of boxes."""
    faults, boxes = [], 0
    for panel, found in enumerate(page.run(CORNERS, *size, frame)):
        view, run = panels[panel], loaded[panel]
        low, part = int(frame), frame - int(frame)
        for body, sides in enumerate(run["size"]):
            pose = [(1 - part) * run[name][low, body] + part * run[name][low + (part > 0),
                    body] for name in ("position", "angle")]
            if not numpy.isfinite(pose[1]):
                continue
            metres = runs.corners(*pose[0], pose[1], sides)
            pixels = metres * (view["scale"], -view["scale"]) + numpy.add(view["rectangle"][:2],
                    (view["left"], view["top"]))
            boxes += 1
            if not apart(found[body], pixels) <= HALF:
                faults.append(f"panel {panel} frame {frame} body {body}: {apart(found[body], pixels)} pixels")
    return faults, boxes


def manifest_panels(checks, files, frame, size, *options):
    checks.twinbox("render", *files, "-o", "drawn", "--size", "x".join(map(str, size)), "--frames", frame, *options)
    with open("drawn/manifest.json") as file:
        return json.load(file)["view"]["panels"]


def check_panels(checks, page, what, panels, size):
    found = [[panel[side] for side in ("left", "top", "width",
                                       "height")] for panel in page.run("player.plan($0, $1).panels", *size)]
    checks.equal(f"{what}: panels", found, [panel["rectangle"] for panel in panels])


def check_places(checks, browser, scene):
    files = [f"golden/trajectories/{scene}-{method}.npz" for method in METHODS]
    panels = manifest_panels(checks, files, FRAMES[scene][0], SIZE)
    checks.twinbox("page", *files, "-o", f"{scene}.html")
    page, loaded = browser.open(f"{scene}.html", width=SIZE[0], height=SIZE[1]), [runs.load(file) for file in files]
    check_panels(checks, page, scene, panels, SIZE)
    for frame in [*FRAMES[scene], FRAMES[scene][1] + 0.25]:
        faults, boxes = corner_faults(page, panels, loaded, frame)
        checks.empty(f"{scene}: corners", faults)
        checks.true(f"{scene}: boxes compared", boxes > 0)
    checks.quiet(scene, page)
    return page, panels, loaded


def check_sizes(checks, browser):
    """Other shapes of pictures and numbers of panels, in which text has 12 pixels as in the golden frames."""
    six = [f"golden/trajectories/pyramid-{method}.npz" for method in METHODS] * 3
    for files, sizes in (six[:1], [(2400, 720), (960, 1280)]), (six[:3], [(1080, 1920)]), (six,
            [(1000, 1600), (1920, 1080)]):
        checks.twinbox("page", *files, "-o", "sizes.html")
        page, loaded = browser.open("sizes.html"), [runs.load(file) for file in files]
        for size in sizes:
            for options in [()] if len(files) == 1 else [(), ("--compare", "difference"), ("--compare", "overlay")]:
                page.run("player.change({compare: $0, frame: 30})", options[1] if options else "split")
                what = f"{len(files)} runs at {size} {' '.join(options)}"
                panels = manifest_panels(checks, files, 30, size, *options)
                check_panels(checks, page, what, panels, size)
                first = loaded[1:] if options == ("--compare", "difference") else loaded
                faults, _ = corner_faults(page, panels, first, 30, size)
                checks.empty(f"{what}: corners", faults)
        page.close()


def check_sight(checks, page, panels, loaded):
    """A box that is half a metre off is named."""
    frame, body = FRAMES["stack"][1], 5
    page.run("(() => { const run = player.runs[1]; run.x[$0 * run.bodies + $1] += 0.5; })()", frame, body)
    faults, _ = corner_faults(page, panels, loaded, frame)
    checks.equal("boxes that were moved, by corners", [fault.split(":")[0] for fault in faults],
                 [f"panel 1 frame {frame} body {body}"])


def check_damage(checks, browser, path):
    """One hash of a frame that is not that of its states: the page counts it and says so."""
    with open(path) as file:
        text = file.read()
    with open("damaged.html", "w") as file:
        at = re.search(r'id="hashes0">', text).end() + 20
        file.write(text[:at] + ("A" if text[at] != "A" else "B") + text[at + 1:])
    page = browser.open("damaged.html")
    page.wait("player.checked().frames === player.checked().of")
    checks.equal("wrong hashes of a damaged page", page.run("player.checked().wrong"), 1)
    said = page.run("document.getElementById('check').textContent")
    checks.true("the page says so", "1 of 152 states do not have the hash" in said, said)


def main():
    with Checks() as checks, Chromium("!!window.player?.data") as browser:
        os.symlink(f"{checks.sources}/golden", "golden")
        six = [f"golden/trajectories/{scene}-{method}.npz" for scene in ("single", "stack",
                "pyramid") for method in METHODS]
        checks.twinbox("page", *six, "-o", "six.html")
        page = browser.open("six.html")
        check_hashes(checks, page, six)
        checks.quiet("six runs of three scenes", page)

        with open("golden/run_hash.csv") as file:
            reference = {row["name"]: row for row in csv.DictReader(file)}["pyramid_settled_x-5"]
        checks.twinbox("simulate", f"{checks.scenes}/pyramid_settled.yaml", "--bomb-x", "-5", "--frames",
                       reference["frames"], "-o", "long.npz")
        checks.twinbox("page", "long.npz", "-o", "long.html")
        page = browser.open("long.html")
        check_hashes(checks, page, ["long.npz"], reference["hash"])
        checks.quiet("one run", page)

        places = {scene: check_places(checks, browser, scene) for scene in FRAMES}
        check_sizes(checks, browser)
        check_sight(checks, *places["stack"])
        check_damage(checks, browser, "single.html")


main()
