# SPDX-License-Identifier: GPL-3.0-or-later
# Pairs of pictures for the benchmark of compare: charts, frames and noisy photographs, written as libpng writes them.
import os
import struct
import zlib

import numpy

SIZES = {"1080p": (1920, 1080), "4K": (3840, 2160), "17.9 MP": (5184, 3456), "100 MP": (10000, 10000)}
KINDS = "chart", "frame", "photo"
CASES = "equal", "other bytes", "region", "everything"
BAND = 64  # rows


def chart(x, y, width, height):
    """Lines, marks and boxes of text on white; flat but for edges."""
    curve = 0.5 + 0.3 * numpy.sin(12 * x / width)
    ink = numpy.clip(2 - numpy.abs(y - curve * height), 0, 1)
    grid = ((x % (width // 10) == 0) | (y % (height // 10) == 0)) * 0.2
    rows = (y // 24) % 5 == 0
    text = rows & ((x * 2654435761 >> 7 ^ y * 40503) % 5 == 0) & (x > 0.7 * width)
    grey = 255 * (1 - numpy.maximum(numpy.maximum(ink, grid), text * 0.9))
    return numpy.stack([grey, grey, 255 - 0.5 * (255 - grey)], axis=-1).astype(numpy.uint8)


def frame(x, y, width, height):
    """Boxes with outlines on a ground, as twinbox draws them."""
    side = width // 24
    inner, row = x % side, y % side
    edge = (inner < 3) | (row < 3)
    shade = ((x // side + y // side) % 5) * 12
    box = y > height // 3
    base = numpy.where(box, numpy.where(edge, 30, 120 + shade), 250)
    return numpy.stack([base, numpy.where(box, base * 3 // 4, 250), numpy.where(box, 200 - shade, 252)], axis=-1).astype(numpy.uint8)


def photo(x, y, width, height, noise):
    """Slow colours with the noise of a sensor."""
    base = 120 + 80 * numpy.sin(5 * x / width + 3 * y / height)
    colours = numpy.stack([base, base * 0.8 + 20, 200 - base * 0.5], axis=-1)
    return numpy.clip(colours + noise.normal(0, 4, colours.shape), 0, 255).astype(numpy.uint8)


def filtered(band, above):
    """The rows of a band with the filter of least sum of absolute values, as libpng chooses it."""
    left = numpy.zeros_like(band)
    left[:, 1:] = band[:, :-1]
    up = numpy.concatenate([above, band[:-1]])
    corner = numpy.zeros_like(up)
    corner[:, 1:] = up[:, :-1]
    a, b, c = (part.astype(numpy.int16) for part in (left, up, corner))
    p = a + b - c
    to_a, to_b, to_c = abs(p - a), abs(p - b), abs(p - c)
    paeth = numpy.where((to_a <= to_b) & (to_a <= to_c), a, numpy.where(to_b <= to_c, b, c)).astype(numpy.uint8)
    count = band.shape[0]
    choices = numpy.stack([part.reshape(count, -1) for part in
                           (band, band - left, band - up, band - ((a + b) // 2).astype(numpy.uint8), band - paeth)])
    cost = numpy.abs(choices.view(numpy.int8).astype(numpy.int32)).sum(axis=2)
    best = cost.argmin(axis=0)
    rows = choices[best, numpy.arange(count)]
    return numpy.concatenate([best.astype(numpy.uint8)[:, None], rows], axis=1).tobytes()


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def write(path, kind, size, case, level):
    width, height = size
    noise = numpy.random.default_rng(1)
    x = numpy.arange(width)[None, :]
    packer, above = zlib.compressobj(level), numpy.zeros((1, width, 3), numpy.uint8)
    with open(path + ".part", "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)))
        for top in range(0, height, BAND):
            y = numpy.arange(top, min(top + BAND, height))[:, None]
            band = photo(x, y, width, height, noise) if kind == "photo" else {"chart": chart, "frame": frame}[kind](x, y, width, height)
            if case == "region" and height // 2 <= top < height // 2 + height // 10:
                band[:, width // 3 : width // 2] ^= 64
            if case == "everything":
                band ^= 33
            data = packer.compress(filtered(band, above))
            above = band[-1:]
            for at in range(0, len(data), 8192):
                file.write(chunk(b"IDAT", data[at : at + 8192]))
        data = packer.flush()
        file.write(chunk(b"IDAT", data) + chunk(b"IEND", b""))
    os.rename(path + ".part", path)


def pair(folder, kind, size, case):
    """The two files, which are kept."""
    def made(of, level=6):
        path = os.path.join(folder, f"{kind}-{size.replace(' ', '')}-{of.replace(' ', '-')}.png")
        if not os.path.exists(path):
            write(path, kind, SIZES[size], of, level)
        return path
    first = made("first")
    if case == "equal":
        copy = first.replace("-first", "-equal")
        if not os.path.exists(copy):
            with open(first, "rb") as source, open(copy, "wb") as file:
                file.write(source.read())
        return first, copy
    return first, made(case, 9 if case == "other bytes" and kind != "photo" else 5 if case == "other bytes" else 6)
