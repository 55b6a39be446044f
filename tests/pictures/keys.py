# SPDX-License-Identifier: GPL-3.0-or-later
"""Every key that the page's dialog lists does what the list says. A key that is listed and not tried here is a fault."""
import math

VIEW = "(v => ({...v, show: [...v.show].sort()}))(player.view)"
LISTED = """[...document.querySelectorAll("#help kbd")].map(key => key.textContent)"""
NAMES = {"←": "ArrowLeft", "→": "ArrowRight", "↑": "ArrowUp", "↓": "ArrowDown", "Esc": "Escape"}
SPEEDS = [2.0 ** k for k in range(-4, 3)]


def view(page):
    return page.run(VIEW)


def listed(page):
    """All keys of the dialog."""
    return {NAMES.get(key, key) for key in page.run(LISTED)} - {"Shift"}


class Keys:
    """Presses keys on a page of three runs and compares its view before and after."""

    def __init__(self, checks, page, moments):
        """moments: the stored frames of the marks, as NumPy finds them in the runs."""
        self.checks, self.page, self.moments, self.tried = checks, page, moments, set()

    def set(self, patch):
        self.page.run(f"player.change({patch})")
        self.page.settle()

    def expect(self, key, name, wanted, patch=None):
        """The view's member after this key."""
        if patch:
            self.set(patch)
        self.press(key)
        self.checks.equal(f"key {key}: {name}", view(self.page)[name], wanted)

    def press(self, key):
        self.tried.add(key.rpartition("+")[2] or "+")
        self.page.press(key)

    def time(self):
        last = self.page.run("player.data.frames") - 1
        self.expect("Space", "playing", True, "{frame: 10, playing: false}")
        self.expect("Space", "playing", False)
        self.expect("ArrowRight", "frame", 11, "{frame: 10}")
        self.expect("ArrowLeft", "frame", 10)
        self.expect("Shift+ArrowRight", "frame", 20)
        self.expect("Shift+ArrowLeft", "frame", 10)
        self.expect("End", "frame", last)
        self.expect("ArrowRight", "frame", last)
        self.expect("Home", "frame", 0)
        self.expect("ArrowLeft", "frame", 0)
        for i, speed in enumerate(SPEEDS):
            self.expect("]", "speed", SPEEDS[min(i + 1, len(SPEEDS) - 1)], f"{{speed: {speed}}}")
            self.expect("[", "speed", SPEEDS[max(i - 1, 0)], f"{{speed: {speed}}}")
        slow = view(self.page)["slow"]
        self.expect("m", "slow", not slow)
        self.expect("m", "slow", slow)
        for digit in "123456789":
            self.set("{frame: 1}")
            self.press(digit)
            found = view(self.page)["frame"]
            wanted = self.moments[int(digit) - 1] if int(digit) <= len(self.moments) else 1
            self.checks.equal(f"key {digit}: frame", found, wanted)

    def bodies(self):
        fixed, bodies = self.page.run("player.runs[0].fixed"), self.page.run("player.runs[0].bodies")
        moving = [body for body in range(bodies) if not fixed[body]]
        self.set("{body: -1}")
        self.press("n")
        first = view(self.page)["body"]
        self.checks.true("key n pins a body", first in range(bodies), first)
        self.press("n")
        second = view(self.page)["body"]
        self.checks.true("key n pins the next", second > first, (first, second))
        self.expect("p", "body", first)
        self.set(f"{{body: {moving[0]}}}")
        seen = set()
        for _ in range(bodies):
            self.press("n")
            seen.add(view(self.page)["body"])
        self.checks.true("key n comes to all moving bodies", seen >= set(moving), (seen, moving))
        self.set(f"{{body: {moving[3]}, frame: 20}}")
        before = self.page.run("document.getElementById('body').textContent")
        self.press("r")
        self.checks.true("key r measures in another run",
                         self.page.run("document.getElementById('body').textContent") != before)
        for _ in range(self.page.run("player.runs.length") - 1):
            self.press("r")
        self.checks.equal("key r comes round", self.page.run("document.getElementById('body').textContent"), before)
        self.press("b")
        self.checks.equal("key b follows the pinned body", view(self.page)["camera"]["kind"], "body")
        self.press("b")
        self.checks.true("key b stops", view(self.page)["camera"]["kind"] != "body")
        self.expect("Escape", "body", -1)

    def camera(self):
        self.set("{frame: 0, camera: {kind: 'fit'}}")
        stage = "(b => player.plan(b.width, b.height))(document.getElementById('stage').getBoundingClientRect())"
        scale = f"(plan => player.camera(plan, 0).scale)({stage})"
        middle = """(plan => { const c = player.camera(plan, 0), p = plan.panels[0];
            return [(p.width / 2 - c.left) / c.scale, (c.top - p.height / 2) / c.scale]; })""" + f"({stage})"
        fitted = self.page.run(scale)
        self.press("+")
        nearer = self.page.run(scale)
        self.checks.true("key + zooms in", nearer > 1.05 * fitted, (nearer, fitted))
        self.press("-")
        self.checks.near("key - zooms out as far", self.page.run(scale), fitted, 0.02 * fitted)
        self.press("+")
        for key, back, axis, sign in ("d", "a", 0, 1), ("w", "s", 1, 1):
            start = self.page.run(middle)
            self.press(key)
            moved = self.page.run(middle)
            self.checks.true(f"key {key} moves the view", sign * (moved[axis] - start[axis]) > 0.01, (start, moved))
            self.press(back)
            again = self.page.run(middle)
            left = math.dist(again, start)
            most = 0.1 * abs(moved[axis] - start[axis]) + 0.05
            self.checks.true(f"key {back} moves it back", left < most, (start, again))
        self.press("f")
        self.checks.equal("key f: camera", view(self.page)["camera"]["kind"], "fit")
        self.checks.near("key f: scale", self.page.run(scale), fitted, 1e-9)

    def looks(self):
        self.set("{compare: 'split', theme: 'auto'}")
        for wanted in "overlay", "difference", "split":
            self.expect("c", "compare", wanted)
        for wanted in "light", "dark", "auto":
            self.expect("t", "theme", wanted)
        self.expect("h", "stage", True)
        self.expect("h", "stage", False)
        self.press("?")
        self.checks.equal("key ? opens the dialog", self.page.run("document.getElementById('help').open"), True)
        self.page.press("Escape")
        self.checks.equal("Escape closes it", self.page.run("document.getElementById('help').open"), False)

    def all(self):
        for part in self.time, self.bodies, self.camera, self.looks:
            part()
        wanted = listed(self.page)
        self.checks.true("keys that the dialog lists", len(wanted) > 10, wanted)
        self.checks.empty("keys that the dialog lists and this test does not try", sorted(wanted - self.tried))
        self.checks.empty("keys that the dialog does not list", sorted(self.tried - wanted))
