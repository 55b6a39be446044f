#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# compare reads common pictures row by row. It finds what it finds in whole pictures (--flip needs them), in little memory
# whatever the height; and what is damaged is refused in little memory, too.
. "$(dirname "$0")/checks.sh"

cat >pictures.py <<'PYTHON'
import os, random, struct, sys, zlib
def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
def write(path, header, packed, before=b""):
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", *header)) + before)
        file.write(chunk(b"IDAT", packed) + chunk(b"IEND", b""))
CHANNELS = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}
KINDS = [(0, 1), (0, 2), (0, 4), (0, 8), (0, 16), (2, 8), (2, 16), (3, 1), (3, 2), (3, 4), (3, 8), (4, 8), (4, 16), (6, 8), (6, 16)]
PASSES = [(0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2)]
def kinds(folders):
    """A picture of each kind, interlaced or not, with a transparent colour or not; its other has some bytes changed."""
    draw = random.Random(1)
    for color, depth in KINDS:
        for interlaced in 0, 1:
            for clear in range(1 if color > 3 else 2):
                width, height = draw.randint(150, 250), draw.randint(90, 140)
                parts = PASSES if interlaced else [(0, 0, 1, 1)]
                rows = []
                for left, top, dx, dy in parts:
                    across, down = (width - left + dx - 1) // dx, (height - top + dy - 1) // dy
                    size = (across * CHANNELS[color] * depth + 7) // 8
                    rows += [bytearray([draw.choice((0, 0, 1, 2, 3, 4)) if y else 0]) + bytes(draw.choice((0, 0, 0, 255, draw.randrange(256))) for _ in range(size)) for y in range(down)]
                before = chunk(b"PLTE", bytes(draw.randrange(256) for _ in range(3 << depth))) if color == 3 else b""
                if clear:
                    before += chunk(b"tRNS", bytes({0: 2, 2: 6, 3: 2}[color]))
                for side, folder in enumerate(folders):
                    for _ in range(0 if side == 0 else draw.choice((0, 1, 3, 60))):
                        row = draw.choice(rows)
                        if len(row) > 1:
                            row[draw.randrange(1, len(row))] ^= draw.choice((1, 0x10, 0x80))
                    name = f"c{color}-b{depth}-i{interlaced}-t{clear}.png"
                    write(os.path.join(folder, name), (width, height, depth, color, 0, 0, interlaced), zlib.compress(b"".join(rows), draw.randint(1, 9)), before)
def disc(x, y, cx, cy, radius):
    return min(max(radius - ((x - cx) ** 2 + (y - cy) ** 2) ** 0.5 + 0.5, 0), 1)
def scenes(folder):
    """Grey discs on a gradient with some texture, some of them moved; each pair of pictures in several encodings."""
    draw = random.Random(2)
    encodings = {"grey": (0, 8, 0), "rgb": (2, 8, 0), "rgba": (6, 8, 0), "deep": (2, 16, 0), "interlaced": (2, 8, 1), "grey-interlaced": (0, 8, 1)}
    for number in range(32):
        width, height = draw.randint(60, 400), draw.randint(40, 160)
        slope, texture = draw.choice((0, 0, 1, 2)), draw.choice((1, 1, 9))
        ground = [[60 + slope * y // 4 + draw.randrange(texture) for x in range(width)] for y in range(height)]
        discs = [[(draw.uniform(0, width), draw.uniform(0, height), draw.uniform(2, 14), draw.randrange(120, 256))] * 2 for _ in range(4)]
        for pair in discs[:draw.randint(1, 3)]:
            x, y, radius, grey = pair[0]
            pair[1] = (x + draw.uniform(-6, 6), y + draw.uniform(-6, 6), radius, grey)
        for side in 0, 1:
            picture = [row[:] for row in ground]
            if number >= 30: # all of it is shifted, and most of it differs
                discs = []
                picture = [[(x - 2 * side) * (x - 2 * side) * (y + 70 - 3 * side) // 7 % 251 for x in range(width)] for y in range(height)]
            for pair in discs:
                cx, cy, radius, grey = pair[side]
                for y in range(max(0, int(cy - radius) - 1), min(height, int(cy + radius) + 2)):
                    for x in range(max(0, int(cx - radius) - 1), min(width, int(cx + radius) + 2)):
                        picture[y][x] += round((grey - picture[y][x]) * disc(x, y, cx, cy, radius))
            for name, (color, depth, interlaced) in encodings.items():
                pixel = lambda grey: bytes([grey]) * ((1 if color == 0 else 3) * depth // 8) + (b"\xff" if color == 6 else b"")
                rows = []
                for left, top, dx, dy in PASSES if interlaced else [(0, 0, 1, 1)]:
                    if left < width:
                        rows += [b"\0" + b"".join(pixel(grey) for grey in picture[y][left::dx]) for y in range(top, height, dy)]
                to = os.path.join(folder, name, "ea"[side])
                os.makedirs(to, exist_ok=True)
                write(os.path.join(to, f"case-{number}x.png"), (width, height, depth, color, 0, 0, interlaced), zlib.compress(b"".join(rows), 1))
def zeros(path, width, height, bytes_of_pixel, color, level=1, rows=None, damage=False, interlace=0):
    packer, row = zlib.compressobj(level), bytes(1 + width * bytes_of_pixel)
    packed = b"".join(packer.compress(row * 50) for _ in range((height if rows is None else rows) // 50)) + packer.flush()
    if damage:
        packed = packed[:-1] + bytes([packed[-1] ^ 1])
    write(path, (width, height, 8, color, 0, 0, interlace), packed)
if sys.argv[1] == "kinds":
    kinds(sys.argv[2:])
elif sys.argv[1] == "scenes":
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

mkdir expected actual
/usr/bin/python3 pictures.py kinds expected actual || fail "no pictures"
run 1 compare expected actual --json
mv out rows.json
run 1 compare expected actual --flip 0 --json # frames that pass have no names
mv out whole.json
run 1 compare expected actual --flip 0 --json --tolerance 20
mv out whole20.json
run 1 compare expected actual --json --tolerance 20
mv out rows20.json
/usr/bin/python3 - <<'PYTHON' || fail "rows and whole pictures differ"
import json, os
for frame in json.load(open("rows.json"))["frames"]:
    for side in "expected", "actual":
        assert frame[side]["size"] == os.path.getsize(os.path.join(side, frame[side]["name"])), frame[side]
def frames(path):
    return {frame["name"]: {key: frame[key] for key in ("differing", "beyond", "largest", "box", "region_count", "regions")}
            for frame in json.load(open(path))["frames"]}
for tolerance in "", "20":
    rows, whole = frames(f"rows{tolerance}.json"), frames(f"whole{tolerance}.json")
    for frame in [*rows.values(), *whole.values()] if tolerance else []: # those that pass have no names
        frame["regions"] = [(region["box"], region["pixels"]) for region in frame["regions"]]
    assert len(rows) == 52 and rows == whole, (len(rows), [(name, rows[name], whole[name]) for name in rows if rows[name] != whole[name]][:2])
    assert 20 < sum(frame["differing"] > 0 for frame in rows.values()) < 52
PYTHON

# Equal pixels have equal names, however they are encoded.
/usr/bin/python3 pictures.py scenes || fail "no scenes"
for encoding in scenes/*; do
    run 1 compare "$encoding/e" "$encoding/a" --json
    mv out "$encoding.json"
done
/usr/bin/python3 - <<'PYTHON' || fail "names depend on the encoding"
import glob, json
found = {path: {frame["name"]: frame["regions"] for frame in json.load(open(path))["frames"]} for path in glob.glob("scenes/*.json")}
first = found["scenes/rgb.json"]
assert len(found) == 6 and len(first) == 32 and sum(region["kind"] == "moved" for regions in first.values() for region in regions) > 20, first
for name in "case-30x.png", "case-31x.png":
    assert [region["name"] for region in first[name]] == ["moved 2.0 px right and 3.0 px down"], first[name]
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
