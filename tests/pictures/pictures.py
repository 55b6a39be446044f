# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures as arrays, and how far boxes are from where another picture has them: a measure of pixels, which knows no
camera but where to look."""
import base64
import struct
import subprocess

import numpy

import runs

DRAW = """(async () => {
  const stage = document.getElementById("stage");
  stage.style.cssText = `position: fixed; left: 0; top: 0; width: ${$0}px; height: ${$1}px`;
  await player.load($2);
  player.change({frame: $2, body: -1});
  player.draw();
  return stage.toDataURL().split(",")[1];
})()"""
REACH = 3       # pixels in which a box is searched
ROOM = 4        # pixels around a box that belong to its patch
SMALLEST = 6    # pixels; smaller boxes have too few to measure
LEAST = 0.5     # correlation of two patches of one box, at least
# Of 255: the mean difference of a box's patch, and of a panel. Two rasterisers that put edges elsewhere within a pixel differ
# by up to 3 around a box; a box without its band by 6.
MOST_OF_BOX, MOST_OF_PANEL = 5, 1.5


def decode(data):
    """A PNG file: height, width, RGB."""
    width, height = struct.unpack(">II", data[16:24])
    command = "ffmpeg", "-v", "error", "-f", "png_pipe", "-i", "-", "-f", "rawvideo", "-pix_fmt", "rgb24", "-"
    pixels = subprocess.run(command, input=data, stdout=subprocess.PIPE, check=True).stdout
    return numpy.frombuffer(pixels, numpy.uint8).reshape(height, width, 3).astype(float)


def read(path):
    with open(path, "rb") as file:
        return decode(file.read())


def draw(page, width, height, frame):
    """What the page draws on its canvas in this size. As a PNG file it comes through the browser's pipe in a hundredth of the
    time that its pixels take."""
    return decode(base64.b64decode(page.run(DRAW, width, height, frame)))


def correlation(a, b):
    a, b = a - a.mean(), b - b.mean()
    return (a * b).sum() / max(1e-9, numpy.sqrt((a * a).sum() * (b * b).sum()))


def offset(before, at, after):
    """Where the parabola through three values has its top, in steps from the middle one."""
    return 0.0 if 2 * at <= before + after else (after - before) / (2 * (2 * at - before - after))


def difference(golden, drawn, left, top, right, bottom):
    """The mean of a part of two pictures, of the channel that differs most."""
    return numpy.abs(golden[top:bottom, left:right] - drawn[top:bottom, left:right]).mean(axis=(0, 1)).max()


def displacement(golden, drawn, left, top, right, bottom):
    """By how many pixels a patch of a grey picture has moved, and how alike it is there. None: alike nowhere near."""
    patch, found = golden[top:bottom, left:right], {}

    def likeness(x, y):
        if (x, y) not in found:
            found[x, y] = correlation(patch, drawn[top + y:bottom + y, left + x:right + x])
        return found[x, y]

    x = y = 0
    if likeness(0, 0) < max(LEAST, *(likeness(*step) for step in ((-1, 0), (1, 0), (0, -1), (0, 1)))):
        reach = range(-REACH, REACH + 1)
        x, y = max(((x, y) for x in reach for y in reach), key=lambda place: likeness(*place))
    best = likeness(x, y)
    if best < LEAST or max(abs(x), abs(y)) == REACH:
        return None, best
    return (x + offset(likeness(x - 1, y), best, likeness(x + 1, y)),
            y + offset(likeness(x, y - 1), best, likeness(x, y + 1))), best


def moved_boxes(golden, drawn, panels, loaded, frame):
    """Boxes that the two pictures have more than half a pixel apart, or in other colours; panels that differ; and the
    number of boxes that were measured."""
    moved, measured, grey = [], 0, [picture.mean(axis=2) for picture in (golden, drawn)]
    for panel, (view, run) in enumerate(zip(panels, loaded)):
        x, y, width, height = view["rectangle"]
        different = difference(golden, drawn, x, y, x + width, y + height)
        if different > MOST_OF_PANEL:
            moved.append(f"panel {panel} differs by {different:.2f} in the mean")
        for body in numpy.flatnonzero(run["fixed"] == 0):
            pose = run["position"][frame, body], run["angle"][frame, body]
            if not numpy.isfinite(pose[1]) or view["scale"] * run["size"][body].min() < SMALLEST:
                continue
            pixels = runs.corners(*pose[0], pose[1], run["size"][body]) * (view["scale"], -view["scale"])
            pixels += x + view["left"], y + view["top"]
            (left, top), (right, bottom) = numpy.floor(pixels.min(axis=0)) - ROOM, numpy.ceil(pixels.max(axis=0)) + ROOM
            if left < x + REACH or top < y + REACH or right > x + width - REACH or bottom > y + height - REACH:
                continue
            measured += 1
            patch = tuple(map(int, (left, top, right, bottom)))
            (shift, likeness), different = displacement(*grey, *patch), difference(golden, drawn, *patch)
            if shift is None or max(map(abs, shift)) > 0.5:
                moved.append(f"panel {panel} body {body} by {shift}, likeness {likeness:.2f}")
            elif different > MOST_OF_BOX:
                moved.append(f"panel {panel} body {body} looks otherwise, by {different:.1f} in the mean")
    return moved, measured
