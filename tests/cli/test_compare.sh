#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
tests=$(cd "$(dirname "$0")" && pwd)
. "$tests/checks.sh"

run 0 simulate "$scenes/stack.yaml" --frames 40 -o a.npz
run 0 simulate "$scenes/stack.yaml" --frames 40 --bomb-x 1 -o b.npz
run 0 simulate "$scenes/stack.yaml" --frames 30 -o short.npz
run 0 simulate "$scenes/single.yaml" --frames 40 -o other.npz
run 0 compare a.npz a.npz
says "equal: 41 frames of 12 bodies"
run 1 compare a.npz b.npz
says "first difference: frame 0, body 11 (the bomb):"
run 1 compare a.npz short.npz
says "41"
says "31"
run 1 compare a.npz other.npz
says "bodies"

/usr/bin/python3 - <<'PYTHON'
# One bit of one body in one frame.
import numpy
run = dict(numpy.load("a.npz", allow_pickle=False))
run["angle"].view(numpy.uint32)[17, 4] ^= 1
numpy.savez("bit.npz", **run)
PYTHON
run 1 compare a.npz bit.npz
says "first difference: frame 17, body 4: 0 m apart"

render() { run 0 render "$1" -o "$2" --size 160x90 --frames 0:4; }
render a.npz one
render a.npz two
render b.npz three
run 0 compare one two
says "equal: 5 frames"
run 1 compare one three
says "first difference: frame_000000.png:"
says "5 of 5 frames differ"
says "physics changed first in stack-engine.npz: from frame 0, body 11: "
says "verdict: physics changed"
mv two/frame_000003.png two/frame_000007.png
run 1 compare one two
says "only in one: 1 frame: frame_000003.png"
says "only in two: 1 frame: frame_000007.png"
says "verdict: 1 frame missing, 1 frame extra"
run 0 compare one/frame_000002.png two/frame_000002.png
head -c 300 one/frame_000001.png >two/frame_000001.png
run 2 compare one two
complains "two/frame_000001.png"
head -c 200 one/frame_000001.png >two/frame_000002.png
run 2 compare one two
complains "two/frame_000001.png"
complains "(further frames that cannot be compared: 1)"
says "not comparable: two/frame_000002.png: error: "
says "only in two: 1 frame: frame_000007.png"
says "verdict: 1 frame missing, 1 frame extra, 2 frames not comparable"

# What cannot be read hides nothing: all others are compared and reported, and it is not approved.
mkdir good bad
for name in a b c; do /usr/bin/python3 "$tests/png.py" good/$name.png 20 10 "9 9 9 255"; done
cp good/a.png bad
/usr/bin/python3 "$tests/png.py" bad/b.png 20 10 "99 9 9 255"
head -c 60 good/c.png >bad/c.png
run 2 compare good bad --report unread
says "differs: b.png: 200 pixels differ"
says "1 of 2 frames differs"
complains "bad/c.png: error: not a PNG file, or damaged"
grep -q '"name": "c.png", "verdict": "not comparable", "failed": true, "shown": false' unread/results.json || fail "c.png is not in the results"
grep -q '"different": 1, .*"not_comparable": 1' unread/results.json || fail "counts: $(grep counts unread/results.json)"
for file in report.html junit.xml results.tap; do grep -q 'c\.png' unread/$file || fail "c.png is not in $file"; done
cp good/c.png kept.png
run 1 approve unread # b.png is, c.png is not
equal "an expected picture whose actual one cannot be read" "$(md5sum <good/c.png)" "$(md5sum <kept.png)"
run 2 compare good bad
complains "bad/c.png"

# Pictures of other programs: no states, other names, other depths.
png() { /usr/bin/python3 "$tests/png.py" "$@"; }
mkdir theirs ours
png theirs/shot-1.png 20 10 "9 9 9 255"
png theirs/shot-2.png 20 10 "9 9 9 255"
png ours/frame_0001.png 20 10 "9 9 9 255"
png ours/frame_0002.png 20 10 "9 9 9 255" 3 4 "9 12 9 255" 5 4 "9 9 8 255"
run 1 compare theirs ours
says "first difference: shot-2.png: 2 pixels differ (1%) by at most 3, first at (3, 4)"
says "verdict: pictures differ (cause unknown: no states)"
run 1 compare theirs/shot-2.png ours/frame_0002.png
png ours/frame_0002.png 20 11 "9 9 9 255"
run 1 compare theirs ours
says "20 x 10 and 20 x 11 pixels"
png ours/frame_0002.png 20 10 "9 9 9 255" 3 4 "9 12 9 255" 5 4 "9 9 8 255"

# Both bounds must hold, and what lies on one is within.
for passing in 3,0.01 255,1 4,0.5; do
    run 0 compare theirs ours --fuzzy $passing
    says "passed: 2 frames, 1 of them not equal, but within tolerance"
done
for failing in 2,0.01 3,0.009 255,0 0,1; do run 1 compare theirs ours --fuzzy $failing; done
for wrong in 3 3, ,1 3,1.5 256,1 -1,1 3,0.1,7 x,y; do
    run 2 compare theirs ours --fuzzy=$wrong
    complains "--fuzzy: error: '$wrong' is not MAX,SHARE"
done

# Masks: each hides one of the two pixels.
run 1 compare theirs ours --mask 3,4,1,1
says "1 pixel differs (0.503%) by at most 1, first at (5, 4)"
run 0 compare theirs ours --mask 3,4,1,1 --mask 5,4,1,1
run 0 compare theirs ours --mask 0,4,1000,1
run 1 compare theirs ours --mask 0,5,1000,1
png mask.png 20 10 "255 255 255 0" 3 4 "255 255 255 255" 5 4 "0 0 0 255"
run 1 compare theirs ours --mask mask.png
says "first at (5, 4)"
png mask.png 20 10 "0 0 0 255" 3 4 "1 0 0 1" 5 4 "0 0 9 255"
run 0 compare theirs ours --mask mask.png
png mask.png 20 11 "0 0 0 255"
run 2 compare theirs ours --mask mask.png
complains "mask.png: error: the mask has 20 x 11 pixels, but theirs/shot-1.png has 20 x 10"
for wrong in 1,2,3 1,2,0,4 a,b,c,d 1,2,3,4,5 mask.jpg; do
    run 2 compare theirs ours --mask $wrong
    complains "'$wrong' is neither a PNG file nor X,Y,W,H"
done

# What claims to be large is refused before it is unpacked; the limit is an option.
/usr/bin/python3 - <<'PYTHON'
import struct, zlib
chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
pack = zlib.compressobj(9)
rows = b"".join(pack.compress(bytes(1 << 20)) for _ in range(19000 * (19000 // 8 + 1) // (1 << 20) + 1)) + pack.flush()
with open("bomb.png", "wb") as file:
    file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 19000, 19000, 1, 0, 0, 0, 0)))
    file.write(chunk(b"IDAT", rows) + chunk(b"IEND", b""))
PYTHON
[ "$(wc -c <bomb.png)" -lt 60000 ] || fail "the bomb is no bomb: $(wc -c <bomb.png) bytes"
run 2 compare theirs/shot-1.png bomb.png
complains "bomb.png: error: the picture has 19000 x 19000 pixels; at most 100000000"
run 2 compare theirs ours --max-pixels 199
complains "theirs/shot-2.png: error: the picture has 20 x 10 pixels; at most 199"
run 1 compare theirs ours --max-pixels 200

run 2 compare a.npz one
complains "is not a trajectory"
run 2 compare a.npz b.npz --annotations github
complains "apply to pictures only"
run 2 compare one nowhere
complains "nowhere"
run 2 compare one one/frame_000001.png
complains "is a folder"
mkdir empty
run 2 compare one empty
complains "empty"
run 2 compare a.npz a.npz a.npz
head -c 1000 a.npz >cut.npz
run 2 compare a.npz cut.npz
complains "cut.npz: error:"

# A damaged trajectory beside the frames is told; numbers of another kind in both folders are nobody's business.
rm -r two
cp -r one two
cp cut.npz two/stack-engine.npz
run 2 compare one two
complains "two/stack-engine.npz: error:"
cp cut.npz one/stack-engine.npz
echo 1 >>one/stack-engine.npz
run 0 compare one two
finish
