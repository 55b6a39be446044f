# SPDX-License-Identifier: GPL-3.0-or-later
# png.py FILE WIDTH HEIGHT "R G B A" [X Y "R G B A"]... [TYPE=HEX]...: an RGBA picture of one colour, with other pixels and
# with chunks before them, as no library would write it.
import struct
import sys
import zlib

path, width, height, ground = sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), bytes(map(int, sys.argv[4].split()))
extra = [argument.split("=") for argument in sys.argv[5:] if "=" in argument]
pixels = [argument for argument in sys.argv[5:] if "=" not in argument]
rows = [bytearray(ground * width) for _ in range(height)]
for x, y, color in zip(*[iter(pixels)] * 3):
    rows[int(y)][4 * int(x) : 4 * int(x) + 4] = bytes(map(int, color.split()))


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


with open(path, "wb") as file:
    file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)))
    for kind, data in extra:
        file.write(chunk(kind.encode(), bytes.fromhex(data)))
    file.write(chunk(b"IDAT", zlib.compress(b"".join(b"\0" + row for row in rows))) + chunk(b"IEND", b""))
