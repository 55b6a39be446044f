#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# compare reads common pictures row by row. It finds what it finds in whole pictures, in little memory whatever the height; and
# what is damaged is refused in little memory, too. (Rows of all kinds of PNG files: tests/pixels/test_png_fast.c.)
. "$(dirname "$0")/checks.sh"

cat >pictures.py <<'PYTHON'
import os, random, struct, sys, zlib
def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
def write(path, header, packed, before=b""):
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", *header)) + before)
        file.write(chunk(b"IDAT", packed) + chunk(b"IEND", b""))
PASSES = [(0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2)]
def disc(x, y, cx, cy, radius):
    return min(max(radius - ((x - cx) ** 2 + (y - cy) ** 2) ** 0.5 + 0.5, 0), 1)
def scenes(folder):
    """Grey discs on a gradient with some texture, some of them moved; each pair of pictures in several encodings."""
    draw = random.Random(2)
    encodings = {"grey": (0, 8, 0), "rgb": (2, 8, 0), "rgba": (6, 8, 0), "deep": (2, 16, 0), "interlaced": (2, 8, 1), "grey-interlaced": (0, 8, 1)}
    for number in range(30):
        width, height = draw.randint(60, 400), draw.randint(40, 160)
        slope, texture = draw.choice((0, 0, 1, 2)), draw.choice((1, 1, 9))
        ground = [[60 + slope * y // 4 + draw.randrange(texture) for x in range(width)] for y in range(height)]
        discs = [[(draw.uniform(0, width), draw.uniform(0, height), draw.uniform(2, 14), draw.randrange(120, 256))] * 2 for _ in range(4)]
        for pair in discs[:draw.randint(1, 3)]:
            x, y, radius, grey = pair[0]
            pair[1] = (x + draw.choice((0.2, 6)), y + draw.uniform(-0.2, 0.2), radius, grey)
        for side in 0, 1:
            picture = [row[:] for row in ground]
            for pair in discs:
                cx, cy, radius, grey = pair[side]
                for y in range(max(0, int(cy - radius) - 1), min(height, int(cy + radius) + 2)):
                    for x in range(max(0, int(cx - radius) - 1), min(width, int(cx + radius) + 2)):
                        picture[y][x] += round((grey - picture[y][x]) * disc(x, y, cx, cy, radius))
            for name, (color, depth, interlaced) in encodings.items():
                pixel = [bytes([grey]) * ((1 if color == 0 else 3) * depth // 8) + (b"\xff" if color == 6 else b"") for grey in range(256)]
                rows = []
                for left, top, dx, dy in PASSES if interlaced else [(0, 0, 1, 1)]:
                    if left < width:
                        rows += [b"\0" + b"".join(map(pixel.__getitem__, picture[y][left::dx])) for y in range(top, height, dy)]
                to = os.path.join(folder, name, "ea"[side])
                os.makedirs(to, exist_ok=True)
                write(os.path.join(to, f"case-{number}x.png"), (width, height, depth, color, 0, 0, interlaced), zlib.compress(b"".join(rows), 1))
def zeros(path, width, height, bytes_of_pixel, color, level=1, rows=None, damage=False, interlace=0):
    packer, row = zlib.compressobj(level), bytes(1 + width * bytes_of_pixel)
    packed = b"".join(packer.compress(row * 50) for _ in range((height if rows is None else rows) // 50)) + packer.flush()
    if damage:
        packed = packed[:-1] + bytes([packed[-1] ^ 1])
    write(path, (width, height, 8, color, 0, 0, interlace), packed)
if sys.argv[1] == "scenes":
    scenes("scenes")
else:
    zeros("a.png", 10000, 10000, 4, 6)
    zeros("b.png", 10000, 10000, 4, 6, level=2)
    zeros("opaque.png", 10000, 10000, 3, 2)
    zeros("sum.png", 10000, 10000, 4, 6, damage=True)
    zeros("short.png", 10000, 10000, 4, 6, rows=9950)
    zeros("long.png", 10000, 10000, 4, 6, rows=12000)
    zeros("few.png", 10000, 10000, 4, 6, rows=100)
    zeros("interlaced.png", 10000, 10000, 4, 6, rows=12000, interlace=1)
PYTHON

# Equal pixels have equal regions, however they are encoded.
/usr/bin/python3 pictures.py scenes || fail "no scenes"
for encoding in scenes/*; do
    run 1 compare "$encoding/e" "$encoding/a" --json
    mv out "$encoding.json"
done
/usr/bin/python3 - <<'PYTHON' || fail "regions depend on the encoding"
import glob, json
KEYS = "differing", "beyond", "largest", "box", "region_count"
found = {path: {frame["name"]: frame["regions"] for frame in json.load(open(path))["frames"]} for path in glob.glob("scenes/*.json")}
first = found["scenes/rgb.json"]
edges = sum(region["name"] == "noise along edges" for regions in first.values() for region in regions)
assert len(found) == 6 and len(first) == 30 and 10 < edges < sum(map(len, first.values())) - 10, (edges, first)
counts = {path: [[frame[key] for key in KEYS] for frame in json.load(open(path))["frames"]] for path in found if "deep" not in path}
for path, rows in counts.items(): # interlaced pictures are compared as a whole
    assert rows == counts["scenes/rgb.json"], path
for path, regions in found.items():
    assert regions == first, (path, [(name, first[name], regions[name]) for name in first if first[name] != regions[name]][:1])
PYTHON

brief && finish

# peak STATUS A B: compares, and prints the peak of memory in MB and the processor time in ms.
peak() {
    /usr/bin/python3 - "$twinbox" "$@" <<'PYTHON'
import os, resource, subprocess, sys
program, status, a, b = sys.argv[1:]
got = subprocess.run([program, "compare", a, b], stdout=open("out", "w"), stderr=open("err", "w")).returncode
usage = resource.getrusage(resource.RUSAGE_CHILDREN)
print(usage.ru_maxrss // 1024, round(1000 * (usage.ru_utime + usage.ru_stime)))
sys.exit(got != int(status))
PYTHON
}

/usr/bin/python3 pictures.py large || fail "no large pictures"
while read -r status a b text; do
    used=$(peak "$status" $a.png $b.png) || fail "$a and $b: $(cat out err)"
    cat out err | grep -qF -- "$text" || fail "$a and $b: no '$text': $(cat out err)"
    [ "${used% *}" -le 64 ] || fail "$a and $b: ${used% *} MB"
    echo "$a and $b: MB and ms of processor time: $used"
done <<'CASES'
0 a b equal
1 a opaque 100000000 pixels differ
2 a sum incorrect data check
2 a short Not enough image data
2 a long more pixels than the header states
2 a few too few bytes for its pixels
2 a interlaced more pixels than the header states
CASES
finish
