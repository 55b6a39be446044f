# SPDX-License-Identifier: GPL-3.0-or-later
"""The page in Firefox: no error, no request, all hashes, keys, and a box in its colour where it should be."""
import base64
import hashlib

from checks import Checks
from firefox import Firefox

ERRORS = """window.errors = [];
for (const kind of ["error", "unhandledrejection"])
  addEventListener(kind, event => errors.push(String(event.message || event.reason)), true);
for (const kind of ["error", "warn"]) console[kind] = (...words) => errors.push(words.join(" "));"""
# The colour of the canvas at the centre of a body in a panel, and what it should be.
COLOURS = """(() => {
  const stage = document.getElementById("stage"), plan = player.plan(stage.clientWidth, stage.clientHeight);
  const [panel, frame, body] = PLACE;
  const corners = player.corners(plan, player.camera(plan, frame), panel, panel, frame, body), scale = devicePixelRatio;
  const [x, y] = ["x", "y"].map(axis => Math.round(scale * corners.reduce((sum, corner) => sum + corner[axis], 0) / 4));
  const hex = [...stage.getContext("2d").getImageData(x, y, 1, 1).data].map(c => c.toString(16).padStart(2, "0"));
  return ["#" + hex.slice(0, 3).join(""), player.runs[panel].colours.light.fill];
})()"""
KEYS = {"ArrowRight": "\ue014", "End": "\ue010"}


def watched(page):
    """The page with a script that keeps errors, which its policy allows by hash as it does its own scripts."""
    digest = base64.b64encode(hashlib.sha256(ERRORS.encode()).digest()).decode()
    return (page.replace("script-src ", f"script-src 'sha256-{digest}' ", 1)
            .replace("<title>", f"<script>{ERRORS}</script><title>", 1))


def main():
    with Checks() as checks:
        for method in "engine", "momentum":
            checks.twinbox("simulate", f"{checks.scenes}/stack.yaml", "--frames", 40, "--method", method, "-o",
                           f"{method}.npz")
        checks.twinbox("page", "engine.npz", "momentum.npz", "-o", "page.html")
        with open("page.html", encoding="utf-8") as file:
            text = file.read()
        with open("watched.html", "w", encoding="utf-8") as file:
            file.write(watched(text))
        with Firefox() as browser:
            print(f"Firefox {browser.version}")
            browser.open("watched.html", "t=0.25&theme=light")
            browser.wait("window.player && player.checked().frames === player.checked().of")
            checks.equal("hashes", browser.run("player.checked()"), {"frames": 82, "of": 82, "wrong": 0})
            checks.equal("the frame of the link", browser.run("player.view.frame"), 15)
            browser.press(KEYS["ArrowRight"])
            browser.wait("player.view.frame === 16")
            for panel in 0, 1:
                found, wanted = browser.run(COLOURS.replace("PLACE", f"[{panel}, 16, 5]"))
                checks.equal(f"the colour of a box in panel {panel}", found, wanted)
            browser.press(" ")
            browser.wait("player.view.frame === 40 && !player.view.playing")
            browser.press("?")
            browser.wait("document.getElementById('help').open")
            checks.equal("errors", browser.run("errors"), [])
            checks.equal("requests", browser.run("performance.getEntriesByType('resource').map(entry => entry.name)"),
                         [])


main()
