#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What compare prints and writes about what changed: regions, names, causes, counts, cameras.
. "$(dirname "$0")/checks.sh"

run 0 simulate "$scenes/stack.yaml" --frames 40 -o a.npz
/usr/bin/python3 - <<'PYTHON'
import numpy
run = dict(numpy.load("a.npz", allow_pickle=False))
run["camera"] = numpy.array([[0, 5], [18, 12]], numpy.float32)
numpy.savez("a.npz", **run)
run["position"][3:6, 7, 0] += 0.05 # below the bomb, which has not arrived
run["position"][8, 4, 1] += 1
numpy.savez("b.npz", **run)
run["camera"] = numpy.array([[0, 5], [20, 14]], numpy.float32)
numpy.savez("c.npz", **run)
run = dict(numpy.load("a.npz", allow_pickle=False))
run["scene"] = numpy.array("pile")
numpy.savez("d.npz", **run)
PYTHON
render() { run 0 render "$1" -o "$2" --size 640x360 --frames 0:9; }
render a.npz a
render a.npz same
render b.npz b
run 0 compare a same
says "equal: 10 frames, 1 trajectory"

# One line for each cause, then counts; frames of equal states are equal, whatever the run does.
run 1 compare a b --report report
says "first difference: frame_000003.png: "
says "states differ in panel 1: body 7 moved 1."
says " of them differ: body 7 moved 1."
says "frames 3 to 5, 8: states differ, body 7 first"
says "4 of 10 frames differ, 1 of 1 trajectory differs"
says "verdict: physics changed"
[ "$(grep -c 'of them differ' out)" -le 3 ] || fail "more than three regions are printed"
/usr/bin/python3 - <<'PYTHON' || fail "results.json or junit.xml lacks regions, names or causes"
import json, xml.etree.ElementTree
results = json.load(open("report/results.json"))
assert results["causes"] == ["frames 3 to 5, 8: states differ, body 7 first"], results["causes"]
for number, frame in enumerate(results["frames"]):
    changed = number in (3, 4, 5, 8)
    assert frame["verdict"] == ("physics changed" if changed else "equal"), frame
    assert (frame["region_count"] > 0) == changed == (len(frame["regions"]) > 0)
    body = "body 4 moved" if number == 8 else "body 7 moved"
    assert all(region["name"].startswith(body) for region in frame["regions"]), frame["regions"]
    sizes = [region["pixels"] for region in frame["regions"]]
    assert sizes == sorted(sizes, reverse=True) and sum(sizes) == frame["differing"]
    for left, top, right, bottom in (region["box"] for region in frame["regions"]):
        assert frame["box"][0] <= left < right <= frame["box"][2] and frame["box"][1] <= top < bottom <= frame["box"][3]
suite = xml.etree.ElementTree.parse("report/junit.xml").getroot()
text = suite[3].find("failure").text
assert "of them differ: body 7 moved" in text, text
PYTHON

# The same pictures without a change of the run: the body is named by its place.
mkdir seen
cp a/*.png a/*.npz a/manifest.json seen
/usr/bin/python3 - <<'PYTHON'
# The pixels of b with the texts of a, as from another renderer.
import struct
def chunks(path):
    data, at = open(path, "rb").read(), 8
    while at < len(data):
        size = struct.unpack(">I", data[at : at + 4])[0] + 12
        yield data[at + 4 : at + 8], data[at : at + size]
        at += size
with open("seen/frame_000004.png", "wb") as file:
    file.write(b"\x89PNG\r\n\x1a\n")
    texts = [chunk for kind, chunk in chunks("a/frame_000004.png") if kind in (b"tEXt", b"iTXt")]
    for kind, chunk in chunks("b/frame_000004.png"):
        if kind not in (b"tEXt", b"iTXt"): file.write(chunk)
        if kind == b"IHDR": file.writelines(texts)
PYTHON
run 1 compare a seen
says "renderer changed first in frame_000004.png"
says "frame 4: body 7 changed"
says "1 of 10 frames differs"
says "verdict: renderer changed"

# Texts. Cards have no parts.
render d.npz d
run 1 compare a d
says "frames 0 to 9: header"
says " of them differ: header"
says "10 of 10 frames differ"
run 0 render a.npz -o card --size 640x360 --frames 0:0 --title Old
run 0 render a.npz -o other_card --size 640x360 --frames 0:0 --title New
run 1 compare card other_card
says "frames 0 to 119: replaced"

# Other cameras come first, and name the option that avoids them.
render c.npz c
run 1 compare a c
equal "the camera is the first line" "$(head -1 out | cut -d: -f1,2)" "frames 0 to 9: the camera differs"
says "; render with --view-from a/stack-engine.npz"
says "verdict: physics changed"
cp a/stack-engine.npz c # the run of a, but the camera of c
run 1 compare a c
says "the camera differs"

# Hostile manifests give no names of bodies, and no failure.
for text in '' '{' '[]' '{"size": [640, 360], "view": 1}' '{"view": {"panels": [], "parts": []}}' \
    '{"size": [640, 360], "view": {"panels": [{"rectangle": [0, 0, 1e9, 1], "runs": ["../a.npz"], "scale": 1, "left": 0, "top": 0}], "parts": []}}' \
    '{"size": [640, 360], "view": {"panels": [{"rectangle": [0, 0, 640, 999], "runs": ["a.npz"], "scale": 1, "left": 0, "top": 0}], "parts": []}}'; do
    echo "$text" >seen/manifest.json
    run 1 compare a seen
    says "frame 4: content moved at most 1."
done

# A picture of noise has as many regions as pixels allow; three are printed.
mkdir noise.a noise.b
/usr/bin/python3 - <<'PYTHON'
import random, struct, zlib
chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
random.seed(1)
for folder in "ab":
    rows = b"".join(b"\0" + bytes(255 * (random.random() < 0.005) for _ in range(1000)) for _ in range(1000))
    with open(f"noise.{folder}/1.png", "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 1000, 1000, 8, 0, 0, 0, 0)))
        file.write(chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
PYTHON
run 1 compare noise.a noise.b
equal "regions of noise" "$(grep -c 'of them differ' out)" 3
grep -q 'and [0-9]* more regions' out || fail "the other regions are not counted: $(cat out)"
finish
