# SPDX-License-Identifier: GPL-3.0-or-later
"""A live page steps runs with the bits of the program: launches, drags of the bomb, settings, methods, links, commands."""
import json
import os
import random
import re
import subprocess
import urllib.parse
from concurrent.futures import ThreadPoolExecutor

from access import check_tab, check_text, check_tree
from checks import Checks
from chromium import Chromium
from page import ScriptError
import player_page

METHODS = "engine", "interior"
SCENES = "single", "stack", "pyramid", "families/gate", "families/wall"
LAUNCHES, POSITIONS = 20, 50  # of each scene; of a drag
ENDED = "player.runs.every(run => run.hash && run.reached === run.frames - 1 && run.shown === player.launched())"
FRAMED = "Object.entries(player.runs[0].framing).every(([key, value]) => player.data.framing[key] === value)"
HASHES = "player.runs.map(run => run.hash)"
PROOFS = "document.getElementById('check').textContent.split('= that of the C program').length - 1"
SHORT = r" \(|; (?!\d+ (?:of|moved) )"  # ends what a verdict says without figures
PROBLEM = "document.getElementById('problem').textContent"
BOMB = """(() => {
  const stage = document.getElementById("stage"), box = stage.getBoundingClientRect();
  const plan = player.plan(stage.clientWidth, stage.clientHeight), camera = player.camera(plan, player.view.frame);
  const {bomb, x, y, bodies} = player.runs[0], at = player.view.frame * bodies + bomb;
  const found = player.to_pixel(plan, camera, 0, x[at], y[at]);
  return [box.x + found.x, box.y + found.y];
})()"""


def state(checks, scene, method, setting):
    """What the program prints as the state of this run."""
    given = [word for each in setting.split(",") if each for word in ("--set", each)]
    done = checks.twinbox("simulate", f"{checks.scenes}/{scene}.yaml", "--method", method, *given, "--json")
    return json.loads(done.stdout)["state"]


def check_hashes(checks, page, scene, methods, what):
    """The program runs beside the page."""
    setting = page.run("player.set_text()")
    with ThreadPoolExecutor() as pool:
        states = pool.map(lambda method: state(checks, scene, method, setting), methods)
        page.wait(ENDED)
        checks.equal(f"{scene} {setting} {what}", page.run(HASHES), list(states))


def becomes(checks, page, what, script, wanted):
    """What the page shows in a later frame, or when the clipboard has it: the expression, which may be a promise."""
    try:
        page.wait(f"Promise.resolve({script}).then(found => found === {json.dumps(wanted)})")
        found = wanted
    except ScriptError:
        found = page.run(script)
    checks.equal(what, found, wanted)


def open_scene(checks, browser, scene, *methods, fragment="", **looks):
    name = scene.replace("/", "-") + ".html"
    options = [word for each in methods for word in ("--method", each)]
    checks.twinbox("page", "--live", f"{checks.scenes}/{scene}.yaml", *options, "-o", name)
    return browser.open(name, fragment, **looks)


def check_launches(checks, browser):
    launches = random.Random(1)
    for scene in SCENES:
        page = open_scene(checks, browser, scene, *METHODS)
        page.wait(ENDED)
        checks.equal(f"{scene}: proofs", page.run(PROOFS), len(METHODS))
        x = page.run("player.setup.scene.parameters.find(each => each.name === 'bomb_x')")
        for _ in range(LAUNCHES):
            page.run("player.choose('bomb_x', $0)", launches.uniform(x["from"], x["to"]))
            check_hashes(checks, page, scene, METHODS, "launched")
            checks.equal(f"{scene}: problem", page.run(PROBLEM), "")
        checks.quiet(scene, page)
        page.close()


def check_drag(checks, page):
    page.wait(ENDED)
    page.wait(FRAMED)  # a moment later; it would move the bomb from under the pointer
    page.run("player.change({frame: 8})")
    page.settle()
    x, y = page.run(BOMB)
    page.mouse("mouseMoved", x, y)
    page.mouse("mousePressed", x, y, button="left", clickCount=1)
    seen = set()
    for i in range(POSITIONS):
        page.mouse("mouseMoved", x - 4 * i, y - i % 7, button="left", buttons=1)
        check_hashes(checks, page, "stack", METHODS, "dragged")
        seen.add(page.run("player.set_text()"))
    page.mouse("mouseReleased", x, y, button="left", clickCount=1)
    checks.true("a drag goes on to new places", len(seen) > POSITIONS - 5, len(seen))
    checks.equal("a drag moves the launch, not the view", page.run("player.view.camera.kind"), "fit")


def check_controls(checks, browser):
    page = open_scene(checks, browser, "stack", *METHODS)
    check_drag(checks, page)
    page.press("j", "Shift+L", "i", "o")
    check_hashes(checks, page, "stack", METHODS, "by keys")
    page.run("player.choose('dt', 0.01)")
    check_hashes(checks, page, "stack", METHODS, "with other steps")
    becomes(checks, page, "the time of other steps", "document.getElementById('time').textContent.split(',')[0]",
            f"t = {page.run('player.view.frame') / 100:.3f} s")
    page.run("player.choose('iterations', 4)")
    page.run("player.add_panel('momentum:k=20')")
    page.wait("player.runs.length === 3")
    check_hashes(checks, page, "stack", [*METHODS, "momentum:k=20"], "with another panel")
    page.run("player.set_method(player.runs[2], 'soft-step:substeps=8')")
    check_hashes(checks, page, "stack", [*METHODS, "soft-step:substeps=8"], "with another method")
    page.run("document.getElementById('copy-command').click()")
    command = page.wait("navigator.clipboard.readText().then(text => text.startsWith('twinbox') && text)")
    page.run("player.change({frame: 20})")
    link = page.wait("location.hash.includes('t=0.2&') && location.hash.includes('methods=') &&"
                     " location.hash.includes('set=') && location.hash")
    wanted = page.run(HASHES)
    page.close()
    os.mkdir("there")
    for name in os.listdir(checks.scenes):
        os.symlink(f"{checks.scenes}/{name}", f"there/{name}")
    for each in command.split(" && ")[:3]:
        words = each.replace("twinbox", checks.program, 1).split()
        checks.true("no path of the machine", checks.scenes not in each and words[2] == "stack.yaml", each)
        done = subprocess.run([*words, "--json"], cwd="there", capture_output=True, text=True, check=True)
        checks.true("a copied command", json.loads(done.stdout)["state"] in wanted, each)
    page = browser.open("stack.html", link[1:])
    page.wait("player.runs.length === 3")
    page.wait(ENDED)
    checks.equal("a link leads to the same runs", page.run(HASHES), wanted)
    checks.equal("and to the moment", page.run("player.view.frame"), 20)
    page.run("document.querySelector('#methods button').click()")
    page.wait("player.runs.length === 2")
    page.wait(ENDED)
    checks.equal("a panel less", page.run(HASHES), wanted[1:])
    checks.quiet("controls", page)
    page.close()


def check_shell(checks, browser):
    """What a link brings is no command: names are checked, the rest is one word of a shell in one line."""
    page = open_scene(checks, browser, "stack", *METHODS)
    page.close()
    for name in "$(touch owned)", "x\ntouch owned\n#", "a;touch owned;b":
        for fragment in "set=" + urllib.parse.quote(name + "=1"), "methods=" + urllib.parse.quote("engine:k=3" + name):
            page = browser.open("stack.html", fragment)
            page.wait("!!player.setup.scene")
            if fragment.startswith("set="):
                checks.true(f"{name!r} is a problem", page.run(PROBLEM) != "")
            page.run("document.getElementById('copy-command').click()")
            command = page.wait("navigator.clipboard.readText().then(text => text.startsWith('twinbox') && text)")
            subprocess.run(["bash", "-c", command.replace("twinbox ", "true ")], capture_output=True)
            checks.true(f"{name!r} runs nothing", not os.path.exists("owned") and "\n" not in command, command)
            page.close()


def check_framing(checks, browser):
    """After a change of the scene, the view is that of the program."""
    for scene, name, values in (("stability/stack_height", "height", (4, 25)), ("stack", "bomb_x", (1.5, -2.25)),
                                ("families/gate", "bomb_y", (12, 14))):
        page = open_scene(checks, browser, scene, "engine")
        for value in values:
            page.run("player.choose($0, $1)", name, value)
            page.wait(ENDED)
            given = page.run("player.set_text()")
            checks.twinbox("simulate", f"{checks.scenes}/{scene}.yaml", *(["--set", given] if given else []), "-o", "run.npz")
            checks.twinbox("page", "run.npz", "-o", "run.html")
            recorded = player_page.data("run.html")
            wanted = recorded["framing"]
            near = (f"(found => Object.entries({json.dumps(wanted)}).every(([key, value]) =>"
                    " value === found[key] || Math.abs(value - found[key]) < 1e-6))(player.data.framing)")
            try:
                page.wait(near)
                found = wanted
            except ScriptError:
                found = page.run("player.data.framing")
            checks.equal(f"{scene}: the view with {given}", found, wanted)
            checks.equal(f"{scene}: the impact with {given}", page.run("player.data.impact"), recorded["impact"])
        page.close()


DRIVEN = """gravity: [0, -10]
dt: 1/60
iterations: $sweeps
frames: 60
parameters: {sweeps: {value: 10, from: 1, to: 100, whole: on}, side: {value: 3, from: -5, to: 5, unit: m}, load: {value: 20, from: 1, to: 90}}
bodies:
  - {static: true, size: [100, 20], position: [0, -10]}
  - {mass: 1, size: [1, 1], position: [0, 0.5]}
bomb: {frame: 20, x: $side, y: 10, size: [1, 1], mass: $load, velocity: {times_position: -1.5}}
"""
FIELDS = """Object.fromEntries([...document.querySelectorAll('#settings input:not([type=range])')].map(each =>
  [each.ariaLabel.split(",")[0].replace(" ", "_"), Number(each.value)]))"""


def check_driven(checks, browser):
    """Where a parameter drives a number that every scene has, its field has what the run has, and a drag begins there."""
    with open("driven.yaml", "w", encoding="utf-8") as file:
        file.write(DRIVEN)
    checks.twinbox("page", "--live", "driven.yaml", "--method", "engine", "-o", "driven.html")
    page = browser.open("driven.html")
    page.wait(ENDED)
    for name, driven, value in ("sweeps", "iterations", 50), ("side", "bomb_x", -2), ("load", "bomb_mass", 7):
        page.run("player.choose($0, $1)", name, value)
        page.wait(ENDED)
        fields = page.run(FIELDS)
        checks.equal(f"{driven} as {name} has it", [fields[name], fields[driven]], [value, value])
    page.run("player.change({frame: 22})")
    page.wait(FRAMED)
    page.settle()
    x, y = page.run(BOMB)
    page.mouse("mouseMoved", x, y)
    page.mouse("mousePressed", x, y, button="left", clickCount=1)
    page.mouse("mouseMoved", x + 4, y, button="left", buttons=1)
    page.mouse("mouseReleased", x + 4, y, button="left", clickCount=1)
    page.wait(ENDED)
    checks.near("bomb_x after a drag of 4 pixels", page.run(FIELDS)["bomb_x"], -2, 0.4)
    page.run("player.choose('bomb_x', 3)")  # the file's, but not what it has now without this choice
    page.wait(ENDED)
    checks.near("the bomb begins where its field says", page.run("player.runs[0].x[20 * 3 + 2]"), 3, 1e-6)
    page.close()


def check_approach(checks, browser):
    """A question shows the way of a bomb that is not there yet: pixels of its colour."""
    page = browser.open("driven.html", "stage", width=1920, height=1080)
    page.wait(ENDED)
    red = """(() => {
      player.draw();
      const stage = document.getElementById("stage"), all = stage.getContext("2d").getImageData(0, 0, stage.width, stage.height).data;
      let count = 0;
      for (let i = 0; i < all.length; i += 4) count += all[i] > 120 && all[i + 1] < all[i] / 2 && all[i + 2] < all[i] / 2;
      return count;
    })()"""
    checks.equal("no bomb in frame 0", page.run(red), 0)
    page.run("location.hash = '#stage&predict=1'")
    becomes(checks, page, "a link asks", "document.body.classList.contains('asked')", True)
    page.settle()
    page.wait(ENDED)
    page.settle()
    checks.true("the bomb's way before a prediction", page.run(red) > 50, page.run(red))
    checks.true("the question grows with the stage",
                page.run("parseFloat(getComputedStyle(document.getElementById('question')).fontSize)") > 20)
    page.press("1")
    page.run("player.change({frame: 0, playing: false})")
    page.settle()
    checks.equal("answered: no way", page.run(red), 0)
    page.close()


def check_prediction(checks, browser):
    page = open_scene(checks, browser, "stack", "engine", "pair-net")
    page.wait(ENDED)
    page.run("document.getElementById('predict').click()")
    page.settle()
    checks.equal("nothing is told", page.run("getComputedStyle(document.getElementById('summary')).display"), "none")
    page.press("2")
    said = page.run("document.getElementById('question').textContent")
    words = page.run("player.runs[1].ended")
    checks.equal("the answer is the verdict", said, f"You said pair-net. It {words.split(' (')[0]}.")
    page.run("player.choose('bomb_mass', 1)")
    checks.equal("another launch has no answer", page.run("document.getElementById('question').textContent"), "")
    page.run("document.getElementById('predict').click()")
    page.press("1")  # its run may not have ended
    page.wait(ENDED)
    words = page.run("player.runs[0].ended")
    checks.equal("the answer when the run has ended", page.run("document.getElementById('question').textContent"),
                 f"You said engine. It {re.split(SHORT, words)[0]}.")
    page.run("location.hash = '#predict=1'")
    becomes(checks, page, "a link asks", "document.body.classList.contains('asked') && document.getElementById('predict').checked",
            True)
    page.close()


def check_colours(checks, browser):
    """Panels of one method, by a link or by hand, have colours of their own."""
    page = open_scene(checks, browser, "stack", "engine", "interior", fragment="methods=engine:k=1;engine:k=2;engine:k=3")
    page.wait(ENDED)
    page.run("player.add_panel()")
    page.settle()
    fills = page.run("player.runs.map(run => run.colours.light.fill)")
    checks.true("colours of four panels of one method", len(fills) == len(set(fills)) == 4, fills)
    page.close()


def tab_to(page, condition):
    """Presses Tab until the focused element e is this one."""
    for _ in range(200):
        page.press("Tab")
        if page.run(f"(e => e !== document.body && Boolean({condition}))(document.activeElement)"):
            return
    raise ScriptError(f"the Tab key does not reach {condition}")


def check_access(checks, browser):
    """Names, sizes and contrast of all that a live page adds; the Tab key reaches it in its order, and is seen."""
    with open(os.path.join(checks.sources, "tests/pictures/audit.js")) as file:
        page = open_scene(checks, browser, "stack", *METHODS, before=file.read())
    page.wait(ENDED)
    page.run("document.querySelectorAll('details').forEach(all => { all.open = true; })")
    for width, height in (1440, 900), (390, 844):
        for dark in False, True:
            what = f"{width} {'dark' if dark else 'light'}"
            page.resize(width, height)
            page.prefer(dark, False)
            page.settle()
            check_tree(checks, page, what)
            check_text(checks, page, what)
            checks.empty(f"{what}: wider than the window", page.run("audit.wide()"))
        check_tab(checks, page, str(width))
    checks.empty("controls too small for a finger (24 px)", page.run("audit.small()"))
    page.close()


def check_keyboard(checks, browser):
    """A reading with no other device: launches, settings, methods, panels, a prediction, time, a link."""
    page = open_scene(checks, browser, "stack", *METHODS)
    page.wait(ENDED)
    first = page.run(HASHES)
    tab_to(page, "e.id === 'stage'")
    page.press("l", "Shift+J", "i", "u")
    check_hashes(checks, page, "stack", METHODS, "by keys on the picture")
    tab_to(page, "e.id === 'scrubber'")
    page.press("ArrowRight", "ArrowRight", "PageUp")
    checks.equal("the frame by keys", page.run("player.view.frame"), 12)
    tab_to(page, "e.type === 'number' && e.ariaLabel === 'bomb mass, kg'")
    page.press("Control+a", "9", "Enter")
    checks.true("a setting that is typed", "bomb_mass=9" in page.run("player.set_text()"), page.run("player.set_text()"))
    tab_to(page, "e.type === 'range' && e.ariaLabel === 'friction'")
    before = page.run("player.set_text()")
    page.press("ArrowRight")
    checks.true("a slider", page.run("player.set_text()") != before, before)
    check_hashes(checks, page, "stack", METHODS, "set by keys")
    tab_to(page, "e.ariaLabel === 'Method' && e.value === 'interior'")
    page.press("m")
    page.wait("player.runs[1].live === 'momentum'")
    checks.equal("the focus stays at the method", page.run("document.activeElement.value"), "momentum")
    tab_to(page, "e.tagName === 'SUMMARY' && e.closest('[role=group]').ariaLabel === 'Panel 2'")
    page.press("Enter")
    tab_to(page, "e.closest('label')?.textContent === 'k'")
    page.press("7", "Tab")
    check_hashes(checks, page, "stack", ["engine", "momentum:k=7"], "with a method by keys")
    tab_to(page, "e.id === 'add'")
    page.press("Enter")
    page.wait("player.runs.length === 3")
    tab_to(page, "e.ariaLabel === 'Remove momentum:k=7'")
    page.press("Enter")
    page.wait("player.runs.length === 2")
    checks.equal("the focus stays near", page.run("document.activeElement.closest('#methods') !== null"), True)
    check_hashes(checks, page, "stack", ["engine", "engine"], "a panel by keys, and one less")
    tab_to(page, "e.id === 'predict'")
    page.press("Space", "1")
    said = page.run("document.getElementById('question').textContent")
    checks.true("a prediction by keys", said.startswith("You said engine. It "), said)
    tab_to(page, "e.id === 'copy-link'")
    page.press("Enter")
    becomes(checks, page, "a link by keys", "navigator.clipboard.readText().then(text => text.includes('bomb_mass%3D9'))", True)
    tab_to(page, "e.id === 'reset'")
    page.press("Enter")
    page.wait(ENDED)
    checks.equal("as at first", page.run(HASHES), [first[0], first[0]])
    checks.quiet("keyboard", page)
    page.close()


def check_rubbish(checks, browser):
    for fragment, words in (("set=x=1e999", "x=1e999"), ("set=bomb_x=NaN", "bomb_x=NaN"), ("set=<b>=1", "is no setting"),
                            ("methods=egnine", "did you mean 'engine'"), ("methods=engine:k=0", "k: error"),
                            ("set=bomb_speed=-1", "bomb_speed must be")):
        page = browser.open("stack.html", fragment)
        found = page.wait(PROBLEM)
        checks.true(f"#{fragment}", words in found, found)
        page.wait("player.ready(player.view.frame)")  # whatever there is to see is drawn
        page.close()
    with open("stack.html", encoding="utf-8") as file:
        text = file.read()
    with open("damaged.html", "w", encoding="utf-8") as file:
        file.write(re.sub('(id="module">)[^<]*', r"\1AAAA", text))
    page = browser.open("damaged.html", "t=1")
    checks.true("a damaged module", "cannot be stepped" in page.wait(PROBLEM), page.run(PROBLEM))
    page.wait("player.ready(player.view.frame)")
    page.close()
    for fragment in "x=1e999", "t=-1e999&body=-1e9&view=,,&run=7", "t=NaN&show=<b>&speed=0", "%%%&&==&t=":
        page = browser.open("stack.html", fragment)
        page.wait(ENDED)
        checks.equal(f"#{fragment}", [page.run(PROBLEM), page.run("player.view.frame"), page.run(PROOFS)], ["", 0, 2])
        page.close()


def check_beginning(checks, browser):
    """Before a worker has sent a state, only verdicts are known."""
    idle = "window.Worker = class { postMessage() {} };"
    page = open_scene(checks, browser, "stack", "engine", "pair-net", before=idle)
    told = page.run("['summary', 'check'].map(id => document.getElementById(id).textContent)")
    checks.true("verdicts", "explodes" in told[0], told[0])
    for claim in "parts from", "stays with", "equals engine", "hash":
        checks.true(f"not known yet: {claim}", not any(claim in text for text in told), told)
    page.close()


def main():
    with Checks() as checks, Chromium("!!window.player?.data") as browser:
        browser.allow("clipboardReadWrite", "clipboardSanitizedWrite")
        check_launches(checks, browser)
        check_beginning(checks, browser)
        check_controls(checks, browser)
        check_shell(checks, browser)
        check_framing(checks, browser)
        check_access(checks, browser)
        check_keyboard(checks, browser)
        check_driven(checks, browser)
        check_approach(checks, browser)
        check_prediction(checks, browser)
        check_colours(checks, browser)
        check_rubbish(checks, browser)


main()
