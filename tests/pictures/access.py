# SPDX-License-Identifier: GPL-3.0-or-later
"""Landmarks, names, text (sizes and contrast, audit.js), the Tab key, reduced motion; both widths, both themes."""
import os

from checks import Checks
from chromium import Chromium

CONTROLS = {"button", "checkbox", "radio", "combobox", "slider", "spinbutton", "link", "textbox", "listbox", "menuitem",
            "tab"}
NAMED = CONTROLS | {"image", "img", "Canvas", "figure", "dialog", "region", "radiogroup"}
MOST_STOPS = 300


def tree(page):
    """(role, name) of everything that a screen reader is told of."""
    page.call("Accessibility.enable")
    nodes = page.call("Accessibility.getFullAXTree")["nodes"]
    found = [(node["role"]["value"], node.get("name", {}).get("value",
                                                              "").strip()) for node in nodes if not node["ignored"]]
    page.call("Accessibility.disable")
    return found


def check_tree(checks, page, what):
    found = tree(page)
    roles = [role for role, _ in found]
    for landmark in "main", "banner":
        checks.equal(f"{what}: landmarks '{landmark}'", roles.count(landmark), 1)
    checks.true(f"{what}: controls", len(CONTROLS.intersection(roles)) >= 4, roles)
    checks.empty(f"{what}: without a name", [role for role, name in found if role in NAMED and not name])
    checks.empty(f"{what}: pictures that are no named images", page.run("audit.pictures()"))
    checks.equal(f"{what}: headings of the first level", page.run("[...document.querySelectorAll('h1')].length"), 1)
    checks.empty(f"{what}: ids that two elements have", page.run("audit.ids()"))


def check_text(checks, page, what):
    found = page.run("audit.text()")
    checks.true(f"{what}: texts", found["count"] > 20, found["count"])
    checks.empty(f"{what}: text", found["faults"])


def check_canvas(checks, page, what):
    page.run("audit.drawn.length = 0")
    page.run("player.draw()")
    page.settle()
    drawn = page.run("audit.drawn")
    checks.true(f"{what}: texts on canvases", len(drawn) > 5, len(drawn))
    checks.empty(f"{what}: text on canvases", sorted({text["fault"] for text in drawn if text["fault"]}))


def check_tab(checks, page, what):
    """Every control is reached, in a ring, and each shows that it has the focus."""
    wanted, reached, unseen = page.run("audit.stops()"), [], []
    page.run("document.activeElement.blur()")
    for _ in range(MOST_STOPS):
        page.press("Tab")
        found = page.run("audit.focused()")
        if found is None or (reached and found["name"] == reached[0]):
            break
        reached.append(found["name"])
        if not found["ring"]:
            unseen.append(found["name"])
    checks.true(f"{what}: the Tab key comes round", len(reached) < MOST_STOPS)
    checks.true(f"{what}: controls", len(wanted) > 10, wanted)
    checks.empty(f"{what}: not reached by the Tab key", [name for name in wanted if name not in reached])
    checks.empty(f"{what}: focus that is not seen", unseen)


def check_looks(checks, browser, audit):
    """Everything open, so that every text is there: a pinned body, all marks, all ways of comparing, the dialog."""
    page = browser.open("three.html", before=audit, clock=True)
    for width, height in (1440, 900), (390, 844):
        for dark in False, True:
            what = f"{width} {'dark' if dark else 'light'}"
            page.resize(width, height)
            page.prefer(dark, False)
            for compare in "split", "overlay", "difference":
                page.run("player.change({compare: $0, body: 4, frame: 40, show: new Set(Object.keys(player.data.shows))})", compare)
                page.settle()
                check_text(checks, page, f"{what} {compare}")
                check_canvas(checks, page, f"{what} {compare}")
            checks.empty(f"{what}: wider than the window", page.run("audit.wide()"))
            page.press("?")
            check_text(checks, page, f"{what} with the dialog")
            page.press("Escape")
            check_tree(checks, page, what)
            checks.equal(f"{what}: theme",
                         page.run("(c => c[0] + c[1] + c[2] < 384)(getComputedStyle(document.body).backgroundColor"
                                                    ".match(/[\\d.]+/g).map(Number))"), dark)
        check_tab(checks, page, f"{width}")
    checks.empty("controls too small for a finger (24 px)", page.run("audit.small()"))
    checks.quiet("the page", type("Seen", (), {"requests": page.requests, "messages": [
        text for text in page.messages if "willReadFrequently" not in text]}))  # audit.js reads pixels
    page.close()


def check_motion(checks, browser):
    page = browser.open("three.html", still=True)
    page.wait("player.ready(0)")
    page.press("End", "Home", "?")
    page.settle()
    checks.equal("animations with reduced motion", page.run("document.getAnimations().length"), 0)
    checks.equal("plays by itself with reduced motion", page.run("player.view.playing"), False)
    page.close()


def main():
    with Checks() as checks, Chromium("!!window.player?.data") as browser:
        for method in "engine", "pair-net", "momentum":
            checks.twinbox("simulate", f"{checks.scenes}/stack.yaml", "--frames", 75, "--method", method, "-o",
                           f"{method}.npz")
        checks.twinbox("page", "engine.npz", "pair-net.npz", "momentum.npz", "-o", "three.html")
        with open(os.path.join(checks.sources, "tests/pictures/audit.js")) as file:
            check_looks(checks, browser, file.read())
        check_motion(checks, browser)


if __name__ == "__main__":
    main()
