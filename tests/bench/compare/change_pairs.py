#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Pairs of pictures with known changes, for the benchmark of named changes. Arguments: the program twinbox, a folder, and the seeds
# (A:B, B excluded). Writes FOLDER/SOURCE/KIND/SEED.a.png and .b.png, and FOLDER/truth.json: a list of pairs. Same seed, same pair.
#
# The renderer makes the change: an element is absent, elsewhere, of another colour, or another one is in its place. Its box is that
# of the pixels which differ when this change alone is made; of a movement, the boxes where the element is seen before and after,
# which are found by drawing the picture without it. Noise is made on pixels, or by other settings of the rasterizer.
# One pair in seven has a second change of another kind. A pair of 'removed' is one of 'added', swapped.
import dataclasses
import io
import json
import os
import sys
import tempfile

import numpy
from PIL import Image

from change_sources import ROOT, Charts, Frames, Pages

sys.path.insert(0, os.path.join(ROOT, "tests", "browser"))
from chromium import Chromium  # noqa: E402

KINDS = "added", "removed", "moved", "recoloured", "replaced", "noise"
OPPOSITE = {"added": "removed", "removed": "added"}
MIXED = 1 / 7
LARGEST = 1 / 3  # of the picture: what changes more of it has changed a scale
APART = 16  # px between two changes of a pair
VISIBLE = 16, 10  # a change makes a channel differ by more than the first in at least so many pixels


def differing(a, b):
    """left, top, right, bottom of the pixels that differ, and how many do visibly."""
    levels = numpy.abs(a.astype(int) - b).max(axis=2)
    rows, columns = (numpy.flatnonzero(levels.any(axis=axis)) for axis in (1, 0))
    if len(rows) == 0:
        return None, 0
    box = [int(of) for of in (columns[0], rows[0], columns[-1] + 1, rows[-1] + 1)]
    return box, int((levels > VISIBLE[0]).sum())


def union(a, b):
    return [min(a[0], b[0]), min(a[1], b[1]), max(a[2], b[2]), max(a[3], b[3])]


def distance(rng, box, subpixel):
    """A movement in pixels, and its name: far means that the element does not overlap where it was."""
    how = str(rng.choice(["pixel", "overlap", "far", "sub-pixel" if subpixel else "far"]))
    width, height = box[2] - box[0], box[3] - box[1]
    sign, along = rng.choice([-1, 1], 2), int(rng.integers(2))
    if how == "pixel":
        return how, [float(sign[0]) if along == axis else 0.0 for axis in (0, 1)]
    if how == "sub-pixel":
        return how, [float(sign[k] * rng.choice([0.25, 0.5, 0.75, 1.5] if axis in subpixel else [0, 1])) for k, axis in enumerate("xy")]
    if how == "overlap":
        return how, [float(sign[axis] * rng.integers(1, max(2, size // 2 + 1))) for axis, size in enumerate((width, height))]
    shift = [float(sign[axis] * rng.integers(0, 60)) for axis in (0, 1)]
    shift[along] = float(sign[along] * ((width, height)[along] + rng.integers(2, 80)))
    return how, shift


def change(rng, source, elements, kind):
    """Which element changes, how it is before and after, and what is true of that; None if this draw makes no such change."""
    able = {"added": lambda e: e.removable, "moved": lambda e: e.movable, "recoloured": lambda e: len(e.colours) > 1,
            "replaced": lambda e: len(e.contents) > 1}[kind]
    kinds = sorted({e.kind for e in elements if able(e)})
    if not kinds:
        return None
    wanted = rng.choice(kinds)  # of each kind of element as often, however many there are
    i = int(rng.choice([i for i, e in enumerate(elements) if e.kind == wanted and able(e)]))
    before = after = elements[i]
    truth = {"kind": kind, "element": before.kind}

    def draw(element):
        return source.draw([*elements[:i], element, *elements[i + 1 :]])

    without = draw(dataclasses.replace(before, shown=False)) if kind in ("added", "moved") else None
    picture = draw(before)
    if kind == "added":
        truth["box"], seen = differing(without, picture)
        before = dataclasses.replace(before, shown=False)
    elif kind == "moved":
        place, seen = differing(without, picture)
        if seen < VISIBLE[1]:
            return None
        truth["how"], (dx, dy) = distance(rng, place, before.subpixel)
        after = dataclasses.replace(before, dx=dx, dy=dy)
        moved = draw(after)
        new, _ = differing(without, moved)
        if new is None or any(abs(new[k + 2] - new[k] - place[k + 2] + place[k]) > 1 for k in (0, 1)):
            return None  # partly out of the picture, or hidden
        truth.update({"from": place, "to": new, "box": union(place, new), "right_px": dx, "down_px": dy})
        seen = differing(picture, moved)[1]
    else:
        field = "colours" if kind == "recoloured" else "contents"
        values = getattr(before, field)
        after = dataclasses.replace(before, **{field: (values[rng.integers(1, len(values))],)})
        truth["box"], seen = differing(picture, draw(after))
    left, top, right, bottom = truth.get("from", truth["box"]) or (0, 0, 0, 0)
    fits = (right - left) * (bottom - top) <= LARGEST * picture.shape[0] * picture.shape[1]
    return (i, before, after, truth) if seen >= VISIBLE[1] and fits else None


def jpeg(rng, picture):
    file = io.BytesIO()
    Image.fromarray(picture).save(file, "JPEG", quality=int(rng.integers(88, 97)), subsampling=0)
    return numpy.asarray(Image.open(file))


def levels(rng, picture):
    """A few levels up or down, everywhere or in a fifth of the pixels."""
    most = rng.integers(1, 4)
    where = rng.random(picture.shape[:2]) < rng.choice([0.2, 1])
    return picture + rng.integers(-most, most + 1, picture.shape) * where[..., None]


def dither(_, picture):
    pattern = numpy.array([[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]]) // 4 - 2
    return picture + numpy.tile(pattern, [-(-of // 4) for of in picture.shape[:2]])[: picture.shape[0], : picture.shape[1], None]


def edges(rng, picture):
    """Antialiasing of other samples: pixels of edges take up to a seventh of a neighbour's colour."""
    share = rng.uniform(0, 1 / 7, picture.shape[:2])[..., None]
    return picture + share * (numpy.roll(picture.astype(int), rng.choice([-1, 1]), rng.integers(2)) - picture)


def noisy(rng, source, elements, picture):
    """The picture with noise, and the name of it."""
    makers = {"JPEG": jpeg, "levels": levels, "dither": dither, "edges": edges, **({"renderer": None} if source.variants else {})}
    how = str(rng.choice(list(makers)))
    made = source.draw(elements, variant=True) if how == "renderer" else makers[how](rng, picture)
    return how, numpy.clip(numpy.round(made), 0, 255).astype(numpy.uint8)


def pair(rng, source, kind):
    """Two pictures and the changes that they differ by."""
    elements = source.begin(rng)
    kinds = [kind]
    if rng.random() < MIXED:
        kinds.append(str(rng.choice([of for of in KINDS if of not in (kind, "removed")])))
    before, after, changes = list(elements), list(elements), []
    for of in kinds:
        for _ in range(20 if of != "noise" else 0):
            made = change(rng, source, elements, of)
            if made and not any(overlap(made[3]["box"], other["box"]) for other in changes):
                i, before[i], after[i], truth = made
                changes.append(truth)
                break
    a, b = source.draw(before), source.draw(after)
    outside = numpy.abs(a.astype(int) - b).max(axis=2)
    for truth in changes:
        left, top, right, bottom = truth["box"]
        outside[top:bottom, left:right] = 0
    assert not outside.any(), (kind, changes)
    if "noise" in kinds:
        how, b = noisy(rng, source, after, b)
        changes.append({"kind": "noise", "how": how, "box": differing(a, b)[0]})
    if len(changes) < len(kinds) or None in [truth["box"] for truth in changes]:
        return pair(rng, source, kind)
    return a, b, changes


def overlap(a, b):
    return all(a[k] < b[k + 2] + APART and b[k] < a[k + 2] + APART for k in (0, 1))


def swapped(changes):
    """The changes from b to a."""
    back = []
    for truth in changes:
        truth = {**truth, "kind": OPPOSITE.get(truth["kind"], truth["kind"])}
        if truth["kind"] == "moved":
            truth.update({"from": truth["to"], "to": truth["from"], "right_px": -truth["right_px"], "down_px": -truth["down_px"]})
        back.append(truth)
    return back


def main():
    twinbox, folder, (first, end) = os.path.abspath(sys.argv[1]), sys.argv[2], map(int, sys.argv[3].split(":"))
    pairs = []

    def save(source, kind, seed, a, b, changes):
        path = os.path.join(source, kind, str(seed))
        os.makedirs(os.path.dirname(os.path.join(folder, path)), exist_ok=True)
        for side, picture in ("a", a), ("b", b):
            Image.fromarray(picture).save(os.path.join(folder, f"{path}.{side}.png"), compress_level=1)
        pairs.append({"source": source, "kind": kind, "seed": seed, "a": path + ".a.png", "b": path + ".b.png", "changes": changes})

    with tempfile.TemporaryDirectory() as scratch, Chromium() as browser:
        sources = {"frames": Frames(twinbox, scratch), "charts": Charts(), "pages": Pages(browser, scratch)}
        for number, (name, source) in enumerate(sources.items()):
            for kind in KINDS:
                for seed in range(first, end):
                    if kind != "removed":
                        made = pair(numpy.random.default_rng([seed, number, KINDS.index(kind)]), source, kind)
                        save(name, kind, seed, *made)
                    if kind == "added":
                        save(name, "removed", seed, made[1], made[0], swapped(made[2]))
    with open(os.path.join(folder, "truth.json"), "w") as file:
        json.dump(pairs, file, indent=1)


if __name__ == "__main__":
    main()
