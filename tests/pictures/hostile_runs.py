# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs that a page must show or refuse, written by numpy.savez: formats in src/runs/README.md.

    hostile_runs.py NAME...    writes NAME.npz, or all"""
import sys

import numpy

MARKUP = "</script><img src=x onerror=alert(1)>"
COMMENT = "<!--<script>&amp;\"'`${alert(1)}"


def save(name, frames=5, bodies=3, **arrays):
    """Boxes in a row that fall, without velocities, but for what `arrays` states."""
    position = numpy.zeros((frames, bodies, 2))
    position[:, :, 0] = 1.5 * numpy.arange(bodies)
    position[:, 1:, 1] = 3 - numpy.linspace(0, 1, frames)[:, None]
    run = {"position": position, "angle": numpy.zeros((frames, bodies)), "size": numpy.ones((bodies, 2)), "dt": 1 / 60}
    run.update(arrays)
    numpy.savez(name + ".npz", **run)


def absent(frames, bodies, *gone):
    """Poses of bodies that are not there in some frames: (body, first, end)."""
    position, angle = numpy.zeros((frames, bodies, 2)), numpy.zeros((frames, bodies))
    position[..., 0], position[..., 1] = 2 * numpy.arange(bodies), numpy.linspace(2, 1.8, frames)[:, None]
    for body, first, end in gone:
        position[first:end, body], angle[first:end, body] = numpy.nan, numpy.nan
    still = {"velocity": 0 * position + 0.25, "angular_velocity": 0 * angle - 0.5}
    return {"position": position, "angle": angle, "fixed": numpy.zeros(bodies, numpy.uint8), **still}


def noise(frames, bodies):
    random = numpy.random.default_rng(1)
    return {name: random.normal(size=(frames, bodies, *shape)).astype("f4")
            for name, shape in (("position", (2,)), ("angle", ()), ("velocity", (2,)), ("angular_velocity", ()))}


def velocity_of(frames, bodies, value):
    velocity = numpy.zeros((frames, bodies, 2))
    velocity[1, 1, 0] = value
    return {"velocity": velocity, "angular_velocity": numpy.zeros((frames, bodies))}


# Name: what the run is made of.
RUNS = {
    "plain": {},
    "names": {"scene": MARKUP, "method": COMMENT},
    "letters": {"scene": "\u00dcbung \u0394\u0416", "method": "e\u0301 \u2264 " + 30 * "x"},
    "other_letters": {"scene": "\u4e2d\u6587"},
    "backwards": {"scene": "\u202eabc"},
    "many_letters": {"scene": 10000 * "s", "method": 10000 * "m"},
    "most_letters": {"scene": 127 * "s", "method": 127 * "W"},
    "control": {"scene": "a\x1b[31mb"},
    "one": {"frames": 1},
    "seven": {"bodies": 7},
    "comes": {"frames": 6, "bodies": 4, **absent(6, 4, (1, 0, 2), (2, 4, 6), (3, 0, 6))},
    "stays": {"frames": 6, "bodies": 4, **absent(6, 4)},
    "nan_velocity": velocity_of(5, 3, numpy.nan),
    "infinite": velocity_of(5, 3, numpy.inf),
    "far": {"position": numpy.full((5, 3, 2), 3e38), "angle": numpy.full((5, 3), 1e30)},
    "tiny": {"size": numpy.full((3, 2), 1e-30)},
    "wide": {"size": numpy.full((3, 2), 1e30)},
    "static": {"fixed": numpy.ones(3, numpy.uint8)},
    "other_dt": {"dt": 1 / 30},
    "many": {"frames": 4, "bodies": 5000},
    "long": {"frames": 100000, "bodies": 2},
    "too_long": {"frames": 100000, "bodies": 30, **noise(100000, 30)},
}

if __name__ == "__main__":
    for chosen in sys.argv[1:] or RUNS:
        save(chosen, **RUNS[chosen])
