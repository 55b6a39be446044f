# SPDX-License-Identifier: GPL-3.0-or-later
"""The page's canvas beside render's frame of the same moment. Two rasterisers smooth an edge in two ways, so a pixel counts where
no edge is near: where all of render's pixels within REACH have its colour. There the page must have this colour, within 1 of 255:
a browser has 255 shades of an edge, the shader 51, so that an edge can reach a pixel in one of them only. What is near an edge is
held to a mean (pictures.difference)."""
import json
import os

import numpy

import pictures
from checks import Checks
from chromium import Chromium

SIZE = 1280, 720
REACH = 2             # pixels
MOST_INSIDE = 1       # of 255
LEAST_INTERIOR = 0.5  # of a panel's pixels
MOST_OF_PANEL = 1.5   # of 255, the mean difference of a panel
RUNS = "golden/trajectories/{}-engine.npz", "golden/trajectories/{}-pair-net.npz"
GO_TO = """new Promise(done => {
  if (location.hash === $0) return done();
  addEventListener("hashchange", () => done(), {once: true});
  location.hash = $0;
})"""
ALL = "all"  # marks that a page has: more than the browser's font, where it is wider, has in render's rows
# scene, frame, compare, show, theme, view
CASES = [
    ("stack", 40, "split", "", "light", ""),
    ("stack", 40, "split", "", "dark", ""),
    ("stack", 40, "split", "trails", "light", ""),
    ("stack", 40, "split", ALL, "dark", ""),
    ("stack", 70, "overlay", "", "light", ""),
    ("stack", 70, "overlay", "trails", "dark", "0,2,6,5"),
    ("stack", 30, "difference", "", "light", "0,3,4,3"),
    ("single", 33, "split", "", "light", ""),
    ("pyramid", 30, "split", "", "light", ""),
    ("pyramid", 60, "difference", "velocities", "dark", ""),
    ("pyramid", 60, "split", "ghosts,contacts,impulses", "light", "0,1.5,6,4"),
    ("pyramid", 60, "split", "modes", "dark", "0,1.5,6,4"),
    ("pyramid_settled", 200, "split", "distance", "light", ""),
    ("pyramid_settled", 180, "split", "distance", "dark", "0,3,12,8"),
]


def interior(picture):
    """Pixels whose neighbours within REACH have their colour: rows of equal pixels that are equal to the rows beside them."""
    red, green, blue = (picture[..., i].astype("uint32") for i in range(3))
    colours, (height, width) = red << 16 | green << 8 | blue, picture.shape[:2]
    inner, rows = slice(REACH, width - REACH), range(-REACH, REACH + 1)
    level = numpy.logical_and.reduce([colours[:, REACH + x:width - REACH + x] == colours[:, inner] for x in rows if x != 0])
    flat = numpy.zeros((height, width), bool)
    of = [slice(REACH + y, height - REACH + y) for y in rows]
    flat[REACH:height - REACH, inner] = numpy.logical_and.reduce(
        [level[each] & (colours[each, inner] == colours[of[REACH], inner]) for each in of])
    return flat


def differ_inside(wanted, found, flat):
    return flat & (abs(wanted - found) > MOST_INSIDE).any(axis=2)


def describe(rendered, drawn, wrong):
    """The pixel in the middle of what is wrong, with its colours."""
    places = numpy.argwhere(wrong)
    y, x = places[len(places) // 2]
    colours = ["#" + "".join(f"{int(part):02x}" for part in picture[y, x]) for picture in (rendered, drawn)]
    return f"{len(places)} pixels, one at ({x}, {y}): {colours[1]}, not {colours[0]}"


def compare(checks, what, rendered, drawn, panels):
    """Panel by panel. The colours that were found inside."""
    colours = set()
    for i, (x, y, width, height) in enumerate(panels):
        wanted, found = (picture[y:y + height, x:x + width] for picture in (rendered, drawn))
        flat = interior(wanted)
        wrong = differ_inside(wanted, found, flat)
        checks.true(f"{what}, panel {i}: interior pixels", flat.mean() > LEAST_INTERIOR, flat.mean())
        checks.true(f"{what}, panel {i}: pixels inside that differ", not wrong.any(),
                    wrong.any() and describe(wanted, found, wrong))
        checks.near(f"{what}, panel {i}: mean difference", pictures.difference(wanted, found, 0, 0, width, height), 0,
                    MOST_OF_PANEL)
        colours |= set(map(tuple, wanted[flat].astype(int)))
    return colours


def options_of(compare_by, show, theme, view, camera):
    given = ("compare", compare_by), ("show", show), ("theme", theme), (camera, view)
    return [(key, value) for key, value in given if value]


def check(checks, page, files, frame, compare_by, show, theme, view, size=SIZE):
    """One moment in both: the pictures, where their panels are, and the colours inside."""
    show = page.run("Object.keys(player.data.shows).join()") if show == ALL else show
    what = f"{os.path.basename(files[0])} frame {frame} {compare_by} {show} {theme} {view}"
    render = [word for key, value in options_of(compare_by, show, theme, view, "camera") for word in ("--" + key, value)]
    checks.twinbox("render", *files, "-o", "drawn", "--size", "x".join(map(str, size)), "--frames", frame, *render)
    with open("drawn/manifest.json") as file:
        panels = [panel["rectangle"] for panel in json.load(file)["view"]["panels"]]
    fragment = "&".join(f"{key}={value}" for key, value in options_of(compare_by, show, theme, view, "view"))
    page.run(GO_TO, "#" + fragment)
    page.settle()
    rendered, drawn = pictures.read(f"drawn/frame_{frame:06d}.png"), pictures.draw(page, *size, frame)
    colours = compare(checks, what, rendered, drawn, panels)
    checks.quiet(what, page)
    return rendered, drawn, panels, colours


def pages_of(checks, browser, cases):
    """Each page once, with the cases that it has."""
    for scene in sorted({case[0] for case in cases}):
        files = [file.format(scene) for file in RUNS]
        checks.twinbox("page", *files, "-o", "page.html")
        page = browser.open("page.html")
        yield files, page, [case[1:] for case in cases if case[0] == scene]
        page.close()


COLUMNS, ROWS = 20, 12  # of boxes so large that bands have an inside


def write_scale():
    """Two runs of boxes on a grid; in the first each is 1 mm to 12 m higher: all colours of the scale, of boxes and bands."""
    at = numpy.stack(numpy.meshgrid(numpy.arange(COLUMNS), numpy.arange(ROWS)), axis=2).reshape(-1, 2) * 1.25
    up = numpy.stack([numpy.zeros(len(at)), numpy.geomspace(1e-3, 12, len(at))], axis=1)
    for name, places in ("first", at + up), ("second", at):
        run = numpy.repeat(places[None].astype("float32"), 2, axis=0)
        numpy.savez(f"{name}.npz", position=run, angle=numpy.zeros(run.shape[:2], "float32"), dt=numpy.float32(1 / 60),
                    size=numpy.ones((len(at), 2), "float32"), fixed=numpy.zeros(len(at), "uint8"))
    return ["first.npz", "second.npz"]


def check_scale(checks, browser):
    files = write_scale()
    checks.twinbox("page", *files, "-o", "page.html")
    page = browser.open("page.html")
    for theme in "light", "dark":
        *_, colours = check(checks, page, files, 1, "split", "distance", theme, "11.875,6.875,26,16", (2560, 1440))
        checks.true(f"colours of the scale, {theme}", len(colours) > COLUMNS * ROWS, len(colours))


def modes(run, step):
    """The contacts of a step by bodies and feature: 0 open, 1 sticks, 2 slips."""
    found = {}
    for i in range(*run["contact_start"][step:step + 2]):
        a, b = run["contact_bodies"][i]
        point, (nx, ny), (normal, _) = (run[name][i].astype(float) for name in ("contact_point", "contact_normal", "contact_impulse"))
        speeds = []
        for body in a, b:
            x, y = point - run["position"][step - 1, body]
            w = float(run["angular_velocity"][step, body])
            speeds.append(run["velocity"][step, body].astype(float) + (-w * y, w * x))
        x, y = speeds[1] - speeds[0]
        found[int(a), int(b), int(run["contact_feature"][i])] = 0 if not normal > 0 else 2 if abs(x * ny - y * nx) > 0.01 else 1
    return found


def check_modes(checks, browser):
    """The page counts as NumPy does the contacts that do the same in the run of the reference; and those of its pictures are alike."""
    files = [f"golden/{name}.npz" for name in ("trajectories/stack-engine", "gallery/stack-interior", "gallery/stack-reference")]
    loaded = [numpy.load(file) for file in files]
    checks.twinbox("page", *files, "-o", "page.html")
    page, counts = browser.open("page.html"), set()
    for frame in 20, 33, 34, 36, 40, 75:
        page.run("player.change({frame: $0, show: new Set(['modes'])})", frame)
        page.wait(f"player.ready({frame})")
        page.settle()
        *others, reference = (modes(run, min(frame + 1, len(run["angle"]) - 1)) for run in loaded)
        for i, own in enumerate(others):
            keys = {*own, *reference}
            wanted = f"{sum(own.get(key, 0) == reference.get(key, 0) for key in keys)} of {len(keys)} contacts as the reference"
            checks.equal(f"frame {frame}, run {i}", page.run(f"player.mode_count({i})"), wanted)
            counts.add(wanted)
    checks.true("counts differ", len(counts) > 6, counts)
    check(checks, page, files, 36, "split", "modes", "light", "0,5,8,11")


def check_sight(checks, rendered, drawn, panels):
    """Pictures that are not alike: a box's band that is three pixels lower, by moving a row of pixels of the whole panel."""
    x, y, width, height = panels[0]
    moved = drawn.copy()
    moved[y + 3:y + height, x:x + width] = drawn[y:y + height - 3, x:x + width]
    wanted, found = (picture[y:y + height, x:x + width] for picture in (rendered, moved))
    checks.true("a panel that is three pixels lower is seen", differ_inside(wanted, found, interior(wanted)).any())


def main():
    with Checks() as checks, Chromium("!!window.player?.data") as browser:
        os.symlink(f"{checks.sources}/golden", "golden")
        for files, page, cases in pages_of(checks, browser, CASES):
            for case in cases:
                rendered, drawn, panels, _ = check(checks, page, files, *case)
        check_sight(checks, rendered, drawn, panels)
        check_scale(checks, browser)
        check_modes(checks, browser)


main()
