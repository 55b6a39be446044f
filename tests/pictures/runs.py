# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs as the tests of the player read and make them, by NumPy alone: neither twinbox's reader nor its hash."""
import numpy

START, PRIME = 1469598103934665603, 0x100000001B3  # FNV-1a 64, from the start that the reference trajectories have


def load(path):
    return dict(numpy.load(path))


def states(run):
    """[frame, body, 6] float32: x, y, angle, vx, vy, omega."""
    parts = run["position"], run["angle"][..., None], run["velocity"], run["angular_velocity"][..., None]
    return numpy.concatenate(parts, axis=2).astype("<f4")


def hashes(run):
    """Of every frame, over the bytes of the dynamic bodies that exist in it, as 16 hexadecimal digits."""
    moving, found = states(run)[:, run["fixed"] == 0], {}
    there = numpy.isfinite(moving[..., 0])
    for pattern in numpy.unique(there, axis=0):
        frames = numpy.flatnonzero((there == pattern).all(axis=1))
        octets = numpy.ascontiguousarray(moving[frames][:, pattern]).view(numpy.uint8).reshape(len(frames), -1).T
        hash_ = numpy.full(len(frames), START, numpy.uint64)
        with numpy.errstate(over="ignore"):
            for row in octets.astype(numpy.uint64):
                hash_ = (hash_ ^ row) * numpy.uint64(PRIME)
        found.update(zip(frames, hash_))
    return [f"{found[frame]:016x}" for frame in range(len(moving))]


def run_hash(of_frames):
    """Of a whole run: over the bytes of its frames' hashes."""
    found = START
    for text in of_frames:
        for octet in int(text, 16).to_bytes(8, "little"):
            found = (found ^ octet) * PRIME & (1 << 64) - 1
    return f"{found:016x}"


def corners(x, y, angle, size):
    """Of a box, in metres, from (-, -) around it."""
    half = numpy.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * numpy.asarray(size, float) / 2
    c, s = numpy.cos(angle), numpy.sin(angle)
    return half @ numpy.array([[c, s], [-s, c]]) + (x, y)
