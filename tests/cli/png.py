# SPDX-License-Identifier: GPL-3.0-or-later
# png.py FILE WIDTH HEIGHT COLOUR [X Y COLOUR]... [TYPE=HEX]...: an RGBA picture of one colour, with other pixels and with chunks
# before them, as no library would write it. COLOUR: "R G B A", or one number for an opaque grey. X*N: N pixels from X on.
# png.py -: each line of standard input is such arguments.
import shlex
import struct
import sys
import zlib


def colour(text):
    numbers = bytes(map(int, text.split()))
    return numbers if len(numbers) == 4 else numbers * 3 + b"\xff"


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def draw(path, width, height, ground, *more):
    rows = [bytearray(colour(ground) * int(width)) for _ in range(int(height))]
    for x, y, text in zip(*[iter(word for word in more if "=" not in word)] * 3):
        first, _, count = x.partition("*")
        pixels = colour(text) * int(count or 1)
        rows[int(y)][4 * int(first) : 4 * int(first) + len(pixels)] = pixels
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", int(width), int(height), 8, 6, 0, 0, 0)))
        for word in more:
            if "=" in word:
                file.write(chunk(word.partition("=")[0].encode(), bytes.fromhex(word.partition("=")[2])))
        file.write(chunk(b"IDAT", zlib.compress(b"".join(b"\0" + row for row in rows))) + chunk(b"IEND", b""))


for line in sys.stdin.read().splitlines() if sys.argv[1:] == ["-"] else [shlex.join(sys.argv[1:])]:
    draw(*shlex.split(line))
