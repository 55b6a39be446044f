# SPDX-License-Identifier: GPL-3.0-or-later
"""What leaves the page: links and what they restore, also malformed ones; commands; saved pictures."""
import glob
import os
import shlex
import subprocess

from keys import view

MALFORMED = ["#", "#t", "#t=", "#t=NaN", "#t=-5", "#t=1e999", "#t=x&body=y", "#body=99999", "#body=-1", "#body=1.5",
             "#body=1e308",
             "#compare=nonsense", "#compare=__proto__", "#show=,,,nonsense,<img src=x onerror=alert(1)>", "#view=1,2,3",
             "#view=0,0,0,0", "#view=NaN,1,1,1", "#view=0,0,1e-300,1", "#view=1e300,1,1,1", "#view=0,0,-4,-4",
             "#view=,,,",
             "#follow=body", "#body=2&follow=body&view=0,0,0,0", "#speed=0", "#speed=-1", "#speed=1e9", "#speed=NaN",
             "#theme=<script>alert(1)</script>", "#%", "#%E0%A4%A", "#t=0.1&t=0.2&t=", "#__proto__=1&constructor=2",
             "#run=-1",
             "#run=99", "#slow=7", "#" + "x" * 100000, "#t=" + "9" * 5000, "#&&&==&=&"]
SOUND = """(v => v.frame >= 0 && v.frame <= player.data.frames - 1 && v.speed >= 1 / 16 && v.speed <= 4 &&
  ["split", "overlay", "difference"].includes(v.compare) && ["auto", "light", "dark"].includes(v.theme) &&
  Number.isInteger(v.body) && v.body >= -1 && v.body < player.runs[0].bodies &&
  ["fit", "free", "body"].includes(v.camera.kind) &&
  Object.values(v.camera).every(x => typeof x === "string" || Number.isFinite(x)))(player.view)"""
# The canvas has the pixels of the screen, so that it is sharp and not stretched.
SHARP = """(stage => stage.width === Math.round(stage.clientWidth * devicePixelRatio) &&
  stage.height === Math.round(stage.clientHeight * devicePixelRatio))(document.getElementById("stage"))"""


def check_link(checks, browser, page):
    """What a copied link restores in another window, for states with everything and with one thing."""
    states = ["{frame: 33, body: 7, run: 1, compare: 'overlay', show: new Set(['trails', 'contacts']), speed: 0.25,"
              " theme: 'dark', camera: {kind: 'free', x: 1.25, y: 3.5, w: 8, h: 6}}",
              "{frame: 75, body: 4, run: 2, compare: 'split', show: new Set(['ghosts']), speed: 4, theme: 'light',"
              " camera: {kind: 'body', x: 0, y: 2, w: 5, h: 4}}",
              "{frame: 0, body: -1, run: 0, compare: 'difference', show: new Set(), speed: 1, theme: 'auto',"
              " camera: {kind: 'fit'}}"]
    for i, state in enumerate(states):
        page.run(f"player.change({state})")
        page.settle()
        page.click(*page.middle("#copy-link"))
        link = page.run("navigator.clipboard.readText()")
        before = view(page)
        checks.true(f"link {i} leads to the file", link.startswith(page.address + "#"), link)
        other = browser.open("three.html", fragment=link.partition("#")[2])
        other.settle()
        after = view(other)
        checks.equal(f"link {i}", {k: v for k, v in after.items() if k != "camera"},
                     {k: v for k, v in before.items() if k != "camera"})
        checks.equal(f"link {i}: camera", after["camera"]["kind"], before["camera"]["kind"])
        drawn = "(({scale, left, top}) => [scale, left, top])(player.camera(player.plan(900, 600), player.view.frame))"
        for a, b in zip(other.run(drawn), page.run(drawn)):
            checks.near(f"link {i}: what the camera shows", a, b, 1e-3 * max(1, abs(b)))
        checks.true(f"link {i}: a sharp picture", other.run(SHARP))
        checks.quiet(f"link {i}", other)
        other.close()
    page.run("location.hash = '#t=0.5&body=2'")
    page.wait("player.view.body === 2 && player.view.frame === 30")


def check_malformed(checks, browser, page):
    for link in MALFORMED:
        page.run("(async () => { const heard = new Promise(done => addEventListener('hashchange', done, {once: true})),"
                 "old = location.href; location.hash = $0; if (location.href !== old) await heard; })()", link)
        page.settle()
        checks.true(f"after {link[:60]}", page.run(SOUND), view(page))
        checks.quiet(link[:60], page)
        page.messages.clear()
    for link in "#%E0%A4%A&t=NaN&view=0,0,0,0&show=<b>", "#t=1e999&body=-7&speed=0":
        other = browser.open("three.html", fragment=link[1:])
        other.settle()
        checks.true(f"opened with {link}", other.run(SOUND), view(other))
        checks.quiet(link, other)
        other.close()


def check_command(checks, page):
    """The copied line draws this moment."""
    for patch in ("{frame: 20, compare: 'overlay', show: new Set(['trails', 'impulses']), camera: {kind: 'fit'}}",
                  "{frame: 31, compare: 'split', show: new Set(), theme: 'dark',"
                  " camera: {kind: 'free', x: 1, y: -0.5, w: 8, h: 6}}"):
        page.run(f"player.change({patch})")
        page.settle()
        page.click(*page.middle("#copy-command"))
        words = shlex.split(page.run("navigator.clipboard.readText()"))
        checks.equal("the copied command", words[0], "twinbox")
        result = subprocess.run([checks.program, *words[1:]], capture_output=True, text=True, stdin=subprocess.DEVNULL)
        checks.equal(f"exit status of {' '.join(words)}: {result.stderr[:200]}", result.returncode, 0)
        frame = view(page)["frame"]
        checks.equal("what it draws",
                     [os.path.basename(path) for path in glob.glob("*/frame_*.png") + glob.glob("frame_*.png")],
                     [f"frame_{frame:06d}.png"])
        for path in glob.glob("*/frame_*.png") + glob.glob("frame_*.png"):
            os.remove(path)


def check_saved(checks, browser, page):
    os.mkdir("saved")
    browser.call("Browser.setDownloadBehavior", behavior="allow", downloadPath=os.path.abspath("saved"),
                 eventsEnabled=False)
    page.run("player.change({frame: 12})")
    page.settle()
    page.click(*page.middle("#save"))
    path = browser.until(lambda: next((p for p in glob.glob("saved/*") if not p.endswith(".crdownload")), None),
                         "a saved picture")
    with open(path, "rb") as file:
        head = file.read(24)
    checks.true("the saved picture is a PNG", head.startswith(b"\x89PNG"), head)
    size = [int.from_bytes(head[at:at + 4], "big") for at in (16, 20)]
    checks.equal("its size", size, page.run("(s => [s.width, s.height])(document.getElementById('stage'))"))
